//! The simulated machine.
//!
//! | module | idea |
//! |---|---|
//! | [`plant`] | bodies, drives, friction and stops, integrated |
//! | [`devices`] | what the controller sees of it: encoders, bridges, converters, flash |

pub mod devices;
pub mod plant;

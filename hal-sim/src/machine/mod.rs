//! The simulated machine.
//!
//! | module | idea |
//! |---|---|
//! | [`plant`] | bodies, drives, friction and stops, integrated |
//! | [`file`] | a machine as a file of numbers |
//! | `unknown` | a machine drawn by the sizes that workshops keep |
//! | [`devices`] | what the controller sees of it: encoders, bridges, converters, flash |
//! | [`instruments`] | what a metrologist sees of it, at rest |

pub mod devices;
pub mod file;
pub mod instruments;
pub mod plant;
mod unknown;

pub(crate) use unknown::draw_sensors;
pub use unknown::unknown;

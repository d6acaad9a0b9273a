//! What is asked of the image `stage` for the controller's chip.
//!
//! | module | idea |
//! |---|---|
//! | [`chip`] | the image on an emulated chip that has the simulated stage on its pins, and its twin on the host |
//! | [`proof`] | the control loop cannot panic, the stack is deep enough |
//! | [`seal`] | the checksum that an image is given before it is flashed |
//! | [`cost`] | what parts of the library take, counted |
//! | [`cycles`] | what a tick takes in cycles, by a model of core and flash |
//! | [`cli`] | the command line |

pub mod chip;
pub mod cli;
pub mod cost;
pub mod cycles;
pub mod proof;
pub mod seal;

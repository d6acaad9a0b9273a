//! Random states of the reference stage, over which the controller's cost is counted (`cargo cost`, on the chip) and
//! timed (`cargo bench -p firmware-cost`, on the host).
#![no_std]

pub mod random;
pub mod states;
pub mod streaming;

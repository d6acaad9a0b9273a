//! Random states of the reference stage, over which the controller's cost is counted (`cargo cost`, on the chip) and
//! timed (`cargo bench -p firmware-cost --bench planning`, on the host).
//!
//! | module | idea |
//! |---|---|
//! | [`random`] | random arguments from a seed |
//! | [`states`] | random positions and motions |
//! | [`streaming`] | streams under way, just before the target that makes the next plan |
#![no_std]

pub mod random;
pub mod states;
pub mod streaming;

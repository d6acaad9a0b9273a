//! The Tripivot controller, hardware-free: what runs in `cargo test`, in the simulator and on the chip.
//!
//! ```text
//! encoder frames -> pivot angles -> (direct) measured pose -> supervisor
//! command queue  -> motion -> pose, velocity, acceleration setpoint
//!                -> (inverse) pivot position, rate, acceleration setpoint
//!                -> servo + feedforward -> limits -> duty -> motors
//!                -> recorder
//! ```
#![cfg_attr(not(test), no_std)]

pub mod blackbox;
pub mod config;
pub mod controller;
pub mod drivers;
pub mod encoder;
pub mod fault;
pub mod interval;
pub mod link;
pub mod motion;
pub mod number;
pub mod panel;
pub mod parameters;
pub mod recorder;
mod reference;
pub mod servo;
mod settling;
pub mod store;

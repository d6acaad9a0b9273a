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

pub mod commander;
pub mod control;

pub mod drivers;
pub mod fault;
pub mod fault_record;
pub mod gcs;
pub mod mode;
pub mod motion;
pub mod number;
pub mod parameters;
pub mod queues;
pub mod recorder;
pub mod settings_store;

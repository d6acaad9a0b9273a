//! The Tripivot controller, hardware-free: what runs in `cargo test`, in the simulator and on the chip.
//!
//! ```text
//! encoder frames -> pivot angles -> (direct) measured pose -> supervisor
//! command queue  -> motion -> pose, velocity, acceleration setpoint
//!                -> (inverse) pivot position, rate, acceleration setpoint
//!                -> servo + feedforward -> limits -> duty -> motors
//!                -> recorder
//! ```
//!
//! From the top floor down; nothing takes from a floor above its own:
//!
//! | room | what is in it |
//! |---|---|
//! | [`gcs`] | the command language: lines in, answers out |
//! | [`settings_store`] | settings kept in flash, over resets and power cuts |
//! | [`commander`] | the stage as the command side sees it: plans, what is sent and what is pending; no word of GCS |
//! | [`queues`] | between the command side and the tick: commands one way, snapshots the other |
//! | [`control`] | the tick: encoder frames in, duties out; servo, supervisor, referencing, settling |
//! | [`iterative_learning`] | tables of voltage that go with a move that is repeated, and what they learn |
//! | [`fault_record`] | what is still there after a reset: events, and the ticks around a fault |
//! | [`recorder`] | the data recorder, and a running hash of every tick |
//! | [`calibration`] | what a built machine is off the drawing, as the tick takes it |
//! | [`parameters`] | every tunable, in physical units |
//! | [`motion`] | what a plan is, all planners, and the check that a plan is within every limit |
//! | [`image_checksum`] | whether the program in flash is whole |
//! | [`drivers`] | chips on the board: encoder frames, bridges |
//! | [`self_test`] | what a board can be asked about itself |
//! | [`fault`] | kinds of fault, what each does and why |
//! | [`mode`] | the modes of the controller |
//! | [`number`] | fixed point and the functions of the tick, the same bits on every machine |
#![cfg_attr(not(test), no_std)]

pub mod calibration;
pub mod commander;
pub mod control;
pub mod drivers;
pub mod fault;
pub mod fault_record;
pub mod gcs;
pub mod image_checksum;
pub mod iterative_learning;
pub mod mode;
pub mod parameters;
pub mod queues;
pub mod recorder;
pub mod self_test;
pub mod settings_store;

/// Plans, and what they are held against; and the planners.
pub mod motion {
    pub use ::motion::*;
    pub use planners::*;
}

pub use number;

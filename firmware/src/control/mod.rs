//! The control loop: encoder frames in, duties out, at a fixed rate.

pub mod config;
pub mod encoder;
pub mod loop_counters;
pub(crate) mod referencing;
pub mod servo;
pub(crate) mod settling;
mod state;
pub(crate) mod supervisor;
pub mod tick;

pub use state::{Inputs, Outputs, State};
pub use supervisor::{Event, MODES, Outcome, TRANSITIONS};
pub use tick::tick;

//! The supervisor: which commands are taken in which state, and what is a fault.
//!
//! | file | idea |
//! |---|---|
//! | `transitions` | what every event does in every state |
//! | `commands` | commands, as the table has them |
//! | `raise_fault` | a fault is latched, and answered as the table has it |
//! | `input_faults` | faults that the inputs show |
//! | `setpoint_faults` | faults that the setpoint shows |
//! | `following_error` | measured minus setpoint of each pivot |
//! | `pivot_faults` | faults of a single pivot, one pivot a tick |
//! | `current_faults` | faults that a motor's current shows, all three every fourth tick |
//!
//! Off coasts, so that a stage can be moved by hand; holding, moving and stopping drive; a fault brakes, or coasts
//! where its [`Reaction`](crate::fault::Reaction) is that. All faults with their detection, reaction and reason stand
//! in `FAULTS.md`, which is made from [`FAULT_DESCRIPTIONS`](crate::fault::FAULT_DESCRIPTIONS).
//!
//! The measured pose is computed when a command needs it, not at every tick: while the servo is on, every pivot is
//! within the largest following error of the setpoint, which bounds the measured pose more tightly than any margin of
//! the mechanics. So the disk and the guides' ranges are judged by the setpoint, and what lies between setpoint and
//! pivots by the following error. Only the angle between two pivots, which is a difference, is measured.

mod commands;
mod current_faults;
mod following_error;
mod input_faults;
mod pivot_faults;
mod raise_fault;
mod setpoint_faults;
mod transitions;

pub use transitions::{Event, MODES, Outcome, TRANSITIONS};

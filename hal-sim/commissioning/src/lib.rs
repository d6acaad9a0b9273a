#![forbid(unsafe_code)]
//! From records of an unknown machine to its numbers and to gains: the mathematics of commissioning. It runs no controller, and knows no language
//! and no simulated machine; records go in, numbers come out. SI units; angles in rad, torques and inertias as seen at the rings.
//!
//! | file | idea |
//! |---|---|
//! | [`record`] | what is recorded, and when within a tick each of it holds |
//! | [`mod@winding`] | resistance and inductance from pulses at rest; opens, shorts, polarity |
//! | [`mod@frequency_response`] | responses of all pivots to all drives, in open or closed loop, with their deviations |
//! | [`mod@friction`] | friction and motor constants from steady rates both ways |
//! | [`dead_time`] | what of a bridge's dead time counts, at a current and in a record |
//! | [`mod@gear`] | cyclic errors of the gears, from steady rates both ways |
//! | [`mod@subdivision`] | errors of the encoders within the periods of their scales, from a steady rate |
//! | [`mod@drive_model`] | windings, inertias, springs and dampers from the responses |
//! | [`mod@closed_loop`] | plant and sensitivity as they were measured with the servo on |
//! | [`chain`] | the machine as it answers to small motions: motors, rings, platform, springs between |
//! | [`mod@platform`] | mass, inertia and centre of what is carried, from a tour |
//! | [`mod@guide_ends`] | zeros of the encoders from where the guides end |
//! | [`zeros`] | wrong zeros of the encoders, from a tour |
//! | [`tuning`] | margins of the three loops together; gains and notches for them |
//! | `spectrum`, `least_squares` | spectra of single periods; non-linear least squares |
//!
//! # In which order
//!
//! 1. [`winding()`]: is everything wired as it should be.
//! 2. [`friction()`]: motor constants to some tenths of a per cent, friction; takes the resistance, roughly.
//! 3. [`frequency_response()`] in the middle of the disk, turning without end, and with a weaker excitation; [`drive_model()`]: takes the motor constants.
//! 4. [`platform()`]: a tour that goes out; mass, inertia and load apart from the rings'.
//! 5. [`tuning::tune()`] with the model at several places, and off by what it may be; [`frequency_response()`] again in closed loop, and
//!    [`tuning::Plant::from_lines`] to see that the margins are kept.
//!
//! What no record of volts, currents and ring angles tells: how a ring's inertia is split between motor and ring but for what the resonances say of it; the meters'
//! own errors (volts and amperes are those of the controller: R, K, mass and inertia inherit them); and friction of one drive alone, since
//! carriages that do not slide hold a torque between the rings.

pub mod chain;
pub mod closed_loop;
pub mod dead_time;
pub mod drive_model;
pub mod frequency_response;
pub mod friction;
pub mod gear;
pub mod guide_ends;
mod least_squares;
pub mod platform;
pub mod record;
mod spectrum;
pub mod subdivision;
pub mod tuning;
pub mod winding;
pub mod zeros;

pub use drive_model::{DriveModel, drive_model};
pub use frequency_response::frequency_response;
pub use friction::friction;
pub use guide_ends::guide_ends;
pub use platform::platform;
pub use record::{Record, Signals, Timing};
pub use subdivision::subdivision;
pub use winding::winding;
pub use zeros::zero_errors;

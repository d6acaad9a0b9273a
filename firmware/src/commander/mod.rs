//! The stage as the command side sees it: what is known of it, what is in flight to it, what is asked of it.
//!
//! A [`Commander`] takes requests (a move, a jog, a stop, a stream of targets, referencing, other frames or
//! parameters), checks each as a whole, plans, and sends commands to the tick. It runs at low priority and meets the
//! tick only through the queues of [`crate::queues`]. It knows no language: who calls it gets values and a
//! [`CommandError`].
//!
//! ```text
//! let mut commander = Commander::new(&parameters);
//! loop {
//!     if let Some(snapshot) = queues.snapshot() {
//!         commander.update(snapshot);
//!     }
//!     commander.advance_pending(&mut queues);
//!     // requests: commander.move_to(&values, &mut queues)?, ...
//!     // what came to nothing later: commander.take_late_error()
//! }
//! ```
//!
//! One command is in flight at most. What a command does is known when the tick has counted it
//! ([`Snapshot::commands`](crate::queues::Snapshot::commands)), a tick later; until then nothing that depends on it is
//! decided: most requests need [`Commander::current_snapshot`]. What has to wait (a stop for the tick at which it takes
//! over, a move for the stop before it) waits in the state machine of `pending.rs`, and [`Commander::advance_pending`]
//! goes on with it.
//!
//! | file | idea |
//! |---|---|
//! | `state` | what is known and asked, and how snapshots change it |
//! | `pending` | **the state machine**: what is asked and not handed over yet |
//! | `advance` | from what is pending to the next plan |
//! | `in_flight` | the command that the tick has not counted yet |
//! | `sent_plan` | a plan that was sent, with what it takes to leave it |
//! | `repeated_moves` | the tables of iterative learning, and the moves that they are of |
//! | `moves` | moves, stops, faults, soft limits |
//! | `approach`, `kept_approach` | arriving from one side |
//! | `servo_switch` | the servo on and off |
//! | `rest`, `rest_watch` | whether the stage rests, by what the encoders measure |
//! | `jog` | constant velocities |
//! | `streaming`, `stream_source` | streamed targets and running waveforms |
//! | `referencing`, `reach` | referencing; whether the stage can be where the encoders show it |
//! | `recovery` | the way back of a stage that was found out of its reach |
//! | `configure` | other parameters |
//! | `calibration`, `kept_calibration` | what the machine is off the drawing |
//! | `temperature`, `kept_temperature` | how long lengths are |
//! | `excitation` | known voltages on a motor |
//! | `velocities` | of the whole and of single axes |
//! | `constraints` | what plans keep to now |
//! | `soft_limits` | travel as the user narrows it |
//! | `frames`, `frame_changes` | coordinate systems of the user's own, and the centre of rotation |
//! | `wave`, `wave_changes` | waveforms: tables and generators |
//! | `queries`, `quantity` | what can be asked |
//! | `lamps` | what a board's lamps show |
//! | `furthest_target` | how far a target can go in a direction |
//! | `coordinates` | between mm and deg and the motion layer's positions |
//! | `axis` | axes, sets of them, values for them |
//! | `error` | why a request was refused |

pub mod axis;
pub mod frames;
pub mod wave;

pub(crate) mod coordinates;

mod advance;
mod approach;
mod calibration;
mod configure;
mod constraints;
mod error;
mod excitation;
mod frame_changes;
mod furthest_target;
mod in_flight;
mod jog;
mod kept_approach;
mod kept_calibration;
mod kept_temperature;
mod lamps;
mod moves;
mod pending;
mod quantity;
mod queries;
mod reach;
mod recovery;
mod referencing;
mod repeated_moves;
mod rest;
mod rest_watch;
mod sent_plan;
mod servo_switch;
mod soft_limits;
mod state;
mod stream_source;
mod streaming;
mod temperature;
mod velocities;
mod wave_changes;

pub use approach::MOST_APPROACH_UM;
pub use error::CommandError;
pub use lamps::Lamps;
pub use quantity::Quantity;
pub use recovery::RecoveryEnd;
pub use referencing::Referencing;
pub use soft_limits::SoftLimitChange;
pub use state::Commander;

//! The control loop: encoder frames in, duties out, at a fixed rate.
//!
//! | file | idea |
//! |---|---|
//! | `tick` | one period of the loop, from frames to duties |
//! | `state` | what a tick is given, what it gives, what it remembers |
//! | `config` | what it computes with, derived from the parameters |
//! | `units` | counts of the converter and units of an angle |
//! | `wiring` | from connectors to pivots, and back |
//! | `encoder` | frames to a multi-turn angle: which frame is believed, what bridges one that is not |
//! | `subdivision` | the error within each period of an encoder's scale, taken from its readings |
//! | `referencing` | turns for theta and the pivots from single-turn encoders |
//! | `held_position` | the measured position, to the decimals with which the servo takes it over |
//! | `next_setpoint` | the setpoint of the next tick, computed after the duties of this one |
//! | `pivot_setpoints` | the pose's setpoint to those of the pivots |
//! | `guides` | friction of the carriages, and guides that give way, made up for in the setpoint |
//! | `calibrated` | the same of a machine that is calibrated, and the pose of its encoders |
//! | `servo/` | pivot setpoints and measured pivots to duties |
//! | `brake_resistor` | what takes the energy that the motors give back |
//! | `brake_resistor_test` | whether it does, while the bridges wake up and at rest |
//! | `lead_test` | whether the motors' leads carry what they should, at servo on |
//! | `excitation/` | a known voltage on a motor, to see what the machine is |
//! | `excited` | the tick of an excitation with the servo off |
//! | `trial` | trials of iterative learning |
//! | `rest_mode` | slower loops while the setpoint rests |
//! | `settling` | whether the stage has settled |
//! | `supervisor/` | which commands are taken in which state, and what is a fault |
//! | `inspection` | which pivot is inspected in which tick |
//! | `oscillation` | whether a servo oscillates |
//! | `command`, `snapshot` | what the command side asks, and what is reported to it |
//! | `report` | when and how a snapshot is sent |
//! | `tick_queues` | the tick's ends of the queues and recorders |
//! | `observers` | the recorders, which observe every tick and may run behind it |
//! | `loop_counters` | what the loop counts between two snapshots |

mod brake_resistor;
mod brake_resistor_test;
mod calibrated;
mod command;
pub mod config;
pub mod encoder;
pub mod excitation;
mod excited;
mod guides;
pub mod held_position;
mod inspection;
mod lead_test;
pub mod loop_counters;
mod next_setpoint;
mod observers;
mod oscillation;
mod pivot_setpoints;
mod referencing;
mod report;
pub mod rest_mode;
pub mod servo;
mod settling;
mod snapshot;
mod state;
mod subdivision;
mod supervisor;
mod tick;
mod tick_queues;
mod trial;
pub mod units;
mod wiring;

pub use brake_resistor_test::LEAST_DROP_V as LEAST_RESISTOR_DROP_V;
pub use calibrated::CalibrationInForce;
pub use command::Command;
pub use observers::TickObservers;
pub use snapshot::{SNAPSHOT_SLOTS, ServoReport, Snapshot};
pub use state::{Inputs, Outputs, State};
pub use subdivision::SubdivisionTable;
pub use supervisor::{Event, MODES, Outcome, TRANSITIONS};
pub use tick::{tick, tick_and_drive};
pub use tick_queues::TickQueues;

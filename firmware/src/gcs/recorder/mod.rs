//! The data recorder in the language: what is recorded, when it begins, and reading it.
//!
//! There are eight tables. `DRC` says what a table records, `RTR` how often, `DRT` what triggers; tables share the
//! rate, and recording begins in all of them as soon as the trigger of any comes. `DRT` arms: it orders a record from
//! the tick, and the one before is gone once the new one begins to be written. What is read is the last record that was
//! ordered.
//!
//! | file | idea |
//! |---|---|
//! | `state` | tables, triggers, and the record that was ordered |
//! | `channel` | what can be recorded, and of what words it is worked out |
//! | `scales` | from words to mm, deg and s |
//! | `trigger` | what can begin a record |
//! | `orders` | from tables and triggers to an order, and the commands that trigger |
//! | `request` | what lines ask for |
//! | `parse` | what lines mean |
//! | `execute` | what lines do |
//! | `replies` | answers of a few lines |
//! | `readout` | `DRR?`: an answer of any length, written as the output has room |
//! | `fault_record_readout` | `FLR?`: the fault record, the same way |
//! | `readout_service` | writing both, some lines at each service |

mod channel;
mod execute;
mod fault_record_readout;
mod orders;
pub(super) mod parse;
mod readout;
mod readout_service;
mod replies;
mod request;
mod scales;
mod state;
mod trigger;

pub use channel::{Channel, SignalSource};
pub(super) use fault_record_readout::FaultRecordReadout;
pub(super) use readout::RecordReadout;
pub use request::{RecordAction, RecordQuery, TableList};
pub(super) use state::RecorderState;
pub use trigger::Trigger;

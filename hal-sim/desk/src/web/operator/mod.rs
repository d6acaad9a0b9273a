//! What the server does for operators besides passing their lines: it runs their sequences, and keeps a log of who did what.
//!
//! | file | idea |
//! |---|---|
//! | `sequence`, `sequence_status` | a script under way, for pages; their orders, its state |
//! | `runner` | the task that runs it |
//! | `performer` | one line of it over the line that all share: waits and delays happen here, not in the controller |
//! | `commissioning` | the steps of commissioning, and gains by hand |
//! | `journal` | who did what |
//! | `socket` | all of it, to a page and from it |

pub(super) mod commissioning;
mod journal;
mod performer;
mod runner;
mod sequence;
mod sequence_status;
mod socket;

use std::io;

use super::bridge::Bridge;
use commissioning::{Commissioning, Person};
pub(super) use journal::Journal;
pub(super) use sequence::Sequence;
pub(super) use sequence_status::Order;
pub(super) use socket::{MESSAGE_BYTES, serve};

/// All of it, for whoever serves pages.
#[derive(Clone)]
pub(super) struct Operator {
    pub sequence: Sequence,
    pub commissioning: Commissioning,
    pub journal: Journal,
}

impl Operator {
    /// It begins; to be called within the runtime.
    pub fn start(bridge: Bridge, person: Option<Person>) -> io::Result<Self> {
        let journal = Journal::new();
        Ok(Self {
            sequence: Sequence::start(bridge.clone(), journal.clone()),
            commissioning: Commissioning::start(bridge, journal.clone(), person)?,
            journal,
        })
    }
}

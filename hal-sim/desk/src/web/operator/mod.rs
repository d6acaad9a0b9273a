//! What the server does for operators besides passing their lines: it runs their sequences, and keeps a log of who did what.
//!
//! | file | idea |
//! |---|---|
//! | `sequence`, `sequence_status` | a script under way, for pages; their orders, its state |
//! | `runner` | the task that runs it |
//! | `performer` | one line of it over the line that all share: waits and delays happen here, not in the controller |
//! | `commissioning` | the steps of commissioning, and gains by hand |
//! | `calibration` | poses to measure at, the measurement, its fit, put in force and verified |
//! | `runs` | what these two have in common |
//! | `journal` | who did what |
//! | `socket` | all of it, to a page and from it |

pub(super) mod calibration;
pub(super) mod commissioning;
mod journal;
mod performer;
mod runner;
pub(super) mod runs;
mod sequence;
mod sequence_status;
mod socket;

use std::io;

use super::bridge::Bridge;
use calibration::{Calibration, Instruments};
use commissioning::Commissioning;
pub(super) use journal::Journal;
use runs::{Person, Reach};
pub(super) use sequence::Sequence;
pub(super) use sequence_status::Order;
pub(super) use socket::{MESSAGE_BYTES, serve};
use std::sync::Arc;
use tokio::runtime::Handle;

/// All of it, for whoever serves pages.
#[derive(Clone)]
pub(super) struct Operator {
    pub sequence: Sequence,
    pub commissioning: Commissioning,
    pub calibration: Calibration,
    /// What reaches these two.
    reach: Reach,
    pub journal: Journal,
}

impl Operator {
    /// It begins; to be called within the runtime.
    pub fn start(
        bridge: Bridge,
        person: Option<Person>,
        instruments: Option<Instruments>,
    ) -> io::Result<Self> {
        let journal = Journal::new();
        let reach = Reach {
            bridge: bridge.clone(),
            runtime: Handle::current(),
            control: Arc::default(),
        };
        Ok(Self {
            sequence: Sequence::start(bridge, journal.clone()),
            commissioning: Commissioning::start(reach.clone(), journal.clone(), person)?,
            calibration: Calibration::start(reach.clone(), journal.clone(), instruments)?,
            reach,
            journal,
        })
    }

    /// A page has stopped the stage.
    pub fn stopped(&self, who: &str) {
        self.reach.stopped(who);
        self.sequence.order(Order::Stopped {
            who: who.to_owned(),
        });
    }

    /// A page is gone.
    fn gone(&self, page: u64) {
        self.reach.gone(page);
        self.sequence.order(Order::Gone { page });
    }
}

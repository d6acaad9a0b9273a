//! What the server does for operators besides passing their lines: it runs their sequences, and keeps a log of who did what.
//!
//! | file | idea |
//! |---|---|
//! | `sequence`, `sequence_status` | a script under way, for pages; their orders, its state |
//! | `runner` | the task that runs it |
//! | `performer` | one line of it over the line that all share: waits and delays happen here, not in the controller |
//! | `journal` | who did what |
//! | `socket` | both, to a page and from it |

mod journal;
mod performer;
mod runner;
mod sequence;
mod sequence_status;
mod socket;

use super::bridge::Bridge;
pub(super) use journal::Journal;
pub(super) use sequence::Sequence;
pub(super) use sequence_status::Order;
pub(super) use socket::{MESSAGE_BYTES, serve};

/// Both, for whoever serves pages.
#[derive(Clone)]
pub(super) struct Operator {
    pub sequence: Sequence,
    pub journal: Journal,
}

impl Operator {
    /// Both begin; to be called within the runtime.
    pub fn start(bridge: Bridge) -> Self {
        let journal = Journal::new();
        Self {
            sequence: Sequence::start(bridge, journal.clone()),
            journal,
        }
    }
}

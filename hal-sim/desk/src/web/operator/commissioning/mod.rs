//! Commissioning from the page: the same steps as `tripivot commission`, run in the server, with whoever looks at a page as the person beside the
//! machine; and gains by hand, on the loops that were measured.
//!
//! ```text
//!         start             last step, a step that fails
//! idle -----------> running ----------------------------> idle
//!                    |   ^ \
//!           a task   |   |  \  end, a page's STOP, the page that began it is gone
//!                    v   |   \---------------------------> idle, nothing kept
//!                  asks (done)
//! ```
//!
//! | file | idea |
//! |---|---|
//! | here | the handle that pages share |
//! | `status` | what pages are told |
//! | `worker` | the thread that runs the steps and tries gains |

mod status;
mod worker;

use std::io;
use std::sync::mpsc::{self, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use serde::Deserialize;
use tokio::sync::watch;

use super::journal::Journal;
use super::runs::{Files, Ordered, Person, Reach, Told};
use crate::commission::Numbers;
use status::Status;
use worker::Worker;

/// Where its files are.
const FOLDER: &str = "/commissioning/";

/// What a page wants.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub(in crate::web) enum Order {
    /// All steps, or those from one on.
    Commission {
        from: Option<String>,
        /// Periods of the encoders' scale in a turn, where they are known.
        scale_periods: Option<u32>,
        /// Whether the encoders' zeros come from the guides' ends.
        #[serde(default)]
        without_jig: bool,
        /// What may stand on the platform besides what is on it.
        #[serde(default)]
        also_carries_kg: f64,
    },
    /// One step, after a repair.
    Only {
        step: String,
        scale_periods: Option<u32>,
    },
    /// Another payload.
    Tune {
        /// As above.
        #[serde(default)]
        also_carries_kg: f64,
    },
    /// The loops as they are; nothing is kept.
    Measure,
    /// What the person was asked for is done.
    Done,
    /// Ends what runs.
    End,
    /// What these gains would make of the loops that were measured.
    Predict { gains: Numbers },
    /// Puts them in force.
    Put { gains: Numbers },
    /// Has what is in force kept.
    Keep,
    /// What was before the last commissioning from a page is in force again, and kept.
    Undo,
}

/// The handle that all pages share.
#[derive(Clone)]
pub(in crate::web) struct Commissioning {
    /// For the thread.
    orders: Arc<Mutex<Sender<Ordered<Order>>>>,
    reach: Reach,
    told: Arc<Told<Status>>,
    files: Files,
}

impl Commissioning {
    /// Its thread begins.
    pub fn start(reach: Reach, journal: Journal, person: Option<Person>) -> io::Result<Self> {
        let (orders, incoming) = mpsc::channel();
        let this = Self {
            orders: Arc::new(Mutex::new(orders)),
            reach: reach.clone(),
            told: Arc::new(Told::new(Status::new())),
            files: Files::new(FOLDER),
        };
        let worker = Worker {
            reach,
            told: Arc::clone(&this.told),
            files: this.files.clone(),
            journal,
            person,
            tunable: None,
            before: None,
            earlier: None,
        };
        thread::Builder::new()
            .name("commissioning".into())
            .spawn(move || worker.run(&incoming))?;
        Ok(this)
    }

    /// Has it done; the state tells what came of it.
    pub fn order(&self, ordered: Ordered<Order>) {
        match &ordered.order {
            Order::Done => self.reach.control.done(),
            Order::End => {
                self.reach.end();
            }
            // One after the other would surprise whoever has ordered it minutes before.
            _ if self.reach.control.begin(ordered.page) => {
                let orders = self.orders.lock().unwrap_or_else(PoisonError::into_inner);
                // Its thread ends with the server only.
                let _ = orders.send(ordered);
            }
            order => self.told.refuses(worker::what(order)),
        }
    }

    /// The state, as a message for pages.
    pub fn told(&self) -> watch::Receiver<Arc<str>> {
        self.told.receiver()
    }

    /// What browsers may fetch.
    pub fn files(&self) -> Files {
        self.files.clone()
    }
}

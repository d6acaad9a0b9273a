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
//! | `machine` | the machine as the steps see it, over the way that its page has to the controller |
//! | `control` | what reaches a run from outside: that a task is done, that it is to end |
//! | `files` | plots, tables and reports, for browsers to fetch |

mod control;
mod files;
mod machine;
mod status;
mod worker;

use std::io;
use std::sync::mpsc::{self, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use serde::Deserialize;
use tokio::runtime::Handle;
use tokio::sync::watch;

use super::journal::Journal;
use crate::commission::{Numbers, Task};
use crate::web::bridge::Bridge;
use control::Control;
pub(in crate::web) use files::Files;
use status::Told;
use worker::Worker;

/// Who does with a simulated machine what a person does with a real one.
pub type Person = Arc<dyn Fn(Task) + Send + Sync>;

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
    },
    /// One step, after a repair.
    Only {
        step: String,
        scale_periods: Option<u32>,
    },
    /// Another payload.
    Tune,
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

/// An order, and whose it is.
#[derive(Debug, PartialEq)]
pub(in crate::web) struct Ordered {
    pub order: Order,
    /// Whoever uses the page.
    pub who: String,
    pub page: u64,
    /// Of the page's way to the controller.
    pub key: String,
}

/// The handle that all pages share.
#[derive(Clone)]
pub(in crate::web) struct Commissioning {
    /// For the thread.
    orders: Arc<Mutex<Sender<Ordered>>>,
    control: Arc<Control>,
    told: Arc<Told>,
    files: Files,
    bridge: Bridge,
}

impl Commissioning {
    /// To be called within the runtime.
    pub fn start(bridge: Bridge, journal: Journal, person: Option<Person>) -> io::Result<Self> {
        let (orders, incoming) = mpsc::channel();
        let this = Self {
            orders: Arc::new(Mutex::new(orders)),
            control: Arc::default(),
            told: Arc::new(Told::new()),
            files: Files::default(),
            bridge: bridge.clone(),
        };
        let worker = Worker {
            control: Arc::clone(&this.control),
            told: Arc::clone(&this.told),
            files: this.files.clone(),
            bridge,
            journal,
            person,
            runtime: Handle::current(),
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
    pub fn order(&self, ordered: Ordered) {
        match ordered.order {
            Order::Done => self.control.done(),
            Order::End => {
                self.control.end("an operator");
                // Where nobody is reached, the run finds that itself.
                let _ = self.bridge.stop();
            }
            // One after the other would surprise whoever has ordered it minutes before.
            _ if self.control.begin(ordered.page) => {
                let orders = self.orders.lock().unwrap_or_else(PoisonError::into_inner);
                // Its thread ends with the server only.
                let _ = orders.send(ordered);
            }
            _ => {}
        }
    }

    /// A page has stopped the stage.
    pub fn stopped(&self, who: &str) {
        self.control.end(&format!("STOP by {who}"));
    }

    /// A page is gone: what it has begun does not go on with nobody there to stop it.
    pub fn gone(&self, page: u64) {
        if self.control.is_of(page) {
            self.control.end("its page, which is gone");
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

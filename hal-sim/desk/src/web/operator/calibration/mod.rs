//! Calibration from the page: where to measure, the measurement, its fit, that put in force and verified, as `tripivot calibrate` does it, run in the
//! server. What was measured before it was ended is kept until the server ends, and may be gone on with.
//!
//! | file | idea |
//! |---|---|
//! | here | the handle that pages share |
//! | `wish` | what a page asks for, in its own numbers |
//! | `status` | what pages are told |
//! | `worker` | the thread that does it |
//! | `measurement` | what was measured so far |
//! | `by_hand` | an instrument that whoever looks at a page reads |

mod by_hand;
mod measurement;
mod status;
mod wish;
mod worker;

use std::io;
use std::sync::mpsc::{self, Sender};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

use ::calibration::Instrument;
use serde::Deserialize;
use tokio::sync::watch;

use super::journal::Journal;
use super::runs::{Files, Ordered, Reach, Told};
use crate::calibrate::Reader;
use status::Status;
use wish::Wish;
use worker::Worker;

/// Where its files are.
const FOLDER: &str = "/calibration/";

/// Sets an instrument up in front of the stage; none where there is no such instrument.
pub type SetUp = Arc<dyn Fn(&Instrument) -> Option<Box<dyn Reader>> + Send + Sync>;

/// What reads instruments in place of whoever looks at a page.
#[derive(Clone)]
pub struct Instruments {
    /// What it is.
    pub words: &'static str,
    /// One of them.
    pub set_up: SetUp,
}

/// What a page wants.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub(in crate::web) enum Order {
    /// Where to measure, and what will come of it. Nothing moves.
    Plan(Wish),
    /// The same, driven and fitted.
    Measure(Wish),
    /// Goes on with a measurement that was ended.
    Resume,
    /// Waits at the next pose.
    Pause,
    /// Goes on from there.
    Continue,
    /// What the instrument reads.
    Read(String),
    /// Ends what runs.
    End,
    /// Gives the controller what was fitted.
    Apply,
    /// Judges that by fresh poses.
    Verify(Wish),
    /// Takes what is in force out of force.
    Undo,
}

/// The handle that all pages share.
#[derive(Clone)]
pub(in crate::web) struct Calibration {
    /// For the thread.
    orders: Arc<Mutex<Sender<Ordered<Order>>>>,
    reach: Reach,
    told: Arc<Told<Status>>,
    files: Files,
}

impl Calibration {
    /// Its thread begins.
    pub fn start(
        reach: Reach,
        journal: Journal,
        instruments: Option<Instruments>,
    ) -> io::Result<Self> {
        let (orders, incoming) = mpsc::channel();
        let words = instruments.as_ref().map(|instruments| instruments.words);
        let this = Self {
            orders: Arc::new(Mutex::new(orders)),
            reach: reach.clone(),
            told: Arc::new(Told::new(Status::new(words))),
            files: Files::new(FOLDER),
        };
        let worker = Worker::new(
            reach,
            Arc::clone(&this.told),
            this.files.clone(),
            journal,
            instruments,
        );
        thread::Builder::new()
            .name("calibration".into())
            .spawn(move || worker.run(&incoming))?;
        Ok(this)
    }

    /// Has it done; the state tells what came of it.
    pub fn order(&self, ordered: Ordered<Order>) {
        let control = &self.reach.control;
        match &ordered.order {
            Order::Pause => self.pause(true),
            Order::Continue => self.pause(false),
            Order::Read(text) => control.read(text),
            Order::End => self.reach.end(),
            _ if control.begin(ordered.page) => {
                let orders = self.orders.lock().unwrap_or_else(PoisonError::into_inner);
                // Its thread ends with the server only.
                let _ = orders.send(ordered);
            }
            order => self.told.refuses(worker::what(order)),
        }
    }

    fn pause(&self, is_paused: bool) {
        self.reach.control.pause(is_paused);
        self.told
            .change(|status| status.is_paused = is_paused && status.run.runs);
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

//! A script that runs in the server, so that no page has to stay for it, and whose page may not vanish unnoticed: then it pauses.
//!
//! ```text
//!            Run, Step                 last line
//!   idle ----------------> running ----------------> ended
//!                           |   ^                      ^
//!                     Pause |   | Continue             | Stop, a page's STOP, a refused line, a fault
//!                           v   |                      |
//!                          paused ---------------------+        Step: one line, and paused again
//! ```

use std::sync::Arc;

use serde::Serialize;
use tokio::sync::{mpsc, watch};

use super::journal::Journal;
use super::runner::Runner;
use crate::web::bridge::{Bridge, json};

/// What an operator wants of the sequence.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::web) enum Order {
    /// Begins this script; `steps`: pauses after its first line.
    Run {
        name: String,
        text: String,
        steps: bool,
        page: u64,
    },
    /// The next line, and no more.
    Step { page: u64 },
    /// No further line.
    Pause,
    /// On from where it is.
    Continue { page: u64 },
    /// Ends it, and brings the stage to rest smoothly.
    Stop,
    /// A page has stopped the stage.
    Stopped { who: String },
    /// A page is gone.
    Gone { page: u64 },
}

#[derive(Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum State {
    Idle,
    Running,
    Pausing,
    Paused,
    Ended,
}

/// An answer that the script asked for.
#[derive(Clone, Serialize)]
pub(super) struct Answered {
    pub number: usize,
    pub line: String,
    pub reply: String,
}

/// What pages are told.
#[derive(Clone, Serialize)]
#[serde(tag = "kind", rename = "sequence")]
pub(super) struct Status {
    pub state: State,
    pub name: String,
    pub text: String,
    /// Number of the line under way, or that is next; from 1.
    pub line: Option<usize>,
    pub done: usize,
    pub total: usize,
    /// Whether it ended as it was meant to, or pauses because it was told to.
    pub good: bool,
    pub said: String,
    pub answers: Vec<Answered>,
}

/// The handle that all pages share.
#[derive(Clone)]
pub(in crate::web) struct Sequence {
    orders: mpsc::UnboundedSender<Order>,
    told: watch::Receiver<Arc<str>>,
}

impl Sequence {
    /// To be called within the runtime.
    pub fn start(bridge: Bridge, journal: Journal) -> Self {
        let (orders, incoming) = mpsc::unbounded_channel();
        let status = Status {
            state: State::Idle,
            name: String::new(),
            text: String::new(),
            line: None,
            done: 0,
            total: 0,
            good: true,
            said: String::new(),
            answers: Vec::new(),
        };
        let (tell, told) = watch::channel(json(&status));
        let runner = Runner {
            incoming,
            bridge,
            journal,
            status,
            tell,
            page: 0,
            halts: false,
        };
        tokio::spawn(runner.run());
        Self { orders, told }
    }

    /// Has it done; the state tells what came of it. A stop must not find the way full: there is no limit to what waits, and
    /// whatever the runner does it takes orders meanwhile.
    pub fn order(&self, order: Order) {
        // Its task ends with the server only.
        let _ = self.orders.send(order);
    }

    /// The state, as a message for pages.
    pub fn told(&self) -> watch::Receiver<Arc<str>> {
        self.told.clone()
    }
}

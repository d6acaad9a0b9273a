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

use tokio::sync::{mpsc, watch};

use super::journal::Journal;
use super::runner::Runner;
use super::sequence_status::{Order, Orderer, State, Status};
use crate::web::bridge::{Bridge, json};

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
            by: Orderer::default(),
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

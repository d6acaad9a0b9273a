//! What a commissioning and a calibration have in common: each brings the stage about for minutes, with somebody at a page who can end it.
//!
//! | file | idea |
//! |---|---|
//! | here | how the controller is reached; an order and whose it is |
//! | `control` | what reaches a run from outside: that a task is done, what an instrument reads, that it is to wait, that it is to end |
//! | `machine` | the machine as a run sees it, over the way that its page has to the controller |
//! | `told` | what pages are told of a run, and that they are |
//! | `steps` | steps as pages are told of them |
//! | `files` | plots, tables and reports, for browsers to fetch |

mod control;
mod files;
mod machine;
mod steps;
mod told;

use std::sync::Arc;

use tokio::runtime::Handle;

use crate::commission::Task;
use crate::web::bridge::Bridge;
pub(in crate::web) use control::Control;
pub(in crate::web) use files::Files;
pub(super) use machine::PageMachine;
pub(super) use steps::{Failed, PlotPlace, StepStatus, places};
pub(super) use told::{OfRun, Run, Told};

/// Who does with a simulated machine what a person does with a real one.
pub type Person = Arc<dyn Fn(Task) + Send + Sync>;

/// How a run reaches the controller, and is reached itself. Runs share what reaches them: one is under way at a time.
#[derive(Clone)]
pub(in crate::web) struct Reach {
    pub bridge: Bridge,
    pub runtime: Handle,
    pub control: Arc<Control>,
}

/// An order, and whose it is.
#[derive(Debug, PartialEq)]
pub(in crate::web) struct Ordered<O> {
    pub order: O,
    /// Whoever uses the page.
    pub who: String,
    pub page: u64,
    /// Of the page's way to the controller.
    pub key: String,
}

impl Reach {
    /// Ends what is under way.
    pub fn end(&self) {
        self.control.end("an operator");
        // Where nobody is reached, the run finds that itself.
        let _ = self.bridge.stop();
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
}

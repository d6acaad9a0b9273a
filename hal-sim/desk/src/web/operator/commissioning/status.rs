//! What pages are told of a commissioning.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use serde::Serialize;
use tokio::sync::watch;

use super::super::runs::{Failed, Files, PlotPlace, StepStatus, UNDER_WAY, places};
use crate::commission::{Done, MOST_SENSITIVITY, Numbers, STEPS, Step, Task, Worth};
use crate::web::bridge::json;

/// What pages are told.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "kind", rename = "commissioning")]
pub(super) struct Status {
    /// Whether something is under way.
    pub runs: bool,
    /// What it is, or was.
    pub what: &'static str,
    /// Names of all that there are.
    pub all_steps: Vec<&'static str>,
    pub steps: Vec<StepStatus>,
    pub asks: Option<Asks>,
    /// Whether it ended as it was meant to.
    pub good: bool,
    pub said: String,
    /// Where the report is, once there is one, and the tables.
    pub report: Option<String>,
    pub tables: Vec<String>,
    /// Where what was in force before is; it can be given back.
    pub before: Option<String>,
    pub tuning: Option<Tuning>,
}

/// What the person is asked for.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Asks {
    /// `turn` or `jig`.
    pub task: &'static str,
    pub words: &'static str,
    /// Whether somebody has to say that it is done.
    pub waits: bool,
    /// Whether the simulated machine's simulated person does it.
    pub is_simulated: bool,
}

/// The loops that were measured last, and what other gains would make of them.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Tuning {
    pub most_ms: f64,
    /// The gains with which they were measured.
    pub gains: Numbers,
    pub measured: Vec<Worth>,
    pub plots: Vec<PlotPlace>,
    pub tried: Option<Tried>,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct Tried {
    pub gains: Numbers,
    pub is_stable: bool,
    pub loops: Vec<Worth>,
    pub plots: Vec<PlotPlace>,
}

impl Tuning {
    pub fn new(gains: Numbers, measured: Vec<Worth>, plots: Vec<PlotPlace>) -> Self {
        Self {
            most_ms: MOST_SENSITIVITY,
            gains,
            measured,
            plots,
            tried: None,
        }
    }
}

/// A step as it has ended.
fn take(step: &mut StepStatus, done: &Done, files: &Files) {
    step.seconds = done.seconds;
    step.findings = done.found.findings.iter().map(Into::into).collect();
    step.plots = places(&done.found.plots, files);
    step.end(done.failure.as_ref().map(|failure| Failed {
        what: failure.what.clone(),
        advice: failure.advice.to_owned(),
    }));
}

/// The state, and those who are told each change of it.
pub(super) struct Told {
    status: Mutex<Status>,
    tell: watch::Sender<Arc<str>>,
}

impl Told {
    pub fn new() -> Self {
        let status = Status {
            runs: false,
            what: "",
            all_steps: STEPS.iter().map(|step| step.name).collect(),
            steps: Vec::new(),
            asks: None,
            good: true,
            said: String::new(),
            report: None,
            tables: Vec::new(),
            before: None,
            tuning: None,
        };
        let (tell, _) = watch::channel(json(&status));
        Self {
            status: Mutex::new(status),
            tell,
        }
    }

    pub fn receiver(&self) -> watch::Receiver<Arc<str>> {
        self.tell.subscribe()
    }

    fn status(&self) -> MutexGuard<'_, Status> {
        self.status.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes it, and tells it.
    pub fn change<T>(&self, change: impl FnOnce(&mut Status) -> T) -> T {
        let mut status = self.status();
        let result = change(&mut status);
        // Within the lock, so that none overtakes another.
        self.tell.send_replace(json(&*status));
        result
    }

    /// Something begins; with these steps, if it has some.
    pub fn begins(&self, what: &'static str, steps: Option<&[&'static Step]>) {
        self.change(|status| {
            (status.runs, status.what, status.good) = (true, what, true);
            status.said.clear();
            if let Some(steps) = steps {
                status.steps = (steps
                    .iter()
                    .map(|step| StepStatus::waiting(step.name, step.about)))
                .collect();
                status.report = None;
                next(&mut status.steps);
            }
        });
    }

    /// It is over.
    pub fn ends(&self, good: bool, said: String) {
        self.change(|status| {
            (status.runs, status.good, status.said) = (false, good, said);
            status.asks = None;
            for step in &mut status.steps {
                if step.state == "runs" {
                    step.state = "waits";
                }
            }
        });
    }

    /// An order that comes while another is under way.
    pub fn refuses(&self, what: &'static str) {
        self.change(|status| {
            // Of what runs here, pages are told all along.
            if !status.runs {
                (status.what, status.good) = (what, false);
                UNDER_WAY.clone_into(&mut status.said);
            }
        });
    }

    /// A step has ended.
    pub fn step(&self, done: &Done, files: &Files) {
        self.change(|status| {
            status.asks = None;
            let step = (status.steps.iter_mut()).find(|step| step.name == done.step.name);
            if let Some(step) = step {
                take(step, done, files);
            }
            if done.failure.is_none() {
                next(&mut status.steps);
            }
        });
    }

    /// The person is asked for something.
    pub fn asks(&self, task: Task, is_simulated: bool) {
        self.change(|status| {
            status.asks = Some(Asks {
                task: match task {
                    Task::Turn => "turn",
                    Task::PutOnJig => "jig",
                },
                words: task.words(),
                waits: task == Task::PutOnJig && !is_simulated,
                is_simulated,
            });
        });
    }

    /// The person has said that it is done.
    pub fn answered(&self) {
        self.change(|status| status.asks = None);
    }

    /// Plots that pages show.
    pub fn plots(&self) -> Vec<String> {
        let status = self.status();
        let of_tuning = status.tuning.iter().flat_map(|tuning| {
            let tried = tuning.tried.iter().flat_map(|tried| &tried.plots);
            tuning.plots.iter().chain(tried)
        });
        (status.steps.iter().flat_map(|step| &step.plots))
            .chain(of_tuning)
            .map(|plot| plot.path.clone())
            .collect()
    }
}

/// The first that waits runs.
fn next(steps: &mut [StepStatus]) {
    if let Some(step) = steps.iter_mut().find(|step| step.state == "waits") {
        step.state = "runs";
    }
}

//! What pages are told of a commissioning.

use serde::Serialize;

use super::super::runs::{Failed, Files, OfRun, PlotPlace, Run, StepStatus, Told, places};
use crate::commission::{Done, MOST_SENSITIVITY, Numbers, STEPS, Step, Task, Worth};

/// What pages are told.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "kind", rename = "commissioning")]
pub(super) struct Status {
    #[serde(flatten)]
    pub run: Run,
    /// Names of all that there are.
    pub all_steps: Vec<&'static str>,
    pub steps: Vec<StepStatus>,
    pub asks: Option<Asks>,
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
    /// `turn`, `jig` or `out`.
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

impl OfRun for Status {
    fn run(&mut self) -> &mut Run {
        &mut self.run
    }
}

impl Status {
    /// Nothing so far.
    pub fn new() -> Self {
        Self {
            run: Run::default(),
            all_steps: STEPS.iter().map(|step| step.name).collect(),
            steps: Vec::new(),
            asks: None,
            report: None,
            tables: Vec::new(),
            before: None,
            tuning: None,
        }
    }

    /// These steps begin.
    pub fn begin(&mut self, steps: &[&Step]) {
        let waiting = |step: &&Step| StepStatus::waiting(step.name, step.about);
        self.steps = steps.iter().map(waiting).collect();
        self.report = None;
        next(&mut self.steps);
    }

    /// No step runs, and nobody is asked for anything.
    pub fn rests(&mut self) {
        self.asks = None;
        for step in &mut self.steps {
            if step.state == "runs" {
                step.state = "waits";
            }
        }
    }
}

impl Told<Status> {
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
                    Task::TakeOutJig => "out",
                },
                words: task.words(),
                waits: task.is_said_to_be_done() && !is_simulated,
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

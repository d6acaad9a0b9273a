//! What pages are told of a calibration.

use calibration::kit::KITS;
use serde::Serialize;

use super::super::runs::{Failed, OfRun, Run, StepStatus, Told};

/// Name and purpose of each step.
const STEPS: [(&str, &str); 5] = [
    (
        PLAN,
        "where to measure, and what will come of it; nothing moves",
    ),
    (MEASURE, "from pose to pose, the instrument read at each"),
    (FIT, "what the machine is off its drawing"),
    (
        APPLY,
        "in the controller, unless what is in force explains the measurement better",
    ),
    (
        VERIFY,
        "judged at fresh poses, each gone to from both sides",
    ),
];
pub(super) const PLAN: &str = "plan";
pub(super) const MEASURE: &str = "measure";
pub(super) const FIT: &str = "fit";
pub(super) const APPLY: &str = "apply";
pub(super) const VERIFY: &str = "verify";

/// What pages are told.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "kind", rename = "calibration")]
pub(super) struct Status {
    /// Instruments that there are.
    pub kits: Vec<&'static str>,
    /// What reads them, unless whoever looks at a page does.
    pub reads: Option<&'static str>,
    #[serde(flatten)]
    pub run: Run,
    pub is_paused: bool,
    pub progress: Option<Progress>,
    pub asks: Option<Asks>,
    pub steps: Vec<StepStatus>,
    /// Whether there is a measurement to go on with, and one to give to the controller.
    pub may_resume: bool,
    pub may_apply: bool,
    /// Where the report is, once there is one; and what else there is.
    pub report: Option<String>,
    pub files: Vec<String>,
}

/// Visits so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub(super) struct Progress {
    pub made: usize,
    pub of: usize,
}

/// What whoever looks at a page is asked for.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Asks {
    /// From 1.
    pub visit: usize,
    /// Where the stage was sent, and what is looked at there.
    pub where_to: String,
    /// Names of the numbers that are wanted.
    pub fields: &'static str,
    /// What is wrong with what was said before.
    pub wrong: String,
}

impl OfRun for Status {
    fn run(&mut self) -> &mut Run {
        &mut self.run
    }
}

impl Status {
    /// Nothing so far. `reads`: what reads instruments.
    pub fn new(reads: Option<&'static str>) -> Self {
        Self {
            kits: KITS.iter().map(|kit| kit.name()).collect(),
            reads,
            run: Run::default(),
            is_paused: false,
            progress: None,
            asks: None,
            steps: (STEPS.iter())
                .map(|(name, about)| StepStatus::waiting(name, about))
                .collect(),
            may_resume: false,
            may_apply: false,
            report: None,
            files: Vec::new(),
        }
    }

    /// Nothing of a measurement is under way.
    pub fn rests(&mut self) {
        (self.is_paused, self.progress, self.asks) = (false, None, None);
    }
}

impl Told<Status> {
    /// A step begins; those behind it are still to come.
    pub fn step_begins(&self, name: &str) {
        self.change(|status| {
            let from = status.steps.iter().position(|step| step.name == name);
            for step in status.steps.iter_mut().skip(from.unwrap_or(0)) {
                *step = StepStatus::waiting(step.name, step.about);
                if step.name == name {
                    step.state = "runs";
                }
            }
        });
    }

    /// What is known of a step.
    pub fn step(&self, name: &str, change: impl FnOnce(&mut StepStatus)) {
        self.change(|status| {
            if let Some(step) = status.steps.iter_mut().find(|step| step.name == name) {
                change(step);
            }
        });
    }

    /// A step has ended.
    pub fn step_ends(&self, name: &str, seconds: f64, failure: Option<Failed>) {
        self.step(name, |step| {
            step.seconds = seconds;
            step.end(failure);
        });
    }

    /// Plots that pages show.
    pub fn plots(&self) -> Vec<String> {
        let status = self.status();
        let plots = status.steps.iter().flat_map(|step| &step.plots);
        plots.map(|plot| plot.path.clone()).collect()
    }
}

//! Steps as pages are told of them.

use serde::Serialize;

use super::files::Files;
use crate::calibrate::Line;
use crate::commission::{Finding, Plot};

#[derive(Clone, Debug, Serialize)]
pub(in super::super) struct StepStatus {
    pub name: &'static str,
    pub about: &'static str,
    /// `waits`, `runs`, `done`, `failed`.
    pub state: &'static str,
    pub seconds: f64,
    pub findings: Vec<FindingStatus>,
    pub plots: Vec<PlotPlace>,
    pub failure: Option<Failed>,
}

#[derive(Clone, Debug, Serialize)]
pub(in super::super) struct FindingStatus {
    pub name: String,
    pub value: String,
    pub limit: String,
    pub passed: bool,
}

#[derive(Clone, Debug, Serialize)]
pub(in super::super) struct PlotPlace {
    pub path: String,
    pub caption: String,
}

/// Why a step has failed.
#[derive(Clone, Debug, Serialize)]
pub(in super::super) struct Failed {
    pub what: String,
    /// What to do.
    pub advice: String,
}

impl From<&Finding> for FindingStatus {
    fn from(finding: &Finding) -> Self {
        Self {
            name: finding.name.clone(),
            value: finding.value.clone(),
            limit: finding.limit.clone(),
            passed: finding.passed,
        }
    }
}

impl From<Line> for FindingStatus {
    fn from(line: Line) -> Self {
        Self {
            name: line.what,
            value: line.text,
            limit: String::new(),
            passed: line.is_good,
        }
    }
}

impl StepStatus {
    /// One that is still to come.
    pub const fn waiting(name: &'static str, about: &'static str) -> Self {
        Self {
            name,
            about,
            state: "waits",
            seconds: 0.0,
            findings: Vec::new(),
            plots: Vec::new(),
            failure: None,
        }
    }

    /// It is over.
    pub fn end(&mut self, failure: Option<Failed>) {
        self.state = if failure.is_some() { "failed" } else { "done" };
        self.failure = failure;
    }
}

/// Plots as files.
pub(in super::super) fn places(plots: &[Plot], files: &Files) -> Vec<PlotPlace> {
    (plots.iter())
        .map(|plot| PlotPlace {
            path: files.put_plot(&plot.svg),
            caption: plot.caption.clone(),
        })
        .collect()
}

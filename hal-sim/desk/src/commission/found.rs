//! What a step has found, and why one fails.

use crate::record::RecordError;
use serde::{Deserialize, Serialize};

/// A number, its limit, and whether it is inside.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// What was measured.
    pub name: String,
    /// The number with its unit.
    pub value: String,
    /// What it has to be.
    pub limit: String,
    /// Whether it is.
    pub passed: bool,
    /// What to do where it is not.
    pub advice: &'static str,
}

impl Finding {
    /// A finding.
    pub fn new(
        name: impl Into<String>,
        value: impl Into<String>,
        limit: impl Into<String>,
        passed: bool,
        advice: &'static str,
    ) -> Self {
        Self {
            name: name.into(),
            value: value.into(),
            limit: limit.into(),
            passed,
            advice,
        }
    }

    /// What is told without being judged.
    pub fn told(name: impl Into<String>, value: impl Into<String>) -> Self {
        Self::new(name, value, "", true, "")
    }
}

/// A picture, and what it shows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plot {
    /// What it shows.
    pub caption: String,
    /// As SVG.
    pub svg: String,
}

/// A number for machines to read: what a later commissioning of the same stage is held against.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Number {
    /// What was measured.
    pub name: String,
    /// Its unit; none for what has none.
    pub unit: String,
    /// How much.
    pub value: f64,
}

/// Rows of numbers, as a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Table {
    /// What the file is called, without its ending.
    pub name: String,
    /// Its text: names with their units in the first line.
    pub csv: String,
}

/// All that a step has found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Found {
    /// What is told.
    pub findings: Vec<Finding>,
    /// The same as numbers.
    pub numbers: Vec<Number>,
    /// Rows of numbers.
    pub tables: Vec<Table>,
    /// Pictures.
    pub plots: Vec<Plot>,
}

impl Found {
    /// A finding more.
    pub fn push(&mut self, finding: Finding) {
        self.findings.push(finding);
    }

    /// A number more.
    pub fn number(&mut self, name: impl Into<String>, value: f64, unit: &str) {
        self.numbers.push(Number {
            name: name.into(),
            unit: unit.to_owned(),
            value,
        });
    }
}

/// Why a step has failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Failure {
    /// What is wrong.
    pub what: String,
    /// What to do.
    pub advice: &'static str,
}

impl Failure {
    /// A failure.
    pub fn new(what: impl Into<String>, advice: &'static str) -> Self {
        Self {
            what: what.into(),
            advice,
        }
    }
}

/// Why a step ends early.
#[derive(Debug, thiserror::Error)]
pub enum CommissionError {
    /// The controller.
    #[error(transparent)]
    Controller(#[from] RecordError),
    /// The machine.
    #[error("{}", .0.what)]
    Failed(Failure),
}

/// Ends a step.
pub(super) fn fail<T>(what: impl Into<String>, advice: &'static str) -> Result<T, CommissionError> {
    Err(CommissionError::Failed(Failure::new(what, advice)))
}

//! What a commissioning has measured, as numbers, and what has changed since the last one.

use super::Done;
use super::found::Number;
use commissioning::drive_model::COPPER_1_K;
use drawing::{read_text, write_whole};
use serde::{Deserialize, Serialize};
use std::io;
use std::path::{Path, PathBuf};

/// Under what it was measured.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Conditions {
    /// What the machine is called.
    pub machine: String,
    /// Who answers: maker, controller, serial number, version.
    pub identity: String,
    /// The day, as in 2026-11-23.
    pub date: String,
    /// Of the air, deg C, where somebody has said it.
    pub temperature_c: Option<f64>,
}

/// See the module.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Results {
    /// Under what.
    pub conditions: Conditions,
    /// What each step came to.
    pub steps: Vec<StepResult>,
}

/// What a step came to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StepResult {
    /// Which.
    pub name: String,
    /// How long it took, by the controller's clock, s.
    pub seconds: f64,
    /// Why it has failed.
    pub failure: Option<String>,
    /// What it measured.
    pub numbers: Vec<Number>,
}

/// A number that is not what it was.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// Of which step.
    pub step: String,
    /// What it is now.
    pub now: Number,
    /// What it was.
    pub before: f64,
}

/// Why results cannot be kept or read.
#[derive(Debug, thiserror::Error)]
pub enum ResultsError {
    /// The file.
    #[error("{}: {error}", path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// What the system says.
        error: io::Error,
    },
    /// What is in it.
    #[error("{}: no results of a commissioning: {error}", path.display())]
    Text {
        /// Which.
        path: PathBuf,
        /// Where it is none.
        error: serde_json::Error,
    },
}

/// Longest file: many times what a commissioning finds.
const LONGEST_BYTES: u64 = 1 << 20;
/// Share of a number that is no change worth a word.
const NO_CHANGE: f64 = 0.01;

impl Results {
    /// From what the steps came to.
    #[must_use]
    pub fn new(conditions: Conditions, all: &[Done]) -> Self {
        let step = |done: &Done| StepResult {
            name: done.step.name.to_owned(),
            seconds: done.seconds,
            failure: done.failure.as_ref().map(|failure| failure.what.clone()),
            numbers: done.found.numbers.clone(),
        };
        Self {
            conditions,
            steps: all.iter().map(step).collect(),
        }
    }

    /// Writes them, whole or not at all; steps that were not run stay as an earlier run of the same controller left them.
    ///
    /// # Errors
    /// [`ResultsError`]
    pub fn write(&self, path: &Path, before: Option<&Self>) -> Result<(), ResultsError> {
        let mut all = self.clone();
        let earlier = before.map_or(&[][..], |before| &before.steps);
        all.steps.extend(
            (earlier.iter())
                .filter(|one| self.step(&one.name).is_none())
                .cloned(),
        );
        (serde_json::to_vec_pretty(&all).map_err(io::Error::from))
            .and_then(|text| write_whole(path, &text))
            .map_err(|error| ResultsError::File {
                path: path.to_owned(),
                error,
            })
    }

    /// Reads those of the same controller; none where there is no file, or where it is another's.
    ///
    /// # Errors
    /// [`ResultsError`]
    pub fn read(path: &Path, identity: &str) -> Result<Option<Self>, ResultsError> {
        let text = match read_text(path, LONGEST_BYTES) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            text => text.map_err(|error| ResultsError::File {
                path: path.to_owned(),
                error,
            })?,
        };
        let results: Self = serde_json::from_str(&text).map_err(|error| ResultsError::Text {
            path: path.to_owned(),
            error,
        })?;
        Ok((results.conditions.identity == identity).then_some(results))
    }

    fn step(&self, name: &str) -> Option<&StepResult> {
        self.steps.iter().find(|step| step.name == name)
    }

    /// What is not what it was, the largest change first.
    #[must_use]
    pub fn changes(&self, before: &Self) -> Vec<Change> {
        let mut changes: Vec<_> = (self.steps.iter())
            .filter_map(|step| Some((step, before.step(&step.name)?)))
            .flat_map(|(now, before)| {
                now.numbers.iter().filter_map(|number| {
                    let was = (before.numbers.iter())
                        .find(|was| was.name == number.name && was.unit == number.unit)?;
                    Some(Change {
                        step: now.name.clone(),
                        now: number.clone(),
                        before: was.value,
                    })
                })
            })
            .filter(|change| !(change.share().abs() < NO_CHANGE))
            .collect();
        changes.sort_by(|a, b| b.share().abs().total_cmp(&a.share().abs()));
        changes
    }
}

impl Change {
    /// By how much, over what it was.
    #[must_use]
    pub fn share(&self) -> f64 {
        if self.now.value == self.before {
            0.0
        } else {
            (self.now.value - self.before) / self.before.abs()
        }
    }

    /// In words.
    #[must_use]
    pub fn words(&self) -> String {
        let Number { name, unit, value } = &self.now;
        let share = self.share();
        // Copper does that alone.
        let warmer = if unit == "ohm" {
            format!(", as a winding that is {:+.0} K warmer", share / COPPER_1_K)
        } else {
            String::new()
        };
        format!(
            "{}: {name}: {} {unit}, before {} ({:+.1} %{warmer})",
            self.step,
            four_digits(*value),
            four_digits(self.before),
            100.0 * share
        )
    }
}

/// Four digits that count.
fn four_digits(value: f64) -> String {
    let whole = value.abs().log10().floor();
    let places = if whole.is_finite() {
        (3.0 - whole).clamp(0.0, 9.0)
    } else {
        0.0
    };
    format!("{value:.*}", places as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn results(ohm: f64, kg: f64) -> Results {
        let number = |name: &str, unit: &str, value: f64| Number {
            name: name.to_owned(),
            unit: unit.to_owned(),
            value,
        };
        Results {
            conditions: Conditions::default(),
            steps: vec![StepResult {
                name: "identification".to_owned(),
                numbers: vec![
                    number("winding of pivot 1", "ohm", ohm),
                    number("mass", "kg", kg),
                ],
                ..StepResult::default()
            }],
        }
    }

    #[test]
    fn what_has_changed_is_told_with_its_size() {
        let changes = results(2.2, 5.02).changes(&results(2.0, 5.0));
        let words: Vec<_> = changes.iter().map(Change::words).collect();
        assert_eq!(
            words,
            [
                "identification: winding of pivot 1: 2.200 ohm, before 2.000 (+10.0 %, as a winding that is +26 K warmer)"
            ]
        );
        let changes = results(2.0, 6.0).changes(&results(2.0, 5.0));
        assert_eq!(
            changes[0].words(),
            "identification: mass: 6.000 kg, before 5.000 (+20.0 %)"
        );
    }

    #[test]
    fn what_is_written_is_read_and_of_one_controller_alone() {
        let folder = std::env::temp_dir().join(format!("tripivot-results-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let path = folder.join("results.json");
        assert!(matches!(Results::read(&path, ""), Ok(None)));
        let mut first = results(2.0, 5.0);
        first.steps[0].name = "friction".to_owned();
        first.write(&path, None).expect("written");
        let before = Results::read(&path, "").expect("read").expect("the same");
        assert_eq!(before, first);
        results(2.0, 5.0)
            .write(&path, Some(&before))
            .expect("written");
        let all = Results::read(&path, "").expect("read").expect("the same");
        assert_eq!(all.steps.len(), 2);
        assert!(matches!(Results::read(&path, "another"), Ok(None)));
        std::fs::write(&path, "no numbers").expect("written");
        assert!(matches!(
            Results::read(&path, ""),
            Err(ResultsError::Text { .. })
        ));
        let _ = std::fs::remove_dir_all(&folder);
    }
}

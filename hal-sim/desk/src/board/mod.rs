//! `tripivot board`: the tests to be repeated on every board, over its command line, with what is expected of each.
//!
//! | file | idea |
//! |---|---|
//! | here | running the plan |
//! | `plan` | the tests |
//! | `controller` | what the tests ask the controller |
//! | `report` | what was found, as a page |

mod controller;
mod plan;
mod report;

use crate::line::Endpoint;
use crate::record::RecordError;
use controller::Controller;
pub use plan::PLAN;
pub use report::{Done, page};

/// A test of the plan.
pub struct Test {
    /// What it is called.
    pub name: &'static str,
    /// What has to be found.
    pub expected: &'static str,
    /// Whether the stage moves.
    pub moves: bool,
    run: fn(&mut Controller) -> Result<Found, RecordError>,
}

/// What a test has found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Found {
    /// In words and numbers.
    pub text: String,
    /// Whether that is what is expected.
    pub verdict: Verdict,
}

/// Whether what was found is what is expected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It is.
    Passed,
    /// An emulated chip can not show it: it is told, and nothing is said about it.
    NotJudged,
    /// It is not.
    Failed,
}

impl From<bool> for Verdict {
    fn from(passed: bool) -> Self {
        if passed { Self::Passed } else { Self::Failed }
    }
}

/// How the plan is run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PlanOptions {
    /// The tests that move the stage too.
    pub moves: bool,
    /// The controller runs on an emulated chip: its seconds are not those of this machine.
    pub emulated: bool,
}

/// What has come of the plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// No test has failed.
    pub passed: bool,
    /// Who was tested.
    pub identity: String,
    /// What `TST?` has answered before the tests; nothing where it was refused.
    pub self_test: String,
}

/// Runs the plan and tells of every test as it ends: `None` for one that was left out.
///
/// A test that the controller refuses has failed; the rest is run all the same. The servo is off at the end of tests that move.
///
/// # Errors
/// [`RecordError`] when nobody answers, or no longer.
pub fn run(
    endpoint: &Endpoint,
    options: PlanOptions,
    tell: &mut dyn FnMut(&'static Test, Option<Found>),
) -> Result<Outcome, RecordError> {
    let mut controller = Controller::open(endpoint, options.emulated)?;
    let mut outcome = Outcome {
        passed: true,
        identity: controller.identity().to_owned(),
        self_test: match controller.ask("TST?") {
            Ok(answer) => answer,
            Err(RecordError::Refused { .. }) => String::new(),
            Err(error) => return Err(error),
        },
    };
    for test in PLAN {
        if test.moves && !options.moves {
            tell(test, None);
            continue;
        }
        let found = match (test.run)(&mut controller) {
            Ok(found) => found,
            Err(error @ (RecordError::Refused { .. } | RecordError::Strange { .. })) => Found {
                text: error.to_string(),
                verdict: Verdict::Failed,
            },
            Err(error) => return Err(error),
        };
        outcome.passed &= found.verdict != Verdict::Failed;
        tell(test, Some(found));
    }
    Ok(outcome)
}

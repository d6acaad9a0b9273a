//! `tripivot commission`: from a machine that nobody knows to one that moves, step by step, over its command line alone.
//!
//! Every step says what it measured, what the limit is, and what to do where it fails; the first that fails ends it. Until the last step
//! nothing is kept: `RPA` brings back what was there before, and an end by failure does that by itself.
//!
//! | file | idea |
//! |---|---|
//! | here | what is asked of a machine and of the person beside it; the sequence |
//! | `bench` | questions, excitations and records, as the steps need them |
//! | `chosen` | which steps are run |
//! | `found` | what a step has found, and why one fails |
//! | `id` | numbers of parameters |
//! | `known` | what is known of the machine so far |
//! | `servo_gains` | gains and filters, to and from the controller's parameters |
//! | `measured_loop` | a loop as measured, its margins and its plots |
//! | `by_hand` | what other gains would make of the loops |
//! | `sines` | multisines on one motor after the other |
//! | `touch` | a ring moved alone until a guide is at its end |
//! | `steps/` | a file each |
//! | `aside` | parameters that are others for a time |
//! | `results` | all of it, as numbers, and what has changed since the last time |
//! | `report` | all of it, as one page |
//! | `backup` | what a controller was told before, and giving that back |

mod aside;
mod backup;
mod bench;
mod by_hand;
mod chosen;
mod found;
mod id;
mod known;
mod measured_loop;
mod report;
mod results;
mod servo_gains;
mod sines;
mod steps;
mod touch;

pub use backup::Backup;
pub use by_hand::{GainsError, MOST_SENSITIVITY, Predicted, PutError, Tunable, Worth};
pub use chosen::{ChoiceError, Chosen, MOST_ALSO_CARRIED_KG, ZerosBy};
pub use found::{CommissionError, Failure, Finding, Found, Number, Plot, Table};
pub use report::page;
pub use results::{Change, Conditions, Results, ResultsError, StepResult};
pub use servo_gains::{NUMBERS, Numbers};
pub use steps::STEPS;

use crate::line::Endpoint;
use crate::record::{Desk, RecordError};
use crate::settings::bring_back;
pub(crate) use aside::Aside;
pub(crate) use bench::Bench;
pub(crate) use id::GUIDE_STIFFNESS;
use known::Known;
use std::time::Duration;
pub(crate) use touch::{LIMITS as EXCITATION_LIMITS, Touch};

/// A machine with its controller, and somebody beside it.
pub trait Machine {
    /// A line, and its answer if it has one.
    ///
    /// # Errors
    /// [`RecordError::Refused`] with the error that it leaves; others when nobody answers.
    fn ask(&mut self, line: &str) -> Result<Option<String>, RecordError>;
    /// Lets seconds of the controller's clock pass.
    ///
    /// # Errors
    /// When nobody answers.
    fn delay(&mut self, seconds: f64) -> Result<(), RecordError>;
    /// Asks the person beside it to do something.
    ///
    /// # Errors
    /// When nobody is there.
    fn request(&mut self, task: Task) -> Result<(), RecordError>;
    /// Periods of the encoders' scale in a turn, as their data sheet has them; `None` where nobody has looked.
    fn scale_periods(&self) -> Option<u32> {
        None
    }
}

/// What only a person can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// Begins to; the encoders tell when it is done.
    Turn,
    /// Says when it is done.
    PutOnJig,
    /// Takes it out again; a ring that moves freely tells when it is done.
    TakeOutJig,
}

impl Task {
    /// Whether the person has to say that it is done: nothing goes on before.
    #[must_use]
    pub const fn is_said_to_be_done(self) -> bool {
        matches!(self, Self::PutOnJig)
    }

    /// In words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Turn => {
                "Push the platform 2 to 5 cm out of the middle. Then turn it by hand to the left, seen from above, by a quarter of a turn, \
                 slowly, and keep its middle about where it is."
            }
            Self::PutOnJig => {
                "Bring the platform into the middle and put in the jig: guide 1 points along x, away from the middle, over pivot 1."
            }
            Self::TakeOutJig => {
                "Take the jig out again. Ring 1 is nudged by a milliradian now and then, until it moves freely."
            }
        }
    }
}

/// A step of commissioning.
pub struct Step {
    /// What it is called.
    pub name: &'static str,
    /// What it does.
    pub about: &'static str,
    run: fn(&mut Bench<'_>, &mut Known, &mut Found) -> Result<(), CommissionError>,
}

/// What a step came to.
pub struct Done {
    /// Which.
    pub step: &'static Step,
    /// What it measured.
    pub found: Found,
    /// Why it has failed.
    pub failure: Option<Failure>,
    /// How long it took, by the controller's clock, s.
    pub seconds: f64,
}

/// What a run came to.
pub struct Ran {
    /// Each step.
    pub done: Vec<Done>,
    /// The loops that were measured last; `None` where a step has failed, or none has measured any.
    pub tunable: Option<Tunable>,
}

/// Runs the steps that are chosen until one fails, tells of each as it ends; what all of them came to.
///
/// After a failure what is kept is in force again, and the motors are off; where that is refused, the failure says so. After steps that keep
/// nothing, failed or not, the motors are off and what was in force before is again.
///
/// # Errors
/// [`RecordError`] when nobody answers, or no longer.
pub fn run(
    machine: &mut dyn Machine,
    chosen: &Chosen,
    tell: &mut dyn FnMut(&Done),
) -> Result<Ran, RecordError> {
    let mut bench = Bench::in_base_frame(machine)?;
    let in_force = match chosen.keeps() {
        true => None,
        false => Some(bench.ask("SPA?")?),
    };
    let (mut known, mut all, mut failed) = (Known::default(), Vec::new(), false);
    for &step in &chosen.steps {
        let start_s = bench.clock_s()?;
        let mut found = Found::default();
        let begun = if all.is_empty() {
            chosen.begin(&mut bench).map(|begun| known = begun)
        } else {
            Ok(())
        };
        let ran = begun.and_then(|()| (step.run)(&mut bench, &mut known, &mut found));
        let failure = match ran {
            Ok(()) => (found.findings.iter().find(|finding| !finding.passed))
                .map(|finding| Failure::new(finding.name.clone(), finding.advice)),
            Err(CommissionError::Failed(failure)) => Some(failure),
            Err(CommissionError::Controller(error @ RecordError::Refused { .. })) => {
                let fault = bench.fault()?;
                let what = format!("{error}{fault}");
                Some(Failure::new(what, "see what FLT? and EVT? tell"))
            }
            Err(CommissionError::Controller(error)) => {
                return Err(ended(&mut bench, error));
            }
        };
        let seconds = bench.clock_s()? - start_s;
        let failure = match failure {
            Some(failure) => Some(given_up(&mut bench, failure)?),
            None => None,
        };
        let done = Done {
            step,
            found,
            failure,
            seconds,
        };
        tell(&done);
        failed = done.failure.is_some();
        all.push(done);
        if failed {
            break;
        }
    }
    if in_force.is_some() && !failed {
        bench.give_up()?;
    }
    let as_before = bench.give_back_recorder().and_then(|()| match in_force {
        Some(in_force) => bring_back(&mut |line| bench.answer(line), &in_force),
        None => Ok(()),
    });
    if let Err(error @ RecordError::Refused { .. }) = as_before {
        failed = true;
        if let Some(last) = all.last_mut() {
            not_as_before(last, &error);
        }
    } else {
        as_before?;
    }
    let tunable = match failed {
        true => None,
        false => Tunable::of(known, &mut bench)?,
    };
    Ok(Ran { done: all, tunable })
}

/// After a controller or a person who does not answer any more: everything as it was before, where that is the person; why it has ended, and what was
/// refused of that.
fn ended(bench: &mut Bench<'_>, error: RecordError) -> RecordError {
    match bench.give_up() {
        Err(refused @ RecordError::Refused { .. }) => RecordError::NotAsBefore {
            error: Box::new(error),
            refused: Box::new(refused),
        },
        // Where nobody answers nothing more is known.
        _ => error,
    }
}

/// After a failure: everything as it was before, or what was refused of that.
fn given_up(bench: &mut Bench<'_>, mut failure: Failure) -> Result<Failure, RecordError> {
    match bench.give_up() {
        Err(error @ RecordError::Refused { .. }) => {
            failure.what += &format!("; and what is kept is not in force again: {error}");
        }
        done => done?,
    }
    Ok(failure)
}

/// What was in force before a run that keeps nothing is not again.
fn not_as_before(last: &mut Done, error: &RecordError) {
    let what = format!("what was in force before is not in force again: {error}");
    let failure = last.failure.get_or_insert_with(|| Failure {
        what: String::new(),
        advice: "RPA brings back what is kept; the rest has to be set again",
    });
    let and = if failure.what.is_empty() {
        ""
    } else {
        "; and "
    };
    failure.what += &format!("{and}{what}");
}

/// Does what a person is asked for, or says that it is done.
pub type DoTask = Box<dyn FnMut(Task) -> std::io::Result<()>>;

/// A controller that runs, with somebody beside the machine.
pub struct Attended {
    desk: Desk,
    scale_periods: Option<u32>,
    do_task: DoTask,
}

impl Attended {
    /// # Errors
    /// When nobody answers there.
    pub fn open(endpoint: &Endpoint, do_task: DoTask) -> Result<Self, RecordError> {
        Ok(Self {
            desk: Desk::open(endpoint)?,
            scale_periods: None,
            do_task,
        })
    }

    /// The same with a controller that may be silent for so long: one that is emulated is slow.
    #[must_use]
    pub fn with_patience(mut self, patience: Duration) -> Self {
        self.desk.set_patience(patience);
        self
    }

    /// The same with the periods of the encoders' scale in a turn, where they are known.
    #[must_use]
    pub fn with_scale_periods(mut self, scale_periods: Option<u32>) -> Self {
        self.scale_periods = scale_periods;
        self
    }
}

impl Machine for Attended {
    fn ask(&mut self, line: &str) -> Result<Option<String>, RecordError> {
        self.desk.ask(line)
    }

    fn delay(&mut self, seconds: f64) -> Result<(), RecordError> {
        self.desk.delay(seconds)
    }

    fn request(&mut self, task: Task) -> Result<(), RecordError> {
        (self.do_task)(task).map_err(|error| RecordError::Broken {
            place: "the keyboard".to_owned(),
            error,
        })
    }

    fn scale_periods(&self) -> Option<u32> {
        self.scale_periods
    }
}

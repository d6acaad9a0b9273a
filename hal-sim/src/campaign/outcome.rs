//! What came of a run, and what is seen of it while it goes on.

use super::inputs::Inputs;
use super::pushed::MOST_N;
use super::rest::ToRest;
use super::scenario::Scenario;
use firmware::fault::Fault;
use firmware::mode::Mode;
use firmware::recorder::{Sample, TickObserver};

/// What came of a run.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What was run.
    pub scenario: Scenario,
    /// Whether it was run without the injection.
    pub is_control: bool,
    /// The tick in which what has to be latched, or has been, passed its threshold.
    pub effect: Option<u64>,
    /// Whether what was latched had a reason.
    pub is_founded: bool,
    /// The tick in which it has to be told at the latest.
    pub deadline: Option<u64>,
    /// What was latched first.
    pub fault: Option<Fault>,
    /// What ended the controlled stop of that.
    pub worse: Option<Fault>,
    /// The tick in which a second encoder was to be found lost, and the pivot, where the stage was still being stopped then.
    pub second: Option<(u64, usize)>,
    /// The tick of the event that tells of it where it is no fault.
    pub told: Option<u64>,
    /// The tick in which the outputs were cut by the watchdog, or by the program itself.
    pub cut: Option<u64>,
    /// Largest distance of the platform's centre from the path of its setpoint after the injection, mm.
    pub deviation_mm: f64,
    /// From when the reaction had to begin to the end.
    pub reaction: ToRest,
    /// The most that it may be; none where nothing has to react.
    pub bound: Option<ToRest>,
    /// What the tick has read from the injection on.
    pub inputs: Inputs,
    /// How much more that differs from the sound run than it might have without the fault; told where nothing was found.
    pub differs: Option<Differs>,
    /// How it ended.
    pub end: End,
    /// What the plant says of its own equations, which end where the platform is torn out of its guides or a gear's tooth breaks.
    pub is_torn: bool,
}

/// By how many times more what the controller reads differs from the sound run, in the channel in which it is most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Differs {
    /// Than other noise makes it differ.
    pub than_noise: f64,
    /// Than that or what the same machine is on another day.
    pub than_another_day: f64,
    /// Than either, once somebody has pushed.
    pub than_push: f64,
    /// The hardest of that push, N at a pivot.
    pub push_n: f64,
}

impl Differs {
    /// The first of four that it is.
    #[must_use]
    pub fn known(&self) -> Known {
        if self.than_noise < 1.0 {
            Known::WithinNoise
        } else if self.than_another_day < 1.0 {
            Known::WithinDays
        } else if self.than_push < 1.0 && self.push_n < MOST_N {
            Known::WithinPush
        } else {
            Known::Beyond
        }
    }
}

/// What a controller could have known of a fault by what it reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// Nothing: it differs from the sound run by less than noise.
    WithinNoise,
    /// Nothing: it differs by less than from one day to another.
    WithinDays,
    /// Nothing: it is as if somebody pushed.
    WithinPush,
    /// It differs by more.
    Beyond,
}

/// State at the end of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// No fault, and the servo is on.
    Driven,
    /// At rest, the bridges brake.
    Braked,
    /// At rest, the bridges let go.
    Released,
    /// Still turning when it was looked at last.
    Moving,
}

impl End {
    /// In a word.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Driven => "driven",
            Self::Braked => "braked",
            Self::Released => "released",
            Self::Moving => "moving",
        }
    }
}

/// What the tick has computed that the judgement needs.
#[derive(Default)]
pub(super) struct Seen(Option<Sample>);

impl Seen {
    pub fn sample(&self) -> Option<&Sample> {
        self.0.as_ref()
    }
}

impl TickObserver for Seen {
    fn observe(&mut self, sample: &Sample) {
        // A fault leaves no rates: those that were asked for last count.
        let last = self
            .0
            .take()
            .map_or(sample.pivot_rates, |last| last.pivot_rates);
        let mut sample = sample.clone();
        if !matches!(sample.mode, Mode::Holding | Mode::Moving | Mode::Stopping) {
            sample.pivot_rates = last;
        }
        self.0 = Some(sample);
    }
}

//! Whether the controller did what it has to in a run.

use core::fmt;

use firmware::fault::FaultKind;

use super::bound::MARGIN;
use super::injection::Injection;
use super::outcome::{End, Outcome};
use super::rest::ToRest;

/// What is wrong with a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Problem {
    /// A fault where there was nothing wrong.
    FalseAlarm,
    /// The servo oscillates without a fault, in the machine too: the settings that it was told do not fit.
    Unstable,
    /// The effect has passed its threshold and nothing was latched.
    Undetected,
    /// Latched so many ticks after the effect, more than it may be.
    Late(u64),
    /// Latched under a name that it does not have.
    WrongKind,
    /// Latched before anything had passed the threshold of that.
    Unfounded,
    /// The name of another pivot.
    WrongPivot,
    /// A second encoder was lost in the controlled stop, and that was not told, or not in time.
    SecondMissed,
    /// The outputs were cut so many ticks after the watchdog's time.
    CutLate(u64),
    /// It went on further, turned more, left its path by more, was pressed into an end more deeply, hit it harder than it may: what,
    /// how much and the bound (with its margin).
    Beyond(Measure, f64, f64),
    /// It still turned where it could be at rest.
    StillMoving,
}

/// What is held to a bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Way, mm.
    Way,
    /// Turn, deg.
    Turn,
    /// Distance from the path, mm.
    Deviation,
    /// Depth in a guide's end, mm.
    Depth,
    /// Energy of a blow, J.
    Blow,
}

impl Measure {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Way,
        Self::Turn,
        Self::Deviation,
        Self::Depth,
        Self::Blow,
    ];

    const fn of(self, to_rest: &ToRest) -> f64 {
        match self {
            Self::Way => to_rest.way_mm,
            Self::Turn => to_rest.turn_deg,
            Self::Deviation => to_rest.deviation_mm,
            Self::Depth => to_rest.depth_mm,
            Self::Blow => to_rest.blow_j,
        }
    }

    /// What a look between two samples may miss, and springs that let go: added to the bound.
    const fn least(self) -> f64 {
        match self {
            Self::Way | Self::Deviation | Self::Turn => 0.05,
            Self::Depth => 0.02,
            Self::Blow => 1e-3,
        }
    }

    const fn text(self) -> [&'static str; 2] {
        match self {
            Self::Way => ["mm until rest", "mm"],
            Self::Turn => ["deg until rest", "deg"],
            Self::Deviation => ["mm off the path", "mm"],
            Self::Depth => ["mm into a guide's end", "mm"],
            Self::Blow => ["J against an end", "J"],
        }
    }
}
/// Ticks in which the watchdog has cut the outputs: 0.49 ms.
const CUT_TICKS: u64 = 10;

impl Outcome {
    /// Ticks from the effect to the fault; a fault that came first has none.
    #[must_use]
    pub fn latency_ticks(&self) -> Option<u64> {
        let tick = self.detected()?;
        // What is told by what it does over and over passes no threshold at one instant.
        let is_gathered = self.fault.is_none() && self.scenario.injection.expected().is_gathered();
        let since = if is_gathered {
            Some(self.scenario.at)
        } else {
            self.effect
        };
        Some(since.map_or(0, |since| tick.saturating_sub(since)))
    }

    /// The tick in which it was found: that of the fault, or of the event where it is none.
    #[must_use]
    pub fn detected(&self) -> Option<u64> {
        let fault = self.fault.map(|fault| fault.tick);
        fault.or(self.told.filter(|_| !self.is_control))
    }

    /// What is wrong with it, if anything.
    #[must_use]
    pub fn problem(&self) -> Option<Problem> {
        (self.wrong_report())
            .or_else(|| self.cut_late())
            .or_else(|| self.beyond_bound())
    }

    fn cut_late(&self) -> Option<Problem> {
        let injection = self.scenario.injection;
        if self.is_control || !matches!(injection, Injection::LoopStands | Injection::Crash) {
            return None;
        }
        let latest = self.scenario.at + CUT_TICKS;
        let cut = self.cut.unwrap_or(u64::MAX);
        (cut > latest).then(|| Problem::CutLate(cut - latest))
    }

    /// What came of the reaction, held to the most that it may be.
    fn beyond_bound(&self) -> Option<Problem> {
        let bound = self.bound.as_ref()?;
        let broken = Measure::ALL.into_iter().find_map(|measure| {
            let most = measure.of(bound) * MARGIN + measure.least();
            let was = measure.of(&self.reaction);
            (was > most).then_some(Problem::Beyond(measure, was, most))
        });
        let is_moving = self.end == End::Moving && bound.rests;
        broken.or_else(|| is_moving.then_some(Problem::StillMoving))
    }

    fn wrong_report(&self) -> Option<Problem> {
        let expected = self.scenario.injection.expected();
        // An event is no fault, where one is due.
        let in_time = if expected.is_gathered() {
            self.fault.map(|fault| fault.tick)
        } else {
            self.detected()
        };
        let late = || {
            let (tick, deadline) = (in_time?, self.deadline?);
            (tick > deadline).then(|| Problem::Late(tick - deadline))
        };
        let Some(fault) = self.fault else {
            return match (self.deadline, in_time, self.told) {
                (_, _, Some(_)) if self.is_control => Some(Problem::FalseAlarm),
                (Some(_), None, _) => Some(Problem::Undetected),
                _ => late(),
            };
        };
        let early = fault.tick < self.scenario.at;
        let mut kinds = expected.causes.iter().filter_map(|cause| cause.kind);
        let is_one = kinds.clone().any(|kind| kind == fault.kind);
        if self.is_control && fault.kind == FaultKind::Oscillation && self.is_founded {
            return Some(Problem::Unstable);
        }
        if self.is_control || early || kinds.next().is_none() {
            return Some(Problem::FalseAlarm);
        }
        if !is_one {
            return Some(Problem::WrongKind);
        }
        if !self.is_founded {
            return Some(Problem::Unfounded);
        }
        if expected.names_pivot && fault.pivot != Some(self.scenario.axis as u8) {
            return Some(Problem::WrongPivot);
        }
        late().or_else(|| self.wrong_second())
    }

    /// A second encoder that is lost while the stage is being stopped has to end the stop in the tick in which it is found.
    fn wrong_second(&self) -> Option<Problem> {
        let (tick, pivot) = self.second?;
        let is_right = self.worse.is_some_and(|worse| {
            let told = (worse.kind, worse.pivot, worse.tick);
            told == (FaultKind::EncoderSilent, Some(pivot as u8), tick)
        });
        (!is_right).then_some(Problem::SecondMissed)
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::FalseAlarm => f.write_str("false alarm"),
            Self::Unstable => f.write_str("the servo oscillates without a fault"),
            Self::Undetected => f.write_str("not detected"),
            Self::Late(ticks) => write!(f, "detected {ticks} ticks late"),
            Self::WrongKind => f.write_str("reported as another fault"),
            Self::Unfounded => f.write_str("reported before anything had passed its threshold"),
            Self::SecondMissed => f.write_str("the second lost encoder is not told"),
            Self::WrongPivot => f.write_str("reported for another pivot"),
            Self::CutLate(ticks) => write!(f, "outputs cut {ticks} ticks late"),
            Self::Beyond(measure, was, most) => {
                let [what, unit] = measure.text();
                write!(f, "{was:.3} {what}, more than {most:.3} {unit}")
            }
            Self::StillMoving => f.write_str("still moving where it could rest"),
        }
    }
}

impl fmt::Display for Outcome {
    /// A line for a run that somebody has to look at.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let scenario = &self.scenario;
        write!(f, "seed {}: ", scenario.seed)?;
        if self.is_control {
            f.write_str("without fault")?;
        } else {
            let pivot = scenario.axis + 1;
            write!(
                f,
                "{:?}, pivot {pivot}, tick {}",
                scenario.injection, scenario.at
            )?;
        }
        if let Some(effect) = self.effect {
            write!(f, ", effect at tick {effect}")?;
        }
        match &self.fault {
            Some(fault) => write!(f, "; {fault}")?,
            None => f.write_str("; no fault latched")?,
        }
        if let Some(worse) = &self.worse {
            write!(f, ", then {worse}")?;
        }
        if let Some(tick) = self.told {
            write!(f, ", event at tick {tick}")?;
        }
        match self.problem() {
            Some(problem) => write!(f, ": {problem}"),
            None => f.write_str(": as it should be"),
        }
    }
}

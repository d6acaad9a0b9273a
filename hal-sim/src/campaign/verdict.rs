//! Whether the controller did what it has to in a run.

use core::fmt;

use firmware::fault::FaultKind;

use super::outcome::Outcome;

/// What is wrong with a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Problem {
    /// A fault where there was nothing wrong.
    FalseAlarm,
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
    /// A guide was pressed into its end, mm, which the documented reaction in time would have prevented.
    LimitBroken(f64),
}

impl Outcome {
    /// Ticks from the effect to the fault; a fault that came first has none.
    #[must_use]
    pub fn latency_ticks(&self) -> Option<u64> {
        let tick = self.detected()?;
        Some((self.effect).map_or(0, |effect| tick.saturating_sub(effect)))
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
        self.wrong_report().or_else(|| {
            let broken = self.overrun_mm > 0.0 && self.unavoidable_mm == 0.0;
            broken.then_some(Problem::LimitBroken(self.overrun_mm))
        })
    }

    fn wrong_report(&self) -> Option<Problem> {
        let expected = self.scenario.injection.expected();
        let late = || {
            let (tick, deadline) = (self.detected()?, self.deadline?);
            (tick > deadline).then(|| Problem::Late(tick - deadline))
        };
        let Some(fault) = self.fault else {
            return match (self.deadline, self.detected(), self.told) {
                (_, None, Some(_)) => Some(Problem::FalseAlarm),
                (Some(_), None, _) => Some(Problem::Undetected),
                _ => late(),
            };
        };
        let early = fault.tick < self.scenario.at;
        let mut kinds = expected.causes.iter().filter_map(|cause| cause.kind);
        let is_one = kinds.clone().any(|kind| kind == fault.kind);
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
            Self::Undetected => f.write_str("not detected"),
            Self::Late(ticks) => write!(f, "detected {ticks} ticks late"),
            Self::WrongKind => f.write_str("reported as another fault"),
            Self::Unfounded => f.write_str("reported before anything had passed its threshold"),
            Self::SecondMissed => f.write_str("the second lost encoder is not told"),
            Self::WrongPivot => f.write_str("reported for another pivot"),
            Self::LimitBroken(mm) => write!(f, "{mm:.3} mm into a guide's end, avoidably"),
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

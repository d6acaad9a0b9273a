//! Whether the controller did what it has to in a run.

use core::fmt;

use super::run::Outcome;

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
    /// The name of another pivot.
    WrongPivot,
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
            let latency = self.latency_ticks().unwrap_or(0);
            (latency > expected.within_ticks).then_some(Problem::Late(latency))
        };
        let Some(fault) = self.fault else {
            return match (self.effect, self.detected(), self.told) {
                (_, None, Some(_)) => Some(Problem::FalseAlarm),
                (Some(_), None, _) => Some(Problem::Undetected),
                _ => late(),
            };
        };
        let early = fault.tick < self.scenario.at;
        if self.is_control || early || expected.kinds.is_empty() {
            return Some(Problem::FalseAlarm);
        }
        if !expected.kinds.contains(&fault.kind) {
            return Some(Problem::WrongKind);
        }
        if expected.names_pivot && fault.pivot != Some(self.scenario.axis as u8) {
            return Some(Problem::WrongPivot);
        }
        late()
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::FalseAlarm => f.write_str("false alarm"),
            Self::Undetected => f.write_str("not detected"),
            Self::Late(ticks) => write!(f, "detected {ticks} ticks late"),
            Self::WrongKind => f.write_str("reported as another fault"),
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
        if let Some(tick) = self.told {
            write!(f, ", event at tick {tick}")?;
        }
        match self.problem() {
            Some(problem) => write!(f, ": {problem}"),
            None => f.write_str(": as it should be"),
        }
    }
}

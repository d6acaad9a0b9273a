//! What is held at every tick, and by how much it was broken.

use std::collections::BTreeMap;
use std::fmt;

/// What is held at every tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rule {
    Speed,
    TurnSpeed,
    AxisSpeed,
    Acceleration,
    TurnAcceleration,
    Jerk,
    TurnJerk,
    PivotRate,
    PivotAcceleration,
    /// How far out of the usable disk the platform's centre is.
    Disk,
    /// Position that no velocity, acceleration or jerk explains.
    PositionStep,
    /// Velocity that no acceleration or jerk explains.
    VelocityStep,
    /// The motion comes to rest.
    Rest,
}

/// A rule that was broken, where it was broken most.
#[derive(Clone, Debug)]
pub struct Breach {
    pub value: f64,
    pub granted: f64,
    pub unit: &'static str,
    /// Tick of the script.
    pub tick: u64,
    /// The first tick at which the rule was broken.
    pub first: u64,
    /// What the plan under way is for.
    pub during: &'static str,
}

impl Breach {
    /// Value over what was granted.
    pub fn ratio(&self) -> f64 {
        self.value / self.granted
    }
}

impl fmt::Display for Breach {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            value,
            granted,
            unit,
            tick,
            first,
            during,
        } = self;
        let ratio = self.ratio();
        write!(
            f,
            "{value:.6} {unit}, granted {granted:.6} ({ratio:.5} times) at tick {tick}, first at {first}, {during}"
        )
    }
}

/// The rules that were broken.
pub type Breaches = BTreeMap<Rule, Breach>;

/// Adds a breach to those of a script.
pub fn record(breaches: &mut Breaches, rule: Rule, breach: Breach) {
    match breaches.get_mut(&rule) {
        Some(worst) if worst.ratio() >= breach.ratio() => {}
        Some(worst) => {
            *worst = Breach {
                first: worst.first,
                ..breach
            };
        }
        None => {
            breaches.insert(rule, breach);
        }
    }
}

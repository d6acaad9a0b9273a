//! What the ticks of an exercise cost, by what they did.

use firmware::mode::Mode;

/// Instructions of some of the ticks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cost {
    /// How many there were.
    pub ticks: u64,
    /// Instructions of all of them.
    pub total: u64,
    /// Instructions of the worst.
    pub worst: u64,
}

impl Cost {
    /// Instructions of a tick on average.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.total as f64 / self.ticks.max(1) as f64
    }

    fn add(&mut self, instructions: u64) {
        self.ticks += 1;
        self.total += instructions;
        self.worst = self.worst.max(instructions);
    }
}

/// A tick's doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Doing {
    /// The supervisor's state after it.
    pub mode: Mode,
    /// Whether it took a command.
    pub commanded: bool,
}

impl Doing {
    const ALL: [Self; 12] = [
        Self::new(Mode::Off, false),
        Self::new(Mode::Off, true),
        Self::new(Mode::Holding, false),
        Self::new(Mode::Holding, true),
        Self::new(Mode::Moving, false),
        Self::new(Mode::Moving, true),
        Self::new(Mode::Stopping, false),
        Self::new(Mode::Stopping, true),
        Self::new(Mode::Fault, false),
        Self::new(Mode::Fault, true),
        Self::new(Mode::Exciting, false),
        Self::new(Mode::Exciting, true),
    ];

    const fn new(mode: Mode, commanded: bool) -> Self {
        Self { mode, commanded }
    }

    /// In words.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match (self.mode, self.commanded) {
            (Mode::Off, false) => "servo off",
            (Mode::Off, true) => "taking a command, off after it",
            (Mode::Holding, false) => "at rest under the servo",
            (Mode::Holding, true) => "taking a command, at rest",
            (Mode::Moving, false) => "in motion",
            (Mode::Moving, true) => "taking a command, in motion",
            (Mode::Stopping, false) => "stopping because of a fault",
            (Mode::Stopping, true) => "taking a command, stopping because of a fault",
            (Mode::Fault, false) => "with a fault latched",
            (Mode::Exciting, false) => "excited",
            (Mode::Exciting, true) => "taking a command, excited",
            (Mode::Fault, true) => "taking a command, with a fault",
        }
    }
}

/// The worst tick.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Worst {
    /// Its number, from 0.
    pub tick: u64,
    /// Instructions.
    pub instructions: u64,
    /// What it did.
    pub doing: Doing,
    /// The line that was being carried out when it was counted.
    pub line: String,
}

/// All of them.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    costs: [Cost; Doing::ALL.len()],
    /// The worst, once there is one.
    pub worst: Option<Worst>,
}

impl Tally {
    /// Counts a tick; `line` says what line is being carried out.
    pub fn add(&mut self, tick: u64, instructions: u64, doing: Doing, line: impl Fn() -> String) {
        for (cost, of) in self.costs.iter_mut().zip(Doing::ALL) {
            if of == doing {
                cost.add(instructions);
            }
        }
        let worst = self.worst.as_ref().map_or(0, |worst| worst.instructions);
        if instructions > worst {
            self.worst = Some(Worst {
                tick,
                instructions,
                doing,
                line: line(),
            });
        }
    }

    /// What ticks of each doing cost, those that there were.
    pub fn by_doing(&self) -> impl Iterator<Item = (Doing, Cost)> {
        (Doing::ALL.into_iter().zip(self.costs)).filter(|(_, cost)| cost.ticks > 0)
    }

    /// What all of them cost.
    #[must_use]
    pub fn all(&self) -> Cost {
        self.costs.iter().fold(Cost::default(), |sum, cost| Cost {
            ticks: sum.ticks + cost.ticks,
            total: sum.total + cost.total,
            worst: sum.worst.max(cost.worst),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_doing_is_counted_by_itself_and_the_first_worst_is_kept() {
        let mut tally = Tally::default();
        for (tick, doing) in (0u64..).zip(Doing::ALL.into_iter().chain(Doing::ALL)) {
            tally.add(tick, 100 + tick % 8, doing, || tick.to_string());
        }
        let counted: Vec<_> = tally.by_doing().map(|(_, cost)| cost.ticks).collect();
        assert_eq!(counted, [2; 12]);
        assert_eq!((tally.all().ticks, tally.all().worst), (24, 107));
        let worst = tally.worst.expect("there were ticks");
        assert_eq!((worst.tick, worst.line.as_str()), (7, "7"));
    }
}

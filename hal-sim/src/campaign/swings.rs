//! Whether a voltage goes to and fro.

use std::collections::VecDeque;

/// Ticks for which a reversal is remembered.
const SWINGING_TICKS: u64 = 2_000;

/// Reversals of a voltage.
#[derive(Clone, Debug)]
pub(super) struct Swings {
    now: u64,
    extreme: f64,
    rising: bool,
    /// The ticks of the last ones.
    pub reversals: VecDeque<u64>,
}

impl Swings {
    pub const NONE: Self = Self {
        now: 0,
        extreme: 0.0,
        rising: false,
        reversals: VecDeque::new(),
    };

    /// Takes a tick's voltage, where it `counts`.
    pub fn look(&mut self, volts: f64, swing_v: f64, counts: bool) {
        self.now += 1;
        if !counts {
            self.extreme = volts;
            return;
        }
        let beyond = if self.rising {
            volts - self.extreme
        } else {
            self.extreme - volts
        };
        if beyond > 0.0 {
            self.extreme = volts;
        } else if beyond < -swing_v {
            self.rising = !self.rising;
            self.extreme = volts;
            self.reversals.push_back(self.now);
        }
        let now = self.now;
        self.reversals.retain(|at| at + SWINGING_TICKS >= now);
    }
}

/// A voltage without what is faster than any loop here oscillates: the mean of three ticks. With a dead time of 72 us and an integrator
/// nothing from 3.5 kHz on comes back in phase; what is faster is driven, as by errors within the periods of a scale that are made up for at
/// wrong places.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Slowed {
    before: [f64; 2],
}

impl Slowed {
    /// Takes a tick's voltage.
    pub fn take(&mut self, volts: f64) -> f64 {
        let [first, second] = self.before;
        self.before = [second, volts];
        (first + second + volts) / 3.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reversals of a voltage of 20 V either way that repeats after so many ticks.
    fn reversals(period: u64) -> usize {
        let (mut slowed, mut swings) = (Slowed::default(), Swings::NONE);
        for tick in 0..240 {
            let is_high = 2 * (tick % period) < period;
            let volts = slowed.take(if is_high { 20.0 } else { -20.0 });
            swings.look(volts, 26.0, true);
        }
        swings.reversals.len()
    }

    #[test]
    fn what_is_faster_than_any_loop_is_no_oscillation() {
        assert_eq!([3, 4].map(reversals), [0, 0]);
        assert!(reversals(10) > 40);
    }
}

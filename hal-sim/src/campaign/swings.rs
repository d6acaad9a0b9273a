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

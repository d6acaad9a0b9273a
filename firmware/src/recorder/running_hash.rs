//! A running hash over every tick.

use super::sample::{Sample, TickObserver};

/// A running hash over state, setpoints, measured pivots and duties of every tick: two runs that agree in it agreed at
/// every tick. The words of a tick are turned and added without carry, which no single difference survives unseen, and
/// what comes of it is multiplied as in FNV-1a: once a tick, since every tick is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RunningHash(pub u32);

impl Default for RunningHash {
    fn default() -> Self {
        Self(0x811C_9DC5)
    }
}

impl RunningHash {
    #[inline]
    fn word(&mut self, word: u32) {
        self.0 = self.0.rotate_left(5) ^ word;
    }
}

impl TickObserver for RunningHash {
    #[inline]
    fn observe(&mut self, sample: &Sample) {
        self.word(sample.tick as u32);
        self.word(sample.mode as u32);
        for position in sample.setpoint.position {
            self.word(position as u32);
            self.word((position >> 32) as u32);
        }
        for i in 0..3 {
            self.word(sample.pivot_setpoints[i].units() as u32);
            self.word(sample.pivot_rates[i].to_bits());
            self.word(sample.pivots[i].units() as u32);
            self.word(sample.duty[i].0 as u32);
        }
        self.0 = self.0.wrapping_mul(0x0100_0193);
    }
}

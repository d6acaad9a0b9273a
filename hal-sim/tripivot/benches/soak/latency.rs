//! How long answers take, in a memory that does not grow.

use std::time::Duration;

/// Eighths of an octave of microseconds.
const BUCKETS: usize = 256;

/// How often an answer took how long.
pub struct Latency([u64; BUCKETS]);

impl Default for Latency {
    fn default() -> Self {
        Self([0; BUCKETS])
    }
}

impl Latency {
    pub fn note(&mut self, time: Duration) {
        let us = (time.as_micros() as f64).max(1.0);
        let bucket = (8.0 * us.log2()).ceil() as usize;
        self.0[bucket.min(BUCKETS - 1)] += 1;
    }

    pub fn add(&mut self, other: &Self) {
        for (count, more) in self.0.iter_mut().zip(other.0) {
            *count += more;
        }
    }

    pub fn count(&self) -> u64 {
        self.0.iter().sum()
    }

    /// What this share of all answers did not take longer than, ms, to 9 %.
    pub fn quantile_ms(&self, share: f64) -> f64 {
        let enough = (share * self.count() as f64).ceil() as u64;
        let mut sum = 0;
        let bucket = self.0.iter().position(|count| {
            sum += count;
            sum >= enough
        });
        (bucket.unwrap_or(0) as f64 / 8.0).exp2() / 1e3
    }
}

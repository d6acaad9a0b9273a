//! Ticks from the wall clock.

use std::time::{Duration, Instant};

/// How often the clock is looked at when nothing else happens.
const PERIOD: Duration = Duration::from_millis(1);
/// Ticks between two looks at the connections, at most.
const BATCH: u64 = 40;
/// What may be made up for later: a delay up to this is the machine's, not the simulation's.
const PATIENCE: Duration = Duration::from_millis(200);

/// How well the ticks kept to the wall clock.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pacing {
    /// Ticks that were run.
    pub ticks: u64,
    /// How late they were all together, s: each is due at its time, and runs in a batch that begins at or after it.
    pub late_s: f64,
    /// How late the latest was.
    pub latest: Duration,
    /// Time that could not be made up for, which the stage never had.
    pub lost: Duration,
}

/// Which ticks are due.
#[derive(Debug)]
pub(super) struct Pace {
    start: Instant,
    /// Ticks since `start`.
    done: u64,
    /// Ticks in a second of the wall clock.
    rate_hz: f64,
    pacing: Pacing,
}

impl Pace {
    pub fn new(now: Instant, rate_hz: f64) -> Self {
        Self {
            start: now,
            done: 0,
            rate_hz,
            pacing: Pacing::default(),
        }
    }

    /// How it went so far.
    pub const fn pacing(&self) -> Pacing {
        self.pacing
    }

    /// Ticks to run now; they count as done.
    pub fn take(&mut self, now: Instant) -> u64 {
        let count = self.behind(now).min(BATCH);
        if count > 0 {
            self.note(count, self.late(now, self.done + 1));
        }
        self.done += count;
        count
    }

    /// Of a batch, whose first tick is so late and whose others were due one after another since.
    fn note(&mut self, count: u64, latest: Duration) {
        let number = count as f64;
        let since_s = number * (number - 1.0) / 2.0 / self.rate_hz;
        self.pacing.ticks += count;
        self.pacing.late_s += number * latest.as_secs_f64() - since_s;
        self.pacing.latest = self.pacing.latest.max(latest);
    }

    /// How long ago so many ticks were due.
    fn late(&self, now: Instant, ticks: u64) -> Duration {
        let due = Duration::from_secs_f64(ticks as f64 / self.rate_hz);
        now.duration_since(self.start).saturating_sub(due)
    }

    /// How long to wait for the next batch.
    pub fn wait(&self, now: Instant) -> Duration {
        let next_s = (self.done + 1) as f64 / self.rate_hz;
        let next = Duration::from_secs_f64(next_s).saturating_sub(now.duration_since(self.start));
        match self.behind(now) {
            0 => next.max(PERIOD),
            ticks if ticks >= BATCH => Duration::ZERO,
            _ => PERIOD,
        }
    }

    /// Gives up what can not be made up for any more, and says how much that was.
    pub fn give_up(&mut self, now: Instant) -> Option<Duration> {
        let late = self.late(now, self.done);
        if late <= PATIENCE {
            return None;
        }
        self.start += late;
        self.pacing.lost += late;
        Some(late)
    }

    fn behind(&self, now: Instant) -> u64 {
        let due = now.duration_since(self.start).as_secs_f64() * self.rate_hz;
        (due as u64).saturating_sub(self.done)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    #[test]
    fn as_many_ticks_as_the_clock_says() {
        let start = Instant::now();
        let mut pace = Pace::new(start, 20_000.0);
        assert_eq!(pace.take(start), 0);
        assert_eq!(pace.wait(start), PERIOD);
        let mut ticks = 0;
        for at in 1..=1000 {
            ticks += pace.take(start + ms(at));
        }
        assert_eq!(ticks, 20_000);
        // In every millisecond the first of 20 ticks, or 21, waits for the last.
        let pacing = pace.pacing();
        assert_eq!((pacing.ticks, pacing.lost), (20_000, Duration::ZERO));
        let latest_us = 1e6 * pacing.latest.as_secs_f64();
        assert!((949.0..=1001.0).contains(&latest_us), "{latest_us} us");
        let mean_us = 1e6 * pacing.late_s / 20_000.0;
        assert!((474.0..=480.0).contains(&mean_us), "{mean_us} us");
    }

    #[test]
    fn a_short_delay_is_made_up_for_in_batches() {
        let start = Instant::now();
        let mut pace = Pace::new(start, 20_000.0);
        let late = start + ms(150);
        assert_eq!(pace.give_up(late), None);
        let mut ticks = 0;
        while pace.wait(late) == Duration::ZERO {
            let batch = pace.take(late);
            assert!(batch <= BATCH);
            ticks += batch;
        }
        assert_eq!(ticks, 3_000);
    }

    #[test]
    fn a_long_delay_is_given_up() {
        let start = Instant::now();
        let mut pace = Pace::new(start, 20_000.0);
        let late = start + ms(3_000);
        assert_eq!(pace.give_up(late), Some(ms(3_000)));
        assert_eq!(pace.pacing().lost, ms(3_000));
        assert_eq!(pace.take(late), 0);
        assert_eq!(pace.take(late + ms(1)), 20);
    }

    #[test]
    fn slower_than_the_clock() {
        let start = Instant::now();
        let mut pace = Pace::new(start, 2.0);
        assert_eq!(pace.take(start + ms(499)), 0);
        assert_eq!(pace.wait(start + ms(100)), ms(400));
        assert_eq!(pace.take(start + ms(500)), 1);
    }
}

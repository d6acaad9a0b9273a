//! Ticks from the wall clock.

use std::time::{Duration, Instant};

/// How often the clock is looked at when nothing else happens.
const PERIOD: Duration = Duration::from_millis(1);
/// Ticks between two looks at the connections, at most.
const BATCH: u64 = 40;
/// What may be made up for later: a delay up to this is the machine's, not the simulation's.
const PATIENCE: Duration = Duration::from_millis(200);

/// Which ticks are due.
#[derive(Debug)]
pub(super) struct Pace {
    start: Instant,
    /// Ticks since `start`.
    done: u64,
    /// Ticks in a second of the wall clock.
    rate_hz: f64,
}

impl Pace {
    pub fn new(now: Instant, rate_hz: f64) -> Self {
        Self {
            start: now,
            done: 0,
            rate_hz,
        }
    }

    /// Ticks to run now; they count as done.
    pub fn take(&mut self, now: Instant) -> u64 {
        let count = self.behind(now).min(BATCH);
        self.done += count;
        count
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
        let late = now
            .duration_since(self.start)
            .saturating_sub(Duration::from_secs_f64(self.done as f64 / self.rate_hz));
        if late <= PATIENCE {
            return None;
        }
        self.start += late;
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

//! Ramps of the acceleration in whole numbers: the pieces of a pace.
//!
//! The jerks become integers. The last two ramps take up what the rounding leaves of acceleration and speed at the end, up to
//! a few units, and two ticks more take those: the motion ends at rest to the bit.

use super::axis::times;
use super::float::Order;
use super::pace::{BITS, Beat, Pace};
use super::plan::MAX_PIECES;
use super::polygon::STRETCHES;
use super::ramps::{Ramp, Ramps};
use heapless::Vec;

/// The ramps in integers.
pub(super) struct Score {
    /// Start and end of each, and its jerk.
    ramps: Vec<(i64, i64, i32), { STRETCHES + 1 }>,
    start: i64,
    end: i64,
}

impl Score {
    pub fn new(ramps: &Ramps) -> Option<Self> {
        let jerk = |ramp: &Ramp| ramp.change / ramp.ticks as f32;
        let largest = ramps
            .iter()
            .fold(0.0_f32, |most, r| most.larger(jerk(r).abs()));
        let mut score = Self {
            ramps: Vec::new(),
            start: i64::MAX,
            end: i64::MIN,
        };
        let scale = (1u32 << BITS) as f32 / largest;
        for ramp in ramps {
            let half = ramp.ticks / 2;
            let (start, end) = (ramp.middle - half, ramp.middle + half);
            score.start = score.start.min(start);
            score.end = score.end.max(end);
            let whole = libm::rintf(jerk(ramp) * scale) as i32;
            score.ramps.push((start, end, whole)).ok()?;
        }
        score.close()?;
        Some(score)
    }

    /// Acceleration and speed at the end: twice the sum of jerk times length, and of that times the distance from the end.
    fn left(&self) -> (i64, i128) {
        self.ramps
            .iter()
            .fold((0, 0), |(force, speed), (start, end, jerk)| {
                let step = i64::from(*jerk) * (end - start);
                let lever = 2 * self.end - start - end;
                (force + step, speed + long(step, lever))
            })
    }

    /// Lets the last two ramps take up what is left.
    fn close(&mut self) -> Option<()> {
        let n = self.ramps.len();
        let [.., (a_start, a_end, _), (b_start, b_end, _)] = self.ramps[..] else {
            return None;
        };
        let (force, speed) = self.left();
        let lever = |start: i64, end: i64| 2 * self.end - start - end;
        let (a, b) = (lever(a_start, a_end), lever(b_start, b_end));
        let a_step = -(speed - long(force, b)) as f32 / (a - b) as f32;
        let a_jerk = libm::rintf(a_step / (a_end - a_start) as f32) as i32;
        self.ramps[n - 2].2 += a_jerk;
        let force = force + i64::from(a_jerk) * (a_end - a_start);
        self.ramps[n - 1].2 -= libm::rintf(force as f32 / (b_end - b_start) as f32) as i32;
        Some(())
    }

    /// The pieces between all starts and ends.
    pub fn pace(&self) -> Option<Pace> {
        let mut times: Vec<(i64, i32), { 2 * (STRETCHES + 1) }> = Vec::new();
        for &(start, end, jerk) in &self.ramps {
            insert(&mut times, (start, jerk))?;
            insert(&mut times, (end, -jerk))?;
        }
        let mut sum = Sum::default();
        let mut jerk = 0;
        for pair in times.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            jerk += from.1;
            if to.0 > from.0 {
                sum.push(to.0 - from.0, jerk)?;
            }
        }
        sum.close()?;
        (sum.sixfold > 0).then_some(Pace {
            beats: sum.beats,
            sixfold: sum.sixfold,
            bits: BITS,
        })
    }
}

/// Beats, and the state they lead to.
#[derive(Default)]
struct Sum {
    beats: Vec<Beat, MAX_PIECES>,
    /// Acceleration.
    force: i64,
    /// Twice the speed.
    speed: i128,
    /// Six times the way.
    sixfold: i128,
}

impl Sum {
    fn push(&mut self, ticks: i64, jerk: i32) -> Option<()> {
        let bent = i64::from(jerk) * ticks;
        let way = 3 * self.speed + long(3 * self.force + bent, ticks);
        self.sixfold += times(way, u32::try_from(ticks).ok()?);
        self.speed += long(2 * self.force + bent, ticks);
        self.force += bent;
        let ticks = ticks as u64;
        self.beats.push(Beat { ticks, jerk }).ok()
    }

    /// Ends at rest exactly: the few units that are left go in two more ticks. Twice the speed is odd when the acceleration is.
    fn close(&mut self) -> Option<()> {
        if self.force == 0 && self.speed == 0 {
            return Some(());
        }
        let first = i32::try_from(-(self.speed + i128::from(3 * self.force)) / 2).ok()?;
        let second = i32::try_from(-self.force - i64::from(first)).ok()?;
        self.push(1, first)?;
        self.push(1, second)
    }
}

/// The whole product.
#[inline]
fn long(a: i64, b: i64) -> i128 {
    i128::from(a) * i128::from(b)
}

/// Inserts in order of time; nearly always at the end.
fn insert<const N: usize>(times: &mut Vec<(i64, i32), N>, event: (i64, i32)) -> Option<()> {
    times.push(event).ok()?;
    let mut k = times.len() - 1;
    while k > 0 && times[k - 1].0 > event.0 {
        times[k] = times[k - 1];
        k -= 1;
    }
    times[k] = event;
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Up, along, and down, with ramps that overlap or not.
    fn ramps(length: i64, ticks: i64) -> Ramps {
        [
            (0, 1.0),
            (length, -1.0),
            (5 * length, -0.7),
            (6 * length, 0.7),
        ]
        .into_iter()
        .map(|(middle, change)| Ramp {
            middle,
            ticks,
            change: change * 1e-6,
        })
        .collect()
    }

    /// Every tick of it, in the integers of the beats.
    fn played(pace: &Pace) -> (i128, i128, i128) {
        let (mut force, mut twice_speed, mut sixfold) = (0_i128, 0_i128, 0_i128);
        for beat in &pace.beats {
            for _ in 0..beat.ticks {
                let jerk = i128::from(beat.jerk);
                sixfold += 3 * (twice_speed + force) + jerk;
                twice_speed += 2 * force + jerk;
                force += jerk;
            }
        }
        (force, twice_speed, sixfold)
    }

    #[test]
    fn it_ends_at_rest_to_the_bit_and_knows_its_way() {
        for (length, ticks) in [
            (2, 2),
            (40, 10),
            (1_000, 200),
            (1_000, 1_400),
            (300_000, 2_000),
        ] {
            let pace = Score::new(&ramps(length, ticks)).unwrap().pace().unwrap();
            let (force, speed, sixfold) = played(&pace);
            assert_eq!((force, speed), (0, 0), "{length} {ticks}");
            assert_eq!(sixfold, pace.sixfold, "{length} {ticks}");
            // Two ticks close it.
            assert!(pace.ticks() <= (6 * length + ticks) as u64 + 2);
        }
    }

    /// Ramps of any lengths: what the integers leave goes in two ticks.
    #[test]
    fn whatever_the_lengths_it_ends_at_rest() {
        for k in 1..200_i64 {
            let mut odd = ramps(1_000 + 7 * k, 2 * k);
            odd[1].middle += k;
            odd[2].ticks += 2 * (k % 5);
            odd[3].middle += 3 * k;
            let (force, speed, _) = played(&Score::new(&odd).unwrap().pace().unwrap());
            assert_eq!((force, speed), (0, 0), "{k}");
        }
    }

    #[test]
    fn what_ramps_leave_of_speed_is_taken_up_by_the_last_two() {
        let mut off = ramps(1_000, 200);
        off[3].change *= 1.01;
        let pace = Score::new(&off).unwrap().pace().unwrap();
        let (force, speed, _) = played(&pace);
        assert_eq!((force, speed), (0, 0));
    }

    #[test]
    fn backwards_is_no_pace() {
        let mut backwards = ramps(1_000, 200);
        for ramp in &mut backwards {
            ramp.change = -ramp.change;
        }
        assert!(Score::new(&backwards).unwrap().pace().is_none());
    }
}

//! Ramps of the acceleration in whole numbers: the pieces of a path profile.
//!
//! The jerks become integers. The last two ramps take up what the rounding leaves of acceleration and speed at the end,
//! up to a few units, and two ticks more take those: the motion ends at rest to the bit.

use super::topp::MAX_SEGMENTS;
use heapless::Vec;
use motion::plan::MAX_PIECES;
use motion::plan::quantise::{JERK_BITS, JerkSegment, PathProfile};
use number::float::{FloatMinMax, i64_to_f32_fast, i128_to_f32_fast, round_i32};
use number::wide_integer::{mul_i64_u32, mul_i128_u32};

/// A ramp of the acceleration.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct JerkRamp {
    /// Where its middle is, ticks.
    pub middle: i32,
    /// How long it is, ticks: even.
    pub ticks: i32,
    /// How much the acceleration changes, s per tick squared.
    pub change: f32,
    /// The jerk that makes it, in whole numbers: found last of all.
    pub jerk: i32,
}

/// Ramps that make a motion.
pub(super) type JerkRamps = Vec<JerkRamp, { MAX_SEGMENTS + 1 }>;

impl JerkRamp {
    fn start(&self) -> i32 {
        self.middle - self.ticks / 2
    }

    fn end(&self) -> i32 {
        self.middle + self.ticks / 2
    }

    /// Twice the distance of its middle from the end of all.
    fn moment(&self, end: i32) -> i32 {
        2 * (end - self.middle)
    }
}

/// Gives the ramps their jerks and writes the pieces between all starts and ends.
pub(super) fn write_ramps(ramps: &mut JerkRamps, profile: &mut PathProfile) -> Option<()> {
    let jerk = |ramp: &JerkRamp| ramp.change / ramp.ticks as f32;
    let largest = (ramps.iter()).fold(0.0_f32, |most, ramp| most.fmax(jerk(ramp).abs()));
    let scale = (1_u32 << JERK_BITS) as f32 / largest;
    for ramp in ramps.iter_mut() {
        ramp.jerk = round_i32(jerk(ramp) * scale);
    }
    close(ramps)?;
    let mut times: Vec<(i32, i32), { 2 * (MAX_SEGMENTS + 1) }> = Vec::new();
    for ramp in ramps {
        insert(&mut times, (ramp.start(), ramp.jerk))?;
        insert(&mut times, (ramp.end(), -ramp.jerk))?;
    }
    profile.segments.clear();
    profile.bits = JERK_BITS;
    let mut sum = Sum::default();
    let mut jerk = 0_i32;
    for pair in times.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        jerk = jerk.wrapping_add(from.1);
        if to.0 > from.0 {
            sum.push(&mut profile.segments, (to.0 - from.0) as u32, jerk)?;
        }
    }
    sum.close(&mut profile.segments)?;
    profile.six_times_distance = sum.six_times_distance;
    (sum.six_times_distance > 0).then_some(())
}

/// Lets the last two ramps take up what all leave of acceleration and speed at the end: twice the sum of jerk times length,
/// and of that times the distance from the end.
fn close(ramps: &mut JerkRamps) -> Option<()> {
    let end = ramps.iter().map(JerkRamp::end).max()?;
    let (mut acceleration, mut speed) = (0, 0);
    for ramp in &*ramps {
        let step = i64::from(ramp.jerk) * i64::from(ramp.ticks);
        acceleration += step;
        speed += mul_i64_u32(step, ramp.moment(end) as u32);
    }
    let [.., a, b] = &mut ramps[..] else {
        return None;
    };
    let (far, near) = (a.moment(end), b.moment(end));
    let a_step =
        -i128_to_f32_fast(speed - mul_i64_u32(acceleration, near as u32)) / (far - near) as f32;
    let a_jerk = round_i32(a_step / a.ticks as f32);
    a.jerk = a.jerk.wrapping_add(a_jerk);
    let acceleration = acceleration + i64::from(a_jerk) * i64::from(a.ticks);
    b.jerk = (b.jerk).wrapping_sub(round_i32(i64_to_f32_fast(acceleration) / b.ticks as f32));
    Some(())
}

/// The state that segments lead to.
#[derive(Default)]
struct Sum {
    /// Acceleration.
    acceleration: i64,
    /// Twice the speed.
    speed: i128,
    /// Six times the way.
    six_times_distance: i128,
}

impl Sum {
    #[inline(never)]
    fn push(
        &mut self,
        segments: &mut Vec<JerkSegment, MAX_PIECES>,
        ticks: u32,
        jerk: i32,
    ) -> Option<()> {
        let bent = i64::from(jerk) * i64::from(ticks);
        let way = 3 * self.speed + mul_i64_u32(3 * self.acceleration + bent, ticks);
        self.six_times_distance += mul_i128_u32(way, ticks);
        self.speed += mul_i64_u32(2 * self.acceleration + bent, ticks);
        self.acceleration += bent;
        let ticks = u64::from(ticks);
        segments.push(JerkSegment { ticks, jerk }).ok()
    }

    /// Ends at rest exactly: the few units that are left go in two more ticks. Twice the speed is odd when the
    /// acceleration is.
    fn close(&mut self, segments: &mut Vec<JerkSegment, MAX_PIECES>) -> Option<()> {
        if self.acceleration == 0 && self.speed == 0 {
            return Some(());
        }
        let first = i32::try_from(-(self.speed + i128::from(3 * self.acceleration)) / 2).ok()?;
        let second = i32::try_from(-self.acceleration - i64::from(first)).ok()?;
        self.push(segments, 1, first)?;
        self.push(segments, 1, second)
    }
}

/// Inserts in order of time; nearly always at the end.
fn insert<const N: usize>(times: &mut Vec<(i32, i32), N>, event: (i32, i32)) -> Option<()> {
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
    use crate::line::rounded_ramps::*;

    /// Up, along, and down, with ramps that overlap or not.
    fn ramps(length: i32, ticks: i32) -> JerkRamps {
        [
            (0, 1.0),
            (length, -1.0),
            (5 * length, -0.7),
            (6 * length, 0.7),
        ]
        .into_iter()
        .map(|(middle, change)| JerkRamp {
            middle,
            ticks,
            change: change * 1e-6,
            jerk: 0,
        })
        .collect()
    }

    fn profiled(ramps: &JerkRamps) -> Option<PathProfile> {
        let mut profile = PathProfile::default();
        write_ramps(&mut ramps.clone(), &mut profile).map(|()| profile)
    }

    /// Every tick of it, in the integers of the segments.
    fn stepped(profile: &PathProfile) -> (i128, i128, i128) {
        let (mut acceleration, mut twice_speed, mut six_times_distance) = (0_i128, 0_i128, 0_i128);
        for segment in &profile.segments {
            for _ in 0..segment.ticks {
                let jerk = i128::from(segment.jerk);
                six_times_distance += 3 * (twice_speed + acceleration) + jerk;
                twice_speed += 2 * acceleration + jerk;
                acceleration += jerk;
            }
        }
        (acceleration, twice_speed, six_times_distance)
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
            let profile = profiled(&ramps(length, ticks)).unwrap();
            let (acceleration, speed, six_times_distance) = stepped(&profile);
            assert_eq!((acceleration, speed), (0, 0), "{length} {ticks}");
            assert_eq!(
                six_times_distance, profile.six_times_distance,
                "{length} {ticks}"
            );
            // Two ticks close it.
            assert!(profile.ticks() <= (6 * length + ticks) as u64 + 2);
        }
    }

    /// Ramps of any lengths: what the integers leave goes in two ticks.
    #[test]
    fn whatever_the_lengths_it_ends_at_rest() {
        for k in 1..200_i32 {
            let mut odd = ramps(1_000 + 7 * k, 2 * k);
            odd[1].middle += k;
            odd[2].ticks += 2 * (k % 5);
            odd[3].middle += 3 * k;
            let (acceleration, speed, _) = stepped(&profiled(&odd).unwrap());
            assert_eq!((acceleration, speed), (0, 0), "{k}");
        }
    }

    #[test]
    fn what_ramps_leave_of_speed_is_taken_up_by_the_last_two() {
        let mut off = ramps(1_000, 200);
        off[3].change *= 1.01;
        let profile = profiled(&off).unwrap();
        let (acceleration, speed, _) = stepped(&profile);
        assert_eq!((acceleration, speed), (0, 0));
    }

    #[test]
    fn backwards_is_no_profile() {
        let mut backwards = ramps(1_000, 200);
        for ramp in &mut backwards {
            ramp.change = -ramp.change;
        }
        assert!(profiled(&backwards).is_none());
    }
}

//! From segments of constant acceleration to a path profile of limited jerk.
//!
//! Where the acceleration steps, at a corner of the [`Corners`], it gets a ramp instead, as long as the limit of jerk
//! asks for and centred on the corner:
//!
//! ```text
//! acceleration   ____                      _____
//!                    |         becomes          \             The speed before and after the ramp is the same, and so
//!                    |____                       \____        the motion ends at rest; it lasts half a ramp longer at
//!                                                             its start and at its end, and the corners are rounded.
//! ```
//!
//! Ramps may overlap: they add up. Of two of the same sign that do, each is made as long as their sum asks for.
//!
//! All times are whole ticks, lengths of segments rounded up, those of ramps to even numbers: nothing gets faster by
//! it.

use super::rounded_ramps::{JerkRamp, JerkRamps, write_ramps};
use super::topp::Corners;
use motion::plan::quantise::PathProfile;
use motion::tolerances::WHOLE_DURATION;
use number::float::{FloatMinMax, ceil_i32};

/// Longest duration in ticks, 105 s at 20 kHz: the roundings of the axes' jerks do not yet show in the line.
const LONGEST: i32 = 1 << 21;

/// Writes the path profile along `corners`, with everything `slower` than it is there (1 or more) and so much jerk. `None`
/// where it would last too long.
#[inline(never)]
pub(super) fn write_path_profile(
    corners: &Corners,
    slower: f32,
    jerk: f32,
    hz: f32,
    profile: &mut PathProfile,
) -> Option<()> {
    let mut ramps = corner_ramps(corners, slower, hz)?;
    widen(&mut ramps, jerk / (hz * hz * hz));
    write_ramps(&mut ramps, profile)
}

/// The corners, with ramps of no length yet.
fn corner_ramps(corners: &Corners, slower: f32, hz: f32) -> Option<JerkRamps> {
    let ramp = |middle, change| JerkRamp {
        middle,
        change,
        ..JerkRamp::default()
    };
    let mut ramps = JerkRamps::new();
    let (mut middle, mut before) = (0, 0.0);
    for pair in corners.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        let ticks = 2.0 * (b.s - a.s) / (a.rate + b.rate) * (hz * slower * WHOLE_DURATION);
        // Nor is a NaN in it.
        if !(0.0..LONGEST as f32).contains(&ticks) {
            return None;
        }
        let ticks = ceil_i32(ticks).max(1);
        let acceleration = (b.rate - a.rate) / (hz * slower * ticks as f32);
        ramps.push(ramp(middle, acceleration - before)).ok()?;
        middle += ticks;
        before = acceleration;
    }
    ramps.push(ramp(middle, -before)).ok()?;
    (middle < LONGEST).then_some(ramps)
}

/// Gives the ramps their lengths.
fn widen(ramps: &mut JerkRamps, most: f32) {
    let half = WHOLE_DURATION / (2.0 * most);
    // Longer than anything when nearly nothing is allowed, and still within 31 bits.
    let even = |change: f32| 2 * ceil_i32((change * half).fmin(LONGEST as f32)).max(1);
    for ramp in ramps.iter_mut() {
        ramp.ticks = even(ramp.change.abs());
    }
    for k in 1..ramps.len() {
        let (a, b) = (ramps[k - 1], ramps[k]);
        let meet = b.middle - a.middle < (a.ticks + b.ticks) / 2;
        if meet && a.change * b.change > 0.0 {
            let ticks = even((a.change + b.change).abs());
            ramps[k - 1].ticks = a.ticks.max(ticks);
            ramps[k].ticks = b.ticks.max(ticks);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::line::jerk_ramps::*;
    use crate::line::topp::Corner;
    use motion::constraints::PathLimits;

    const HZ: f32 = 20_000.0;
    const LIMITS: PathLimits = PathLimits {
        rate: 2.0,
        acceleration: 40.0,
        jerk: 4_000.0,
    };

    fn corners(corners: &[(f32, f32)]) -> Corners {
        (corners.iter())
            .map(|&(s, rate)| Corner { s, rate })
            .collect()
    }

    fn profiled(corners: &Corners, slower: f32) -> Option<PathProfile> {
        let mut profiled = PathProfile::default();
        write_path_profile(corners, slower, LIMITS.jerk, HZ, &mut profiled).map(|()| profiled)
    }

    /// Speed (per second) in the middle of the way, the largest jerk, and the duration in seconds.
    fn measured(profile: &PathProfile) -> (f32, f32, f32) {
        let unit = profile.unit() * HZ * HZ * HZ;
        let (mut s, mut v, mut a, mut jerk, mut middle) = (0.0, 0.0, 0.0, 0.0_f32, 0.0);
        for segment in &profile.segments {
            let j = segment.jerk as f32 * unit;
            jerk = jerk.fmax(j.abs());
            for _ in 0..segment.ticks {
                let t = 1.0 / HZ;
                s += t * (v + t * (a / 2.0 + t * j / 6.0));
                v += t * (a + t * j / 2.0);
                a += t * j;
                if s < 0.5 {
                    middle = v;
                }
            }
        }
        assert!((s - 1.0_f32).abs() < 1e-3, "{s}");
        (middle, jerk, profile.ticks() as f32 / HZ)
    }

    #[test]
    fn corners_are_rounded_within_the_jerk_and_speeds_are_kept() {
        // 50 ms up to 2/s at 40/s^2, on, and down.
        let corners = corners(&[(0.0, 0.0), (0.05, 2.0), (0.95, 2.0), (1.0, 0.0)]);
        let (middle, jerk, seconds) = measured(&profiled(&corners, 1.0).unwrap());
        assert!((middle - 2.0).abs() < 2e-3, "{middle}");
        assert!(jerk <= LIMITS.jerk * 1.000_1, "{jerk}");
        // Half a ramp of 10 ms at either end.
        assert!((seconds - 0.56).abs() < 1e-3, "{seconds}");
    }

    #[test]
    fn slower_is_as_much_longer() {
        let corners = corners(&[(0.0, 0.0), (0.05, 2.0), (0.95, 2.0), (1.0, 0.0)]);
        let (middle, _, _) = measured(&profiled(&corners, 2.0).unwrap());
        assert!((middle - 1.0).abs() < 1e-3, "{middle}");
    }

    /// Two corners closer than their ramps: each ramp as long as their sum asks for.
    #[test]
    fn where_ramps_meet_the_jerk_is_kept() {
        let corners = corners(&[
            (0.0, 0.0),
            (0.05, 2.0),
            (0.5, 2.0),
            (0.505, 1.94),
            (0.55, 0.4),
            (0.95, 0.4),
            (1.0, 0.0),
        ]);
        let (_, jerk, _) = measured(&profiled(&corners, 1.0).unwrap());
        assert!(jerk <= LIMITS.jerk * 1.001, "{jerk}");
    }

    #[test]
    fn too_long_or_no_number_is_no_profile() {
        let never = corners(&[(0.0, 0.0), (0.5, 1e-3), (1.0, 0.0)]);
        assert!(profiled(&never, 1.0).is_none());
        let none = corners(&[(0.0, 0.0), (0.5, f32::NAN), (1.0, 0.0)]);
        assert!(profiled(&none, 1.0).is_none());
    }
}

//! The fastest brake of one axis, in closed form: `brake` without the vectors.
//!
//! Over the limit of acceleration, with jerk `j` a tick, and seen along the braking force: velocity `-v` is to be
//! gained from acceleration `a`. Up to a peak `p` and back to zero gains `(p^2 - a^2) / (2 j) + p^2 / (2 j)`, so
//! `p^2 = j v + a^2 / 2`; beyond the limit of 1 the peak is 1, held for what is left. An `a` over 1 is first let down
//! to it.

use super::{BRAKE_SLACK, whole};
use crate::motion::plan::units::AxisLimits;
use crate::number::float::FloatMinMax;
use crate::number::sqrt_f32;

/// What is to be braked, over the limit of acceleration.
#[derive(Clone, Copy)]
pub(crate) struct AxisBrake {
    velocity: f32,
    acceleration: f32,
    /// A tick.
    jerk: f32,
}

impl AxisBrake {
    /// Of a velocity and an acceleration in the units of the limits.
    pub fn new(velocity: f32, acceleration: f32, limits: &AxisLimits<f32>) -> Self {
        let over = 1.0 / limits.acceleration;
        Self {
            velocity: velocity * over,
            acceleration: acceleration * over,
            jerk: limits.jerk * over,
        }
    }

    /// The times of the first jerk, the peak and the last jerk in ticks, before rounding.
    fn times(&self) -> [f32; 3] {
        let (v, a, j) = (self.velocity, self.acceleration, self.jerk);
        let released = v + a * a.abs() / (2.0 * j);
        if released == 0.0 {
            return [a.abs() / j, 0.0, 0.0];
        }
        let (v, a) = if released > 0.0 { (v, -a) } else { (-v, a) };
        let square = j * v + a * a / 2.0;
        if a > 1.0 {
            [(a - 1.0) / j, (v - a * a / (2.0 * j)).fmax(0.0), 1.0 / j]
        } else if square > 1.0 {
            [(1.0 - a) / j, (square - 1.0) / j, 1.0 / j]
        } else {
            let peak = sqrt_f32(square.fmax(0.0));
            [(peak - a).fmax(0.0) / j, 0.0, peak / j]
        }
    }

    /// The times in whole ticks.
    pub fn ticks(&self) -> [f32; 3] {
        whole(self.times(), |n| self.over(n))
    }

    /// Which of these times are too short: for the first jerk, the peak, the last jerk.
    pub fn over(&self, [n1, n2, n3]: [f32; 3]) -> [bool; 3] {
        let left = self.velocity + self.acceleration * (n1 / 2.0);
        let peak = -left / (n1 / 2.0 + n2 + n3 / 2.0);
        let hardest = self.acceleration.abs().fmax(1.0);
        [
            (peak - self.acceleration).abs() > self.jerk * n1 * BRAKE_SLACK,
            peak.abs() > hardest * BRAKE_SLACK,
            peak.abs() > self.jerk * n3 * BRAKE_SLACK,
        ]
    }
}

#[cfg(test)]
mod tests {
    use crate::motion::brake::axis_brake::*;

    const LIMITS: AxisLimits<f32> = AxisLimits {
        velocity: 0.0,
        acceleration: 2.0,
        jerk: 0.25,
    };

    #[test]
    fn no_brake_is_faster_and_all_come_to_rest() {
        for k in 0..4_000 {
            let (v, a) = ((k % 80 - 40) as f32, (k / 80 - 25) as f32 * 0.1);
            let brake = AxisBrake::new(v, a, &LIMITS);
            let [n1, n2, n3] = brake.times();
            // What the first jerk, the peak and the last jerk change takes all velocity away.
            let released = v + a * a.abs() / 0.5;
            let sign = -if released == 0.0 { a } else { released }.signum();
            let peak = a + sign * if a * sign > 2.0 { -0.25 } else { 0.25 } * n1;
            let end = v + (a + peak) / 2.0 * n1 + peak * (n2 + n3 / 2.0);
            assert!(end.abs() < 1e-4, "{v} {a}: {end}");
            if n3 > 0.0 {
                assert!(
                    (peak.abs() - 0.25 * n3).abs() < 1e-4,
                    "{v} {a}: {peak} {n3}"
                );
            }
            assert!(peak.abs() <= 2.0 + 1e-5, "{v} {a}: {peak}");
            // Full jerk, and all of the acceleration wherever it is held: nothing is left to gain.
            assert!(n2 == 0.0 || (peak.abs() - 2.0).abs() < 1e-5);
            let whole = brake.ticks();
            assert_eq!(brake.over(whole), [false; 3], "{v} {a}");
            let longer: f32 = whole.iter().sum();
            // A start near its peak is let down to less and less of it while times are lengthened.
            assert!(longer <= n1 + n2 + n3 + 16.0, "{v} {a}: {whole:?}");
        }
    }
}

//! A steady motion, and how far it can go until the platform's centre meets the edge.
//!
//! The square of the centre's distance from the track's is followed: it grows no faster than a parabola of its value,
//! its slope and the most that its second derivative can be, whose crossing with the edge's square is known. Where the
//! platform does not turn about a point beside its centre that parabola is the thing itself, and the first step the
//! last.

use kinematics::Angle;
use motion::plan::axis_state::POSITION_UNITS;
use motion::tolerances::JOG_RADII;
use number::float::{FloatMinMax, hypot, truncate};
use number::{sin_cos_f32, sqrt_f32};

/// A steady motion: the moved point at `point` (track radii) and `theta` (2^-32 turns), its velocity per second and
/// that of theta in rad per second; and where the point lies in the platform.
pub(super) struct SteadyMotion {
    pub point: [f32; 2],
    pub theta: i64,
    pub velocity: [f32; 2],
    pub turning: f32,
    pub centre: [f32; 2],
}

/// Steps along a curve at most. What has been looked at by then is safe to go.
const MOST_STEPS: usize = 100;
/// A step that is no way worth it any more, s.
const LEAST_STEP: f32 = 2e-5;
const UNITS_PER_RAD: f32 = POSITION_UNITS / core::f32::consts::TAU;

impl SteadyMotion {
    /// Seconds until the platform's centre meets the edge of the disk of `radius`; infinite when it never does.
    pub fn time_to_edge(&self, radius: f32) -> f32 {
        let radius = radius - JOG_RADII;
        // How far the moved point lies from the platform's centre.
        let arm = hypot(self.centre[0], self.centre[1]);
        if self.turning == 0.0 || arm == 0.0 {
            let ([x, y], (square, half_rate)) = (self.velocity, self.square(0.0));
            return crossing(square - radius * radius, half_rate, x * x + y * y);
        }
        let speed = hypot(self.velocity[0], self.velocity[1]) + self.turning.abs() * arm;
        let second_derivative = speed * speed + radius * self.turning * self.turning * arm;
        let mut seconds = 0.0;
        for _ in 0..MOST_STEPS {
            let point = self.point_after(seconds);
            // From here on every orientation is inside, as long as the point is in a smaller disk.
            if hypot(point[0], point[1]) + arm <= radius {
                let ([x, y], [v, w], inner) = (point, self.velocity, radius - arm);
                return seconds
                    + crossing(x * x + y * y - inner * inner, x * v + y * w, v * v + w * w);
            }
            let (square, half_rate) = self.square(seconds);
            let step = crossing(square - radius * radius, half_rate, second_derivative);
            seconds += step;
            if step < LEAST_STEP {
                break;
            }
        }
        seconds
    }

    /// The square of the distance of the platform's centre from the track's, and half of its rate.
    pub fn square(&self, seconds: f32) -> (f32, f32) {
        let point = self.point_after(seconds);
        let [x, y] = self.platform(seconds);
        let arm = [point[0] - x, point[1] - y];
        let rate = [
            self.velocity[0] + self.turning * arm[1],
            self.velocity[1] - self.turning * arm[0],
        ];
        (x * x + y * y, x * rate[0] + y * rate[1])
    }

    fn point_after(&self, seconds: f32) -> [f32; 2] {
        both!(i => self.point[i] + self.velocity[i] * seconds)
    }

    /// The platform's centre after so many seconds.
    #[inline(never)]
    pub fn platform(&self, seconds: f32) -> [f32; 2] {
        if self.centre == [0.0; 2] {
            return self.point_after(seconds);
        }
        let turned = truncate(self.turning * seconds * UNITS_PER_RAD);
        let angle = Angle::from_units(self.theta.wrapping_add(turned));
        let (sin, cos) = sin_cos_f32(angle);
        let [x, y] = self.point_after(seconds);
        let [a, b] = self.centre;
        [x - (a * cos - b * sin), y - (a * sin + b * cos)]
    }
}

/// When `value + 2 slope t + second_derivative t^2` becomes positive; at once where it is and grows, never when nothing
/// bends it.
fn crossing(value: f32, slope: f32, second_derivative: f32) -> f32 {
    if second_derivative <= 0.0 {
        return f32::INFINITY;
    }
    let root = slope * slope - second_derivative * value;
    if root < 0.0 {
        return 0.0;
    }
    let root = sqrt_f32(root);
    // Of two forms of the same the one without a difference.
    let time = if slope > 0.0 {
        -value / (slope + root)
    } else {
        (root - slope) / second_derivative
    };
    time.fmax(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steady(point: [f32; 2], velocity: [f32; 2], turning: f32, centre: [f32; 2]) -> SteadyMotion {
        SteadyMotion {
            point,
            theta: 0,
            velocity,
            turning,
            centre,
        }
    }

    #[test]
    fn straight_motions_end_at_the_edge() {
        let reach = |steady: SteadyMotion| steady.time_to_edge(0.8);
        let near = |a: f32, b: f32| (a - b).abs() < 1e-5;
        assert!(near(
            reach(steady([0.0; 2], [2.0, 0.0], 0.0, [0.0; 2])),
            0.4
        ));
        assert!(near(
            reach(steady([0.0, 0.6], [1.0, 0.0], 3.0, [0.0; 2])),
            0.529_15
        ));
        // The platform's centre counts: at (-0.3, 0) when the point is in the middle.
        assert!(near(
            reach(steady([0.0; 2], [-1.0, 0.0], 0.0, [0.3, 0.0])),
            0.5
        ));
        assert_eq!(reach(steady([0.8, 0.0], [1.0, 0.0], 0.0, [0.0; 2])), 0.0);
        assert!(near(
            reach(steady([0.8, 0.0], [-1.0, 0.0], 0.0, [0.0; 2])),
            1.6
        ));
        assert_eq!(
            reach(steady([0.8, 0.0], [0.0; 2], 5.0, [0.0; 2])),
            f32::INFINITY
        );
    }

    #[test]
    fn about_a_point_the_platform_turns_to_the_edge_or_for_ever() {
        // The centre circles (0.2, 0) at 0.5: never outside.
        let inside = steady([0.2, 0.0], [0.0; 2], 1.0, [0.5, 0.0]).time_to_edge(0.8);
        assert_eq!(inside, f32::INFINITY);
        // It circles (0.5, 0) at 0.5, from (0, 0): out where 0.5 - 0.5 cos = 0.32 / 0.5.
        let edge = (1.0_f32 - 0.8 * 0.8 / (2.0 * 0.5 * 0.5)).acos();
        for turning in [1.0, -1.0] {
            let out = steady([0.5, 0.0], [0.0; 2], turning, [0.5, 0.0]).time_to_edge(0.8);
            assert!((out - edge).abs() < 1e-4, "{out:?} {edge}");
        }
    }

    #[test]
    fn a_curve_never_leaves_the_disk_before_its_time() {
        let mut random = 1_u32;
        let mut next = move || {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(random >> 8) as f32 / 8_388_608.0 - 1.0
        };
        let mut ended = 0;
        for _ in 0..2_000 {
            let centre = [next() * 0.7, next() * 0.7];
            let platform = [next() * 0.55, next() * 0.55];
            let steady = steady(
                [platform[0] + centre[0], platform[1] + centre[1]],
                [next(), next()],
                next() * 6.0,
                centre,
            );
            let reach = steady.time_to_edge(0.8);
            assert!(reach > 0.0 && reach < 1e3, "{reach:?}");
            for k in 0..=200 {
                let [x, y] = steady.platform(reach * k as f32 / 200.0);
                assert!(hypot(x, y) < 0.8, "{reach:?}");
            }
            let [x, y] = steady.platform(reach);
            let [point_x, point_y] = steady.point_after(reach);
            let inner = hypot(point_x, point_y) + hypot(centre[0], centre[1]);
            ended +=
                usize::from(inner > 0.8 - 1e-4 && inner < 0.8 + 1e-4 || hypot(x, y) > 0.8 - 1e-4);
        }
        // The rest graze the edge and end before it.
        assert!(ended > 1_950, "{ended}");
    }
}

//! How fast a straight line can be travelled at best, by a numerical method of its own.
//!
//! A lower bound of the optimum's duration under all limits: the longer of two motions of which each leaves something out.
//!
//! - Without the jerk: the time-optimal motion along the line under speed, acceleration, pivot rate and pivot acceleration, by
//!   integration in the phase plane (z = s'^2 over s) on 2,000 stretches, in f64. Backwards the largest z from which rest at
//!   the end can still be reached, by bisection; forwards from rest as steep as every limit allows. The pivots' derivatives by
//!   s are those of the kinematics crate for a motion of unit rate; the planner's are not used.
//! - Without the pivots: the jerk-limited motion under speed, acceleration and jerk, in closed form after a textbook.
//!
//! A motion under all limits keeps those of each of the two, so it can not be shorter than either.

use super::motion_bench::exact::platform;
use super::motion_bench::{UNIT, optimum_ticks};
use firmware::motion::{Constraints, Position};
use kinematics::{inverse, pivot_motion};
use std::f64::consts::TAU;

/// Durations of the two motions; see the module.
pub struct Optimum {
    without_jerk_s: f64,
    without_pivots_s: f64,
}

const PLACES: usize = 2000;

/// First and second derivative of each pivot's angle by s.
type Demand = [(f64, f64); 3];

impl Optimum {
    pub fn new(from: &Position, to: &Position, ground: &Constraints) -> Self {
        let limits = &ground.limits;
        let way = [0, 1, 2].map(|i| (to[i] - from[i]) as f64 / UNIT);
        let mm = way[0].hypot(way[1]) * ground.geometry.radius_mm;
        let deg = way[2].abs() * 360.0;
        let least = |along: f64, turning: f64| (along / mm).min(turning / deg);
        let rate = least(limits.speed_mm_s, limits.turn_speed_deg_s);
        let acceleration = least(limits.acceleration_mm_s2, limits.turn_acceleration_deg_s2);
        let jerk = least(limits.jerk_mm_s3, limits.turn_jerk_deg_s3);
        let start = from.map(|value| value as f64 / UNIT);
        let plane = Plane {
            demands: (0..=PLACES)
                .map(|k| {
                    demand(
                        &start,
                        &way,
                        k as f64 / PLACES as f64,
                        ground.rotation_centre,
                    )
                })
                .collect(),
            rate,
            acceleration,
            pivot_rate: limits.pivot_rate_rad_s,
            pivot_acceleration: limits.pivot_acceleration_rad_s2,
        };
        Self {
            without_jerk_s: plane.fastest(),
            without_pivots_s: optimum_ticks(rate, acceleration, jerk),
        }
    }

    pub fn seconds(&self) -> f64 {
        self.without_jerk_s.max(self.without_pivots_s)
    }
}

fn demand(start: &[f64; 3], way: &[f64; 3], s: f64, centre: [f64; 2]) -> Demand {
    let at = [0, 1, 2].map(|i| start[i] + way[i] * s);
    let theta = at[2].fract() * TAU;
    let rate = [way[0], way[1], way[2] * TAU];
    let (pose, twist, bend) = platform([at[0], at[1], theta], rate, [0.0; 3], centre);
    let guides = inverse(&pose).expect("inside the track").guides;
    let motion = pivot_motion(&guides, &twist, &bend);
    [0, 1, 2].map(|i| (motion.rates[i], motion.accelerations[i]))
}

/// The phase plane.
struct Plane {
    demands: Vec<Demand>,
    rate: f64,
    acceleration: f64,
    pivot_rate: f64,
    pivot_acceleration: f64,
}

impl Plane {
    /// Duration of the fastest motion.
    fn fastest(&self) -> f64 {
        let double = 2.0 / PLACES as f64;
        let mut z = vec![0.0; PLACES + 1];
        for k in (0..PLACES).rev() {
            let next = z[k + 1];
            z[k] = largest(self.square(k), |z| {
                let (low, high) = self.accelerations(k, z);
                low <= high && z + double * low <= next
            });
        }
        z[0] = 0.0;
        let mut seconds = 0.0;
        for k in 0..PLACES {
            let (_, high) = self.accelerations(k, z[k]);
            z[k + 1] = (z[k] + double * high).clamp(0.0, z[k + 1]);
            seconds += double / (z[k].sqrt() + z[k + 1].sqrt());
        }
        seconds
    }

    /// The largest z that the rates allow.
    fn square(&self, place: usize) -> f64 {
        let most = self.demands[place]
            .iter()
            .fold(0.0_f64, |most, (first, _)| most.max(first.abs()));
        self.rate.min(self.pivot_rate / most).powi(2)
    }

    /// Lowest and highest s'' at z; the lowest is above the highest where there is none.
    fn accelerations(&self, place: usize, z: f64) -> (f64, f64) {
        let mut range = (-self.acceleration, self.acceleration);
        for &(first, second) in &self.demands[place] {
            let ends =
                [-1.0, 1.0].map(|sign| (sign * self.pivot_acceleration - second * z) / first);
            range = (
                range.0.max(ends[0].min(ends[1])),
                range.1.min(ends[0].max(ends[1])),
            );
        }
        range
    }
}

/// The largest number up to `most` that does.
fn largest(most: f64, does: impl Fn(f64) -> bool) -> f64 {
    if does(most) {
        return most;
    }
    let (mut low, mut high) = (0.0, most);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if does(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

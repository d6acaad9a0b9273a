//! Limits of motion, as a user states them and as a line between two positions meets them.

use super::Position;
use kinematics::{Geometry, worst_rate_per_rotation, worst_rate_per_speed};

/// Limits of a motion. Translation is limited along the path (a diagonal is no faster than a straight).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Ticks a second.
    pub rate_hz: f64,
    /// Speed of the platform centre.
    pub speed_mm_s: f64,
    /// Its acceleration.
    pub acceleration_mm_s2: f64,
    /// Its jerk.
    pub jerk_mm_s3: f64,
    /// Rotation speed.
    pub turn_speed_deg_s: f64,
    /// Rotation acceleration.
    pub turn_acceleration_deg_s2: f64,
    /// Rotation jerk.
    pub turn_jerk_deg_s3: f64,
    /// Rate of any pivot.
    pub pivot_rate_rad_s: f64,
    /// How much harder than this an urgent stop may brake (acceleration; jerk by the same factor squared).
    pub stop_factor: f64,
}

/// A straight line from rest to rest, seen as a path parameter from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Length of the way of the platform centre, track radii.
    pub length: f64,
    /// Angle turned through, rad, not negative.
    pub turn_rad: f64,
    /// Largest distance of the platform centre from the track's on the way, track radii.
    pub furthest: f64,
}

/// Limits on the path parameter, per tick, tick squared and tick cubed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathLimits {
    /// Rate.
    pub rate: f64,
    /// Acceleration.
    pub acceleration: f64,
    /// Jerk.
    pub jerk: f64,
}

const UNIT: f64 = 1.0 / 4_294_967_296.0;

/// x and y of a position in track radii.
pub(super) fn centre(position: &Position) -> [f64; 2] {
    [position[0] as f64 * UNIT, position[1] as f64 * UNIT]
}

impl Line {
    /// The line between two positions.
    pub fn new(from: &Position, to: &Position) -> Self {
        let (a, b) = (centre(from), centre(to));
        Self {
            length: libm::hypot(b[0] - a[0], b[1] - a[1]),
            turn_rad: (to[2].wrapping_sub(from[2]) as f64 * UNIT).abs() * core::f64::consts::TAU,
            // The distance from a point is convex along a line: largest at an end.
            furthest: libm::hypot(a[0], a[1]).max(libm::hypot(b[0], b[1])),
        }
    }
}

impl Limits {
    /// Whether every limit is a positive number: along a line the smallest counts, which would hide one that is not.
    pub fn all_positive(&self) -> bool {
        let Self {
            rate_hz,
            speed_mm_s,
            acceleration_mm_s2,
            jerk_mm_s3,
            turn_speed_deg_s,
            turn_acceleration_deg_s2,
            turn_jerk_deg_s3,
            pivot_rate_rad_s,
            stop_factor,
        } = *self;
        let translation = [speed_mm_s, acceleration_mm_s2, jerk_mm_s3];
        let rotation = [turn_speed_deg_s, turn_acceleration_deg_s2, turn_jerk_deg_s3];
        let others = [rate_hz, pivot_rate_rad_s, stop_factor];
        [translation, rotation, others]
            .as_flattened()
            .iter()
            .all(|&limit| limit > 0.0)
    }

    /// The limits along `line`.
    ///
    /// The pivots' rate is kept by a bound that holds anywhere on the line at any orientation (DESIGN section 3): speed over
    /// sqrt(1 - r^2) plus rotation times 1 + r, with r the furthest point of the line.
    pub fn along(&self, line: &Line, geometry: &Geometry) -> PathLimits {
        let mm = geometry.radius_mm;
        let least = |translation: f64, rotation_deg: f64| {
            (translation / mm / line.length).min(rotation_deg.to_radians() / line.turn_rad)
        };
        let pivot = line.length * worst_rate_per_speed(line.furthest)
            + line.turn_rad * worst_rate_per_rotation(line.furthest);
        let rate = least(self.speed_mm_s, self.turn_speed_deg_s).min(self.pivot_rate_rad_s / pivot);
        let hz = self.rate_hz;
        PathLimits {
            rate: rate / hz,
            acceleration: least(self.acceleration_mm_s2, self.turn_acceleration_deg_s2) / (hz * hz),
            jerk: least(self.jerk_mm_s3, self.turn_jerk_deg_s3) / (hz * hz * hz),
        }
    }
}

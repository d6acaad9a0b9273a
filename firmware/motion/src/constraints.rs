//! What every plan keeps to: limits, as a user states them and as a line meets them, mechanism, workspace, and which
//! point of the platform is moved.

use kinematics::Geometry;
use number::float::{FloatMinMax, hypot};

/// Smallest and largest x and y (2^-32 track radii) and theta (2^-32 turns) of the point that is moved.
pub type Bounds = [[i64; 2]; 3];

/// See the module. The same for all plans until somebody changes a setting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constraints {
    /// Limits of motion.
    pub limits: Limits,
    /// Mechanism, and with it the usable disk, which the platform centre never leaves.
    pub geometry: Geometry,
    /// Radius of that disk, track radii: [`Geometry::usable_radius`], which takes long to compute.
    pub usable_radius: f64,
    /// Where the point that is moved may go.
    pub bounds: Bounds,
    /// The point that is moved and about which the platform turns (the centre of rotation): x and y in the platform's
    /// own axes, track radii. x and y of every [`Position`](super::Position) are those of this point in the base frame.
    pub rotation_centre: [f64; 2],
}

impl Constraints {
    /// The platform centre is moved, and may go wherever the mechanism lets it.
    pub const fn new(limits: Limits, geometry: Geometry) -> Self {
        Self {
            limits,
            geometry,
            usable_radius: geometry.usable_radius(),
            bounds: ANYWHERE,
            rotation_centre: [0.0; 2],
        }
    }

    /// The limits of ordinary motion in the units of planning.
    #[inline(never)]
    pub fn motion_limits(&self) -> MotionLimits {
        let limits = &self.limits;
        let mm = self.geometry.radius_mm as f32;
        let speeds = |mm_s: f64, deg_s: f64| Speeds {
            linear: mm_s as f32 / mm,
            angular: deg_s as f32 * (core::f32::consts::PI / 180.0),
        };
        MotionLimits {
            speed: speeds(limits.speed_mm_s, limits.turn_speed_deg_s),
            acceleration: speeds(limits.acceleration_mm_s2, limits.turn_acceleration_deg_s2),
            jerk: speeds(limits.jerk_mm_s3, limits.turn_jerk_deg_s3),
        }
    }

    /// The centre of rotation in single precision.
    pub fn centre(&self) -> [f32; 2] {
        self.rotation_centre.map(|radii| radii as f32)
    }
}

/// Four track radii, which no point leaves, and as many turns as can be counted.
const ANYWHERE: Bounds = [
    [-(4 << 32), 4 << 32],
    [-(4 << 32), 4 << 32],
    [i64::MIN, i64::MAX],
];

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
    /// Acceleration of any pivot, in an urgent stop too.
    pub pivot_acceleration_rad_s2: f64,
    /// An urgent stop brakes as hard as the pivots can follow, with jerk this factor squared times the limit of jerk.
    pub stop_factor: f64,
}

/// Limits on a path parameter that goes from 0 to 1, per second, second squared and second cubed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathLimits {
    /// Rate.
    pub rate: f32,
    /// Acceleration.
    pub acceleration: f32,
    /// Jerk.
    pub jerk: f32,
}

impl Limits {
    /// Those of the reference stage.
    pub const REFERENCE: Self = Self {
        rate_hz: 20_000.0,
        speed_mm_s: 200.0,
        acceleration_mm_s2: 4_000.0,
        jerk_mm_s3: 400_000.0,
        turn_speed_deg_s: 360.0,
        turn_acceleration_deg_s2: 7_200.0,
        turn_jerk_deg_s3: 720_000.0,
        pivot_rate_rad_s: 10.0,
        // The drives bear 314 with the bare platform, all pivots at once, at the edge of the disk and at 10 rad/s.
        pivot_acceleration_rad_s2: 300.0,
        stop_factor: 2.0,
    };

    /// Whether every limit is a positive number: along a line the smallest counts, which would hide one that is not.
    #[inline(never)]
    pub fn all_positive(&self) -> bool {
        let limits = [
            self.rate_hz,
            self.speed_mm_s,
            self.acceleration_mm_s2,
            self.jerk_mm_s3,
            self.turn_speed_deg_s,
            self.turn_acceleration_deg_s2,
            self.turn_jerk_deg_s3,
            self.pivot_rate_rad_s,
            self.pivot_acceleration_rad_s2,
            self.stop_factor,
        ];
        limits.iter().all(|limit| *limit > 0.0)
    }

    /// Jerk of an urgent stop over that of ordinary motion.
    pub fn urgent_jerk(&self) -> f32 {
        let factor = self.stop_factor as f32;
        factor * factor
    }
}

/// Speed of the moved point, track radii per second, and rate of rotation, rad per second; or their derivatives.
#[derive(Clone, Copy, Debug, Default)]
pub struct Speeds {
    /// Of translation.
    pub linear: f32,
    /// Of rotation.
    pub angular: f32,
}

impl Speeds {
    /// Of a vector of x, y and theta.
    pub fn of(vector: &[f32; 3]) -> Self {
        Self {
            linear: hypot(vector[0], vector[1]),
            angular: vector[2].abs(),
        }
    }

    /// Both times a factor.
    pub fn scaled(self, factor: f32) -> Self {
        Self {
            linear: self.linear * factor,
            angular: self.angular * factor,
        }
    }

    /// The greater of both parts.
    pub fn max(self, other: Self) -> Self {
        Self {
            linear: self.linear.fmax(other.linear),
            angular: self.angular.fmax(other.angular),
        }
    }
}

/// Limits of translation (track radii) and of rotation (rad), per second, squared and cubed.
#[derive(Clone, Copy, Debug)]
pub struct MotionLimits {
    /// Of speed.
    pub speed: Speeds,
    /// Of acceleration.
    pub acceleration: Speeds,
    /// Of jerk.
    pub jerk: Speeds,
}

impl MotionLimits {
    /// With acceleration and jerk times these.
    pub fn scaled(&self, acceleration: f32, jerk: f32) -> Self {
        Self {
            speed: self.speed,
            acceleration: self.acceleration.scaled(acceleration),
            jerk: self.jerk.scaled(jerk),
        }
    }

    /// The limits on the parameter of a line of this length and turn (not negative), those of the pivots aside.
    pub fn for_line(&self, length: f32, turn: f32) -> PathLimits {
        let least = |limit: &Speeds| (limit.linear / length).fmin(limit.angular / turn);
        PathLimits {
            rate: least(&self.speed),
            acceleration: least(&self.acceleration),
            jerk: least(&self.jerk),
        }
    }
}

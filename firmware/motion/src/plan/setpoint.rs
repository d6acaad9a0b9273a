//! What the control loop follows at a tick: the setpoint of the point of the platform that is moved, and what that is
//! for the platform's own centre.
//!
//! ```text
//!        P  the point that is moved, fixed in the platform at p        C   = P - R(theta) p
//!       /                                                              C'  = P' - theta' E R p
//!      / R(theta) p                                                    C'' = P'' - theta'' E R p + theta'^2 R p
//!     C  the platform's centre, which the pivots carry                 E: the quarter turn
//! ```
//!
//! Plans are in P, so that a straight line of P is a straight plan wherever the point lies, and theta turns about it.
//! The pivots need C: the tick derives it, in whole units of a position, so that the way there and back is exact:
//! another point may be chosen at rest and the platform does not move by a single unit.

use super::Position;
use kinematics::{Acceleration, Scalar, Twist};
use number::Fixed;

/// Where the point that is moved, or the platform's centre, should be at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Setpoint {
    /// Pose.
    pub position: Position,
    /// Velocity, track radii and rad per second.
    pub twist: Twist<f32>,
    /// Acceleration, track radii and rad per second squared.
    pub acceleration: Acceleration<f32>,
}

impl Setpoint {
    /// Of vectors of x, y and theta.
    #[inline]
    pub(super) fn new(position: Position, v: [f32; 3], a: [f32; 3]) -> Self {
        let [x, y, theta] = v;
        let twist = Twist { x, y, theta };
        let [x, y, theta] = a;
        let acceleration = Acceleration { x, y, theta };
        Self {
            position,
            twist,
            acceleration,
        }
    }
}

/// Factors from the integers of [`AxisState`](super::axis_state::AxisState) to physical rates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SetpointScale {
    /// Of x and y, and of theta.
    pub(super) velocity: [f32; 2],
    pub(super) acceleration: [f32; 2],
    pub(super) rate_hz: f32,
}

/// Bits cut from a velocity and from an acceleration to make them 32 bits wide: full range 39 turns per second and
/// 3,050 per second squared at 20 kHz, resolution 1e-7 rad/s and 9e-6 rad/s^2. An urgent stop brakes as hard as a pivot
/// can, 300 rad/s^2 by default: some 350 track radii per second squared.
pub const VELOCITY_CUT: u32 = 32;
/// The same of an acceleration.
pub const ACCELERATION_CUT: u32 = 24;

impl SetpointScale {
    /// For `rate_hz` ticks a second.
    pub fn new(rate_hz: f64) -> Self {
        let unit = |cut: u32| libm::exp2(f64::from(cut) - 72.0);
        let scale = |unit: f64| [unit as f32, (unit * core::f64::consts::TAU) as f32];
        Self {
            velocity: scale(unit(VELOCITY_CUT) * rate_hz),
            acceleration: scale(unit(ACCELERATION_CUT) * rate_hz * rate_hz),
            rate_hz: rate_hz as f32,
        }
    }
}

/// A point of the platform: x and y in the platform's own axes. The default is the platform's centre itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RotationCentre([Fixed; 2]);

/// Furthest that a point may lie from the platform's centre, track radii. Further out its rotation alone would ask more
/// of the numbers than [`Fixed`] holds.
pub const MAX_CENTRE_OFFSET: f64 = 1.0;

impl RotationCentre {
    /// The platform's own centre.
    pub const PLATFORM: Self = Self([Fixed::ZERO; 2]);

    /// The point at `point` (track radii), to the nearest 2^-29; `None` beyond [`MAX_CENTRE_OFFSET`] or when it is no
    /// point.
    pub fn new(point: [f64; 2]) -> Option<Self> {
        (libm::hypot(point[0], point[1]) <= MAX_CENTRE_OFFSET)
            .then(|| Self(point.map(Fixed::from_f64)))
    }

    /// Where it lies, track radii, exactly.
    pub fn point(&self) -> [f64; 2] {
        self.0.map(Fixed::to_f64)
    }

    /// Position of this point when the platform's centre is at `platform`.
    pub fn from_platform(&self, platform: &Position) -> Position {
        let [x, y, theta] = *platform;
        let arm = self.arm(theta).units;
        [x.wrapping_add(arm[0]), y.wrapping_add(arm[1]), theta]
    }

    /// Position of the platform's centre when this point is at `point`: the inverse of
    /// [`from_platform`](Self::from_platform), to the unit.
    pub fn to_platform(&self, point: &Position) -> Position {
        let [x, y, theta] = *point;
        let arm = self.arm(theta).units;
        [x.wrapping_sub(arm[0]), y.wrapping_sub(arm[1]), theta]
    }

    /// The platform's setpoint when this point's is `point`.
    #[inline]
    pub fn platform_setpoint(&self, point: &Setpoint) -> Setpoint {
        if *self == Self::PLATFORM {
            return *point;
        }
        let mut platform = *point;
        let Arm { units, radii } = self.arm(point.position[2]);
        platform.position[0] = point.position[0].wrapping_sub(units[0]);
        platform.position[1] = point.position[1].wrapping_sub(units[1]);
        let ([a, b], turn, turn_acceleration) =
            (radii, point.twist.theta, point.acceleration.theta);
        let inward = turn * turn;
        platform.twist.x += turn * b;
        platform.twist.y -= turn * a;
        platform.acceleration.x += turn_acceleration * b + inward * a;
        platform.acceleration.y -= turn_acceleration * a - inward * b;
        platform
    }

    /// R(theta) p.
    #[inline(never)]
    fn arm(&self, theta: i64) -> Arm {
        let Self([x, y]) = *self;
        let (sin, cos) = Fixed::sin_cos(kinematics::Angle::from_units(theta));
        let units = [
            Fixed::products_as_position((x, cos), (-y, sin)),
            Fixed::products_as_position((x, sin), (y, cos)),
        ];
        // A point is within one radius: 33 bits, which a float cuts to 24 anyway.
        let radii = units.map(|units| (units >> 2) as i32 as f32 * (1.0 / (1 << 30) as f32));
        Arm { units, radii }
    }
}

/// From the platform's centre to the point, in the base frame: 2^-32 track radii, and track radii.
struct Arm {
    units: [i64; 2],
    radii: [f32; 2],
}

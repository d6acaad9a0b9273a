//! What every plan keeps to: limits, mechanism, workspace, and which point of the platform is moved.

use super::limits::Limits;
use super::speeds::Speeds;
use kinematics::Geometry;

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

    /// Rates of translation (mm) and of rotation (deg) in the units of planning.
    #[inline(never)]
    pub fn speeds(&self, mm: f64, deg: f64) -> Speeds {
        Speeds {
            linear: mm as f32 / self.geometry.radius_mm as f32,
            angular: deg as f32 * (core::f32::consts::PI / 180.0),
        }
    }
}

/// Four track radii, which no point leaves, and as many turns as can be counted.
const ANYWHERE: Bounds = [
    [-(4 << 32), 4 << 32],
    [-(4 << 32), 4 << 32],
    [i64::MIN, i64::MAX],
];

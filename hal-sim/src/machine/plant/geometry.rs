//! Where a pivot lies on its guide, on a machine as it was built: every error of the mechanism's geometry enters here.
//!
//! The residual form, which needs no inverse kinematics and shares no formula with the controller's:
//!
//! ```text
//! P = a + (R + r(phi)) (cos phi, sin phi)         pivot on its ring: centre a, radius R, run-out r
//! t = theta + g + e                               direction of the guide: g = -30, 90, 210 deg, e its error
//! u = (cos t, sin t),  n = (-sin t, cos t)        along the guide, and to its left
//! rho = u . (P - C)                               place on the guide
//! f   = n . (P - C) - d0 - S(rho)                 what the pivot is off the guide's line: offset d0, straightness S
//! ```
//!
//! R grows with the warmth of the track. What else of the mechanism would grow with it is a thousandth of that.
//!
//! A guide that gives way passes on a force against f; a rigid one keeps f at 0. Angles from a pose are found by Newton's method.

use kinematics::Scalar;
use nalgebra::{Vector2, Vector3};

use super::curves::{Curve, runout, straightness};
use super::parameters::PlantParameters;
use super::pivot_geometry::{AXES, PivotGeometry};

/// Directions of the three guides in the platform, rad.
const GUIDE_RAD: [f64; AXES] = {
    use core::f64::consts::FRAC_PI_6;
    [-FRAC_PI_6, 3.0 * FRAC_PI_6, 7.0 * FRAC_PI_6]
};
/// A guide that lies closer to the ring's tangent's normal than this, as the cosine of the angle between pivot and guide, has come loose.
const LEAST_COSINE: f64 = 0.01;
/// Periods of a ring's run-out by its balls in one of its turns: the cage's, and the balls' in it. Neither is a whole number, nor are
/// both after any number of turns: it does not repeat. The second is a third of the first.
const BALL_PERIODS: [f64; 2] = [0.486_713, 30.790_41];
const BALL_SHARES: [f64; 2] = [1.0, 1.0 / 3.0];
/// Newton's steps from a pivot straight on its guide; twelve are enough at a cosine of 0.01.
const MAX_STEPS: u32 = 30;
/// A step so small, over the size of the angle, is the last: the next would be its square.
const SMALL_STEP: f64 = 1e-10;

/// A pivot cannot be on its guide at this pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("pivot {} cannot be on its guide", .guide + 1)]
pub struct OffGuide {
    /// Which guide, 0 to 2.
    pub guide: usize,
}

/// One pivot on its ring and one guide on the platform.
#[derive(Clone, Copy, Debug)]
struct Pivot {
    built: PivotGeometry,
    has_runout: bool,
    has_straightness: bool,
    ball_runout_m: f64,
    ball_phase_rad: f64,
    radius_m: f64,
    /// The same where it was measured.
    cold_radius_m: f64,
    /// Sine and cosine of the guide's direction in the platform.
    direction: (f64, f64),
    direction_rad: f64,
}

/// The three pivots and guides.
#[derive(Clone, Copy, Debug)]
pub struct Geometry {
    track_radius_m: f64,
    expansion_per_k: f64,
    pivots: [Pivot; AXES],
}

/// A pivot and its guide at a pose and an angle of the ring; see the head of the file for the letters.
#[derive(Clone, Copy, Debug)]
pub struct GuideState {
    u: Vector2<f64>,
    n: Vector2<f64>,
    /// f, m.
    pub gap_m: f64,
    /// rho, m.
    pub rho_m: f64,
    /// Distance of the pivot to the left of the platform's centre, `n . (P - C)`, m.
    side_m: f64,
    straightness: Curve,
    /// First and second derivative of P by the ring's angle, m.
    pivot_slope_m: Vector2<f64>,
    pivot_curvature_m: Vector2<f64>,
}

impl Geometry {
    /// Takes the constants; with the errors of geometry switched off, those of the drawing.
    #[must_use]
    pub fn new(parameters: &PlantParameters) -> Self {
        let pivots = [0, 1, 2].map(|i: usize| {
            let (built, direction_rad) = (parameters.pivots[i], GUIDE_RAD[i]);
            let built = if parameters.imperfections.geometry {
                built
            } else {
                PivotGeometry::IDEAL
            };
            let direction_rad = direction_rad + built.guide_error_rad;
            let cold_radius_m = parameters.track_radius_m + built.radius_error_m;
            Pivot {
                built,
                has_runout: built.runout_m != PivotGeometry::IDEAL.runout_m,
                has_straightness: built.straightness_m != PivotGeometry::IDEAL.straightness_m,
                ball_runout_m: if parameters.imperfections.ball_runout {
                    parameters.ball_runout_m
                } else {
                    0.0
                },
                ball_phase_rad: parameters.ball_phase_rad[i],
                radius_m: cold_radius_m,
                cold_radius_m,
                direction: <f64 as Scalar>::sin_cos(direction_rad),
                direction_rad,
            }
        });
        let mut geometry = Self {
            track_radius_m: parameters.track_radius_m,
            expansion_per_k: parameters.track.expansion_per_k,
            pivots,
        };
        if parameters.imperfections.track_heat {
            geometry.warm(parameters.track.start_k);
        }
        geometry
    }

    /// Makes the track so much warmer than where its radius was measured, K.
    pub fn warm(&mut self, warmer_k: f64) {
        let grown = 1.0 + self.expansion_per_k * warmer_k;
        for pivot in &mut self.pivots {
            pivot.radius_m = pivot.cold_radius_m * grown;
        }
    }

    /// The three guides at a pose (m, m, rad) and angles of the rings.
    #[must_use]
    pub fn guides(&self, pose: &Vector3<f64>, ring_rad: &Vector3<f64>) -> [GuideState; AXES] {
        let turned = <f64 as Scalar>::sin_cos(pose.z);
        self.some_guides([0, 1, 2], pose, turned, (*ring_rad).into())
    }

    /// Angles of the rings with every pivot on its guide, rad, multi-turn with theta.
    ///
    /// # Errors
    /// [`OffGuide`]: no pivot reaches the guide there.
    pub fn rings_rad(&self, pose: &Vector3<f64>) -> Result<Vector3<f64>, OffGuide> {
        let straight = Vector3::from(self.pivots.map(|pivot| pose.z + pivot.direction_rad));
        let turned = <f64 as Scalar>::sin_cos(pose.z);
        let mut ring_rad = straight;
        for guide in 0..AXES {
            ring_rad[guide] = self.ring_rad(guide, pose, turned, straight[guide])?;
        }
        Ok(ring_rad)
    }

    fn ring_rad(
        &self,
        guide: usize,
        pose: &Vector3<f64>,
        turned: (f64, f64),
        start_rad: f64,
    ) -> Result<f64, OffGuide> {
        let mut angle_rad = start_rad;
        for _ in 0..MAX_STEPS {
            let [state] = self.some_guides([guide], pose, turned, [angle_rad]);
            let step_rad = -state.gap_m / self.lever_m(guide, &state)?;
            angle_rad += step_rad;
            if step_rad.abs() < SMALL_STEP * (1.0 + angle_rad.abs()) {
                return Ok(angle_rad);
            }
        }
        Err(OffGuide { guide })
    }

    /// How far a pivot leaves its guide for each rad of its ring, m: the radius times the cosine between the two.
    ///
    /// # Errors
    /// [`OffGuide`]: the pivot moves along the guide, or has passed that place.
    pub fn lever_m(&self, guide: usize, state: &GuideState) -> Result<f64, OffGuide> {
        let lever_m = state.gap_by_ring_m();
        if lever_m > LEAST_COSINE * self.track_radius_m {
            Ok(lever_m)
        } else {
            Err(OffGuide { guide })
        }
    }

    /// Some guides together: one after the other each would wait for its own curves, in which every term waits for the one before.
    fn some_guides<const N: usize>(
        &self,
        which: [usize; N],
        pose: &Vector3<f64>,
        turned: (f64, f64),
        ring_rad: [f64; N],
    ) -> [GuideState; N] {
        let pivots = which.map(|i| &self.pivots[i]);
        let angles = ring_rad.map(<f64 as Scalar>::sin_cos);
        let runouts = if pivots.iter().any(|pivot| pivot.has_runout) {
            runout(pivots.map(|pivot| &pivot.built.runout_m), angles)
        } else {
            [Curve::default(); N]
        };
        let mut lane = 0;
        let mut states = pivots.map(|pivot| {
            let state = pivot.place(pose, turned, ring_rad[lane], angles[lane], runouts[lane]);
            lane += 1;
            state
        });
        if pivots.iter().any(|pivot| pivot.has_straightness) {
            let sizes = pivots.map(|pivot| &pivot.built.straightness_m);
            let places_m = states.map(|state| state.rho_m);
            let curves = straightness(sizes, places_m, self.track_radius_m);
            for (state, curve) in states.iter_mut().zip(curves) {
                state.gap_m -= curve.value;
                state.straightness = curve;
            }
        }
        states
    }
}

impl Pivot {
    /// The pivot at a pose and an angle of its ring, as if its guide were straight.
    fn place(
        &self,
        pose: &Vector3<f64>,
        (sin, cos): (f64, f64),
        ring_rad: f64,
        (ring_sin, ring_cos): (f64, f64),
        runout: Curve,
    ) -> GuideState {
        let (guide_sin, guide_cos) = self.direction;
        let u = Vector2::new(
            cos * guide_cos - sin * guide_sin,
            sin * guide_cos + cos * guide_sin,
        );
        let n = Vector2::new(-u.y, u.x);
        let (outwards, onwards) = (
            Vector2::new(ring_cos, ring_sin),
            Vector2::new(-ring_sin, ring_cos),
        );
        let radius_m = self.radius_m + runout.value;
        let shift = self.ball_runout(ring_rad);
        let centre_m = Vector2::from(self.built.ring_centre_m) + shift[0];
        let place = centre_m + radius_m * outwards - pose.xy();
        let side_m = n.dot(&place);
        GuideState {
            u,
            n,
            gap_m: side_m - self.built.guide_offset_m,
            rho_m: u.dot(&place),
            side_m,
            straightness: Curve::default(),
            pivot_slope_m: runout.slope * outwards + radius_m * onwards + shift[1],
            pivot_curvature_m: (runout.curvature - radius_m) * outwards
                + 2.0 * runout.slope * onwards
                + shift[2],
        }
    }

    /// Shift of the ring's centre by its balls, m, and its first two derivatives by the ring's angle.
    fn ball_runout(&self, ring_rad: f64) -> [Vector2<f64>; 3] {
        let mut shift = [Vector2::zeros(); 3];
        if self.ball_runout_m == 0.0 {
            return shift;
        }
        for (periods, share) in BALL_PERIODS.into_iter().zip(BALL_SHARES) {
            let (sin, cos) = <f64 as Scalar>::sin_cos(periods * ring_rad + self.ball_phase_rad);
            let size_m = share * self.ball_runout_m;
            shift[0] += size_m * Vector2::new(cos, sin);
            shift[1] += size_m * periods * Vector2::new(-sin, cos);
            shift[2] -= size_m * periods * periods * Vector2::new(cos, sin);
        }
        shift
    }
}

impl GuideState {
    /// Derivative of f by x (m), y (m) and theta (rad).
    #[must_use]
    pub fn gap_by_pose(&self) -> Vector3<f64> {
        let across = self.across();
        let by_theta_m = -self.rho_m - self.straightness.slope * self.side_m;
        Vector3::new(-across.x, -across.y, by_theta_m)
    }

    /// Derivative of f by the ring's angle, m.
    #[must_use]
    pub fn gap_by_ring_m(&self) -> f64 {
        self.across().dot(&self.pivot_slope_m)
    }

    /// Derivative of rho by x (m), y (m) and theta (rad).
    #[must_use]
    pub fn rho_by_pose(&self) -> Vector3<f64> {
        Vector3::new(-self.u.x, -self.u.y, self.side_m)
    }

    /// Derivative of rho by the ring's angle, m.
    #[must_use]
    pub fn rho_by_ring_m(&self) -> f64 {
        self.u.dot(&self.pivot_slope_m)
    }

    /// Second derivative of f by time while neither platform nor ring accelerates, m/s^2.
    #[must_use]
    pub fn gap_bias_m_s2(&self, twist: &Vector3<f64>, ring_rad_s: f64) -> f64 {
        let spin = twist.z;
        let (moving, bent) = (
            self.pivot_slope_m * ring_rad_s - twist.xy(),
            self.pivot_curvature_m * (ring_rad_s * ring_rad_s),
        );
        let rho_rate = spin * self.side_m + self.u.dot(&moving);
        let side_bias =
            -spin * spin * self.side_m - 2.0 * spin * self.u.dot(&moving) + self.n.dot(&bent);
        let rho_bias =
            -spin * spin * self.rho_m + 2.0 * spin * self.n.dot(&moving) + self.u.dot(&bent);
        side_bias
            - self.straightness.curvature * rho_rate * rho_rate
            - self.straightness.slope * rho_bias
    }

    /// The direction across the guide where the pivot is: n, turned with the guide's own slope.
    fn across(&self) -> Vector2<f64> {
        self.n - self.straightness.slope * self.u
    }
}

//! The equations of motion: from state and drives to the state's time derivative.
//!
//! Coordinates are x, y (m) and theta of the platform, plus a motor angle a drive. The rings hang on the platform
//! through the inverse kinematics, `phi' = J q'`, so by d'Alembert
//!
//! ```text
//! (M_body + J^T I_ring J) q'' = J^T (T_spring - T_friction + T_external - I_ring J' q')
//!                             + F_body + F_stops + F_external
//! ```

use kinematics::{Acceleration, Guide, Inverse, InverseError, Pose, Scalar, Twist};
use nalgebra::{Matrix3, Vector3};

use super::body::Body;
use super::drive::{Drive, DriveModel};
use super::friction::Friction;
use super::parameters::{AXES, PlantParameters};
use super::state::State;
use super::stops::EndStops;

/// Forces from outside, for tests and disturbances.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct External {
    /// Force on the platform's centre along x and y, base frame, N.
    pub force_n: [f64; 2],
    /// Torque on the platform, N m.
    pub torque_n_m: f64,
    /// Torque on each ring, N m.
    pub ring_torque_n_m: [f64; AXES],
    /// Angle at which a ring is jammed, rad: by something about as stiff as the guides' ends.
    pub jammed_at_rad: [Option<f64>; AXES],
}

/// Stiffness of what jams a ring, N m/rad, and its damping, about half of what lets the ring not swing.
const JAM_N_M_RAD: f64 = 1e5;
const JAM_N_M_S_RAD: f64 = 50.0;

/// Everything that is constant while the machine moves.
#[derive(Clone, Debug)]
pub(super) struct Dynamics {
    inverse_radius_1_m: f64,
    ring_inertia_kg_m2: f64,
    gravity_m_s2: [f64; 2],
    pub body: Body,
    pub drive: DriveModel,
    pub friction: Friction,
    pub stops: EndStops,
}

impl Dynamics {
    pub fn new(parameters: &PlantParameters) -> Self {
        Self {
            inverse_radius_1_m: 1.0 / parameters.track_radius_m,
            ring_inertia_kg_m2: parameters.ring_inertia_kg_m2,
            gravity_m_s2: parameters.gravity_m_s2,
            body: Body::new(parameters),
            drive: DriveModel::new(parameters),
            friction: Friction::new(parameters),
            stops: EndStops::new(parameters),
        }
    }

    /// Ring angles and guides at a pose (m, m, rad).
    pub fn inverse(&self, pose: &Vector3<f64>) -> Result<Inverse<f64>, InverseError> {
        kinematics::inverse(&Pose {
            x: pose.x * self.inverse_radius_1_m,
            y: pose.y * self.inverse_radius_1_m,
            theta: pose.z,
        })
    }

    /// Jacobian from (m/s, m/s, rad/s) to ring rates in rad/s.
    pub fn jacobian(&self, guides: &[Guide<f64>; AXES]) -> Matrix3<f64> {
        let mut jacobian = kinematics::jacobian(guides);
        jacobian.column_mut(0).scale_mut(self.inverse_radius_1_m);
        jacobian.column_mut(1).scale_mut(self.inverse_radius_1_m);
        jacobian
    }

    /// Mass matrix of body and rings for (x, y, theta), SI. The motors are apart, behind their springs.
    pub fn mass_matrix(&self, theta_rad: f64, jacobian: &Matrix3<f64>) -> Matrix3<f64> {
        let (sin, cos) = <f64 as Scalar>::sin_cos(theta_rad);
        let body = self.body.mass_matrix(self.body.first_moment(sin, cos));
        body + self.ring_inertia_kg_m2 * jacobian.tr_mul(jacobian)
    }

    /// Time derivative of the state. `step_s` is the length of the integration step that it is for.
    pub fn derivative(
        &self,
        state: &State,
        drives: &[Drive; AXES],
        external: &External,
        step_s: f64,
    ) -> Result<State, InverseError> {
        match self.inverse(&state.pose) {
            // By reference: moved out, its copy would wait for the stores inside `inverse`, 4 % of a step.
            Ok(ref inverse) => Ok(self.derivative_at(inverse, state, drives, external, step_s)),
            Err(reason) => Err(reason),
        }
    }

    fn derivative_at(
        &self,
        Inverse { pivots, guides }: &Inverse<f64>,
        state: &State,
        drives: &[Drive; AXES],
        external: &External,
        step_s: f64,
    ) -> State {
        let jacobian = self.jacobian(guides);
        let ring_rad_s = jacobian * state.twist;
        let mut rate = State {
            pose: state.twist,
            twist: Vector3::zeros(),
            motor_rad: state.motor_rad_s,
            motor_rad_s: Vector3::zeros(),
            current_a: Vector3::zeros(),
            bristle_rad: Vector3::zeros(),
        };
        let mut ring_n_m = Vector3::from(external.ring_torque_n_m);
        for i in 0..AXES {
            let transmitted_n_m = self.drive.transmitted_torque(
                state.motor_rad[i] - pivots[i],
                state.motor_rad_s[i] - ring_rad_s[i],
            );
            let friction = self
                .friction
                .evaluate(ring_rad_s[i], state.bristle_rad[i], step_s);
            ring_n_m[i] += transmitted_n_m - friction.torque_n_m;
            if let Some(at_rad) = external.jammed_at_rad[i] {
                ring_n_m[i] -= JAM_N_M_RAD * (pivots[i] - at_rad) + JAM_N_M_S_RAD * ring_rad_s[i];
            }
            rate.bristle_rad[i] = friction.bristle_rate_rad_s;
            rate.motor_rad_s[i] = self.drive.motor_acceleration(
                state.current_a[i],
                state.motor_rad[i],
                transmitted_n_m,
            );
            rate.current_a[i] =
                self.drive
                    .current_rate(drives[i], state.current_a[i], state.motor_rad_s[i]);
        }
        rate.twist = self.acceleration(state, guides, &jacobian, ring_n_m, external);
        rate
    }

    /// Acceleration of the platform under the torques on its rings.
    fn acceleration(
        &self,
        state: &State,
        guides: &[Guide<f64>; AXES],
        jacobian: &Matrix3<f64>,
        ring_n_m: Vector3<f64>,
        external: &External,
    ) -> Vector3<f64> {
        // Guide 2 is the platform's y' axis, so its direction holds the sine and cosine of theta.
        let (sin, cos) = (-guides[1].cos, guides[1].sin);
        let moment_kg_m = self.body.first_moment(sin, cos);
        let inertial_n_m = ring_n_m - self.ring_inertia_kg_m2 * self.bias(guides, &state.twist);
        let mut force = jacobian.tr_mul(&inertial_n_m)
            + self
                .body
                .forces(moment_kg_m, state.twist.z, self.gravity_m_s2)
            + Vector3::new(
                external.force_n[0],
                external.force_n[1],
                external.torque_n_m,
            );
        for guide in guides {
            if let Some(stop) = self.stops.force(guide, &state.twist) {
                force += stop;
            }
        }
        let mass = self.body.mass_matrix(moment_kg_m)
            + self.ring_inertia_kg_m2 * jacobian.tr_mul(jacobian);
        solve_symmetric(&mass, &force)
    }

    /// `J' q'`: what the rings accelerate while the platform does not, rad/s^2.
    fn bias(&self, guides: &[Guide<f64>; AXES], twist: &Vector3<f64>) -> Vector3<f64> {
        let twist = Twist {
            x: twist.x * self.inverse_radius_1_m,
            y: twist.y * self.inverse_radius_1_m,
            theta: twist.z,
        };
        let unaccelerated = Acceleration {
            x: 0.0,
            y: 0.0,
            theta: 0.0,
        };
        Vector3::from(kinematics::pivot_accelerations(
            guides,
            &twist,
            &unaccelerated,
        ))
    }
}

/// Solves a symmetric 3x3 system by its adjugate. A mass matrix is positive definite, so the determinant never is zero.
fn solve_symmetric(matrix: &Matrix3<f64>, right: &Vector3<f64>) -> Vector3<f64> {
    let (a, b, c) = (matrix.column(0), matrix.column(1), matrix.column(2));
    let (bc, ca, ab) = (b.cross(&c), c.cross(&a), a.cross(&b));
    Vector3::new(bc.dot(right), ca.dot(right), ab.dot(right)) * (1.0 / a.dot(&bc))
}

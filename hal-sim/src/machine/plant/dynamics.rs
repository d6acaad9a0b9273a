//! The equations of motion: from state and drives to the state's time derivative.
//!
//! Coordinates are x, y (m) and theta of the platform q, and for each drive the angle of its ring phi and of its motor. A guide couples
//! platform and ring by its gap `f(q, phi)`, see `geometry.rs`. Guides that give way pass on a force against the gap, and platform and
//! rings are bodies of their own:
//!
//! ```text
//! M_body q''   = F_body + F_external + sum of the guides' forces on the platform
//! I_ring phi'' = T_spring - T_friction + T_external + the guide's torque on the ring
//! ```
//!
//! Rigid guides keep f at 0, so `phi' = J q'` with `J = -f_q / f_phi`, `phi'' = J q'' + b` with b the part that is there while nothing
//! accelerates, and by d'Alembert
//!
//! ```text
//! (M_body + J^T I_ring J) q'' = J^T (torques on the rings - I_ring b) + forces on the platform
//! ```

use kinematics::Scalar;
use nalgebra::{Matrix3, Vector3};

use super::body::Body;
use super::bumpers::Bumpers;
use super::drive::{CyclicError, Drive, DriveModel};
use super::friction::Friction;
use super::geometry::{Geometry, GuideState, OffGuide};
use super::guide::Guides;
use super::parameters::PlantParameters;
use super::pivot_geometry::AXES;
use super::state::State;

/// Forces from outside, and what has worn or come loose: for tests and disturbances.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct External {
    /// Force on the platform's centre along x and y, base frame, N.
    pub force_n: [f64; 2],
    /// Torque on the platform, N m.
    pub torque_n_m: f64,
    /// Acceleration of the floor along x and y besides what the surroundings make of it, m/s^2.
    pub floor_m_s2: [f64; 2],
    /// Torque on each ring, N m.
    pub ring_torque_n_m: [f64; AXES],
    /// Angle at which a ring is jammed, rad: by something about as stiff as the guides' ends.
    pub jammed_at_rad: [Option<f64>; AXES],
    /// Place on its guide at which a carriage is jammed, m from the platform's centre.
    pub guide_jammed_at_m: [Option<f64>; AXES],
    /// Share of each motor's torque that is gone, and of its back-EMF: magnets that have lost their strength.
    pub lost_torque: [f64; AXES],
    /// Friction that each ring has more than it should, N m.
    pub more_friction_n_m: [f64; AXES],
    /// How far each coupling has come loose, to either side, rad at the ring.
    pub loose_rad: [f64; AXES],
    /// Share of each transmission's stiffness that is gone: a belt or a coupling that is about to go, and a resonance that falls.
    pub lost_stiffness: [f64; AXES],
}

/// Stiffness of what jams a ring, N m/rad, and its damping, about half of what lets the ring not swing.
const JAM_N_M_RAD: f64 = 1e5;
const JAM_N_M_S_RAD: f64 = 50.0;
/// Rate at which half of what friction has more acts, rad/s: slow enough for the integrator.
const MORE_FRICTION_RAD_S: f64 = 0.02;
/// A pivot on a rigid guide that is further off its line after a step, m, was torn off.
const TORN_OFF_M: f64 = 1e-6;

/// Everything that is constant while the machine moves.
#[derive(Clone, Debug)]
pub(super) struct Dynamics {
    ring_inertia_kg_m2: f64,
    /// Acceleration that everything feels in the plane, base frame: gravity less the floor's.
    pub gravity_m_s2: [f64; 2],
    /// Of the three windings, as warm as they are.
    pub resistance_ohm: [f64; AXES],
    pub body: Body,
    pub drive: DriveModel,
    pub ring_friction: Friction,
    pub motor_friction: Friction,
    cable_stiffness_n_m: f64,
    pub guides: Guides,
    pub bumpers: Bumpers,
    pub geometry: Geometry,
}

/// Forces on the platform (N, N, N m) and torques on the rings (N m).
struct Forces {
    platform: Vector3<f64>,
    ring_n_m: Vector3<f64>,
}

impl Dynamics {
    pub fn new(parameters: &PlantParameters) -> Self {
        let flags = parameters.imperfections;
        Self {
            ring_inertia_kg_m2: parameters.ring_inertia_kg_m2,
            gravity_m_s2: parameters.gravity_m_s2,
            resistance_ohm: [parameters.resistance_ohm; AXES],
            body: Body::new(parameters),
            drive: DriveModel::new(parameters),
            ring_friction: Friction::new(
                &parameters.ring_friction,
                flags.dry_friction,
                flags.viscous_friction,
            ),
            motor_friction: if flags.gear_losses {
                Friction::with_loads(&parameters.motor_friction, flags.motor_friction, true)
            } else {
                Friction::new(&parameters.motor_friction, flags.motor_friction, true)
            },
            cable_stiffness_n_m: if flags.cable_drag {
                parameters.cable_stiffness_n_m
            } else {
                0.0
            },
            guides: Guides::new(parameters),
            bumpers: Bumpers::new(parameters),
            geometry: Geometry::new(parameters),
        }
    }

    /// Jacobian from (m/s, m/s, rad/s) to ring rates in rad/s while the pivots stay on their guides.
    pub fn jacobian(&self, guides: &[GuideState; AXES]) -> Result<Matrix3<f64>, OffGuide> {
        let mut jacobian = Matrix3::zeros();
        for (i, guide) in guides.iter().enumerate() {
            let lever_m = self.geometry.lever_m(i, guide)?;
            let row = guide.gap_by_pose() / -lever_m;
            jacobian.set_row(i, &row.transpose());
        }
        Ok(jacobian)
    }

    /// Mass matrix of body and rings for (x, y, theta), SI. The motors are apart, behind their springs.
    pub fn mass_matrix(&self, theta_rad: f64, jacobian: &Matrix3<f64>) -> Matrix3<f64> {
        self.body.mass_matrix(self.first_moment(theta_rad))
            + self.ring_inertia_kg_m2 * jacobian.tr_mul(jacobian)
    }

    fn first_moment(&self, theta_rad: f64) -> [f64; 2] {
        let (sin, cos) = <f64 as Scalar>::sin_cos(theta_rad);
        self.body.first_moment(sin, cos)
    }

    /// Voltages at the motors' terminals over a step that begins with this state.
    pub fn terminals_v(
        &self,
        state: &State,
        drives: &[Drive; AXES],
        worn: &External,
    ) -> [Option<f64>; AXES] {
        [0, 1, 2].map(|i| {
            let back_emf_v = self.torque_constant(i, state, worn) * state.motor_rad_s[i];
            (self.drive).terminal_v(drives[i], state.current_a[i], back_emf_v)
        })
    }

    fn torque_constant(&self, i: usize, state: &State, worn: &External) -> f64 {
        self.drive.torque_constant(state.motor_rad[i]) * (1.0 - worn.lost_torque[i])
    }

    /// Time derivative of the state. `step_s` is the length of the integration step that it is for.
    pub fn derivative(
        &self,
        state: &State,
        terminals_v: &[Option<f64>; AXES],
        external: &External,
        step_s: f64,
    ) -> Result<State, OffGuide> {
        let guides = self.geometry.guides(&state.pose, &state.ring_rad);
        let mut rate = State {
            pose: state.twist,
            ring_rad: state.ring_rad_s,
            motor_rad: state.motor_rad_s,
            ..State::zeros()
        };
        let moment_kg_m = self.first_moment(state.pose.z);
        let mut forces = self.outer_forces(state, moment_kg_m, external);
        for i in 0..AXES {
            let drive = (terminals_v[i], external);
            self.add_drive(i, state, drive, step_s, &mut forces, &mut rate);
            self.add_guide(i, &guides[i], state, step_s, &mut forces, &mut rate);
            if let Some(at_m) = external.guide_jammed_at_m[i] {
                let jam_n =
                    (self.guides).jam_n(&guides[i], &state.twist, state.ring_rad_s[i], at_m);
                forces.platform += jam_n * guides[i].rho_by_pose();
                forces.ring_n_m[i] += jam_n * guides[i].rho_by_ring_m();
            }
        }
        let body = self.body.mass_matrix(moment_kg_m);
        if self.guides.are_rigid() {
            self.accelerate_as_one(&guides, state, &body, &forces, &mut rate)?;
        } else {
            for (i, guide) in guides.iter().enumerate() {
                self.geometry.lever_m(i, guide)?;
            }
            rate.twist = solve_symmetric(&body, &forces.platform);
            rate.ring_rad_s = forces.ring_n_m / self.ring_inertia_kg_m2;
        }
        Ok(rate)
    }

    /// What acts from outside, and the body's own inertia.
    fn outer_forces(&self, state: &State, moment_kg_m: [f64; 2], external: &External) -> Forces {
        let body = (self.body).forces(moment_kg_m, state.twist.z, self.gravity_m_s2);
        let [x_n, y_n] = external.force_n;
        let mut ring_n_m = Vector3::from(external.ring_torque_n_m)
            + (self.bumpers).torques_n_m(&state.ring_rad, &state.ring_rad_s);
        for (i, jammed) in external.jammed_at_rad.iter().enumerate() {
            if let Some(at_rad) = jammed {
                ring_n_m[i] -= JAM_N_M_RAD * (state.ring_rad[i] - at_rad)
                    + JAM_N_M_S_RAD * state.ring_rad_s[i];
            }
        }
        let mut platform = body + Vector3::new(x_n, y_n, external.torque_n_m);
        if self.cable_stiffness_n_m > 0.0 {
            platform -= self.cable_stiffness_n_m * Vector3::new(state.pose.x, state.pose.y, 0.0);
        }
        Forces { platform, ring_n_m }
    }

    /// What the transmission of a drive passes on to its ring, N m, and its cyclic error there.
    pub fn transmission(&self, i: usize, state: &State, worn: &External) -> (f64, CyclicError) {
        let (motor_rad, motor_rad_s) = (state.motor_rad[i], state.motor_rad_s[i]);
        let error = self.drive.cyclic_error(i, motor_rad);
        let windup_rad = motor_rad - error.angle_rad - state.ring_rad[i];
        let loose_rad = worn.loose_rad[i];
        let taut_rad = windup_rad - windup_rad.clamp(-loose_rad, loose_rad);
        let transmitted_n_m = self.drive.transmitted_torque(
            taut_rad * (1.0 - worn.lost_stiffness[i]),
            motor_rad_s - error.slope * motor_rad_s - state.ring_rad_s[i],
        );
        (transmitted_n_m, error)
    }

    /// One drive: its current, its motor, and what it passes on to the ring; and the ring's friction.
    fn add_drive(
        &self,
        i: usize,
        state: &State,
        (terminal_v, external): (Option<f64>, &External),
        step_s: f64,
        forces: &mut Forces,
        rate: &mut State,
    ) {
        let (motor_rad, motor_rad_s) = (state.motor_rad[i], state.motor_rad_s[i]);
        let (transmitted_n_m, error) = self.transmission(i, state, external);
        let friction =
            (self.ring_friction).evaluate(state.ring_rad_s[i], state.bristle_rad[i], step_s);
        let more_n_m = external.more_friction_n_m[i] * state.ring_rad_s[i]
            / (state.ring_rad_s[i].abs() + MORE_FRICTION_RAD_S);
        forces.ring_n_m[i] += transmitted_n_m - friction.force - more_n_m;
        rate.bristle_rad[i] = friction.bristle_rate;
        let motor_friction = (self.motor_friction).evaluate_under_load(
            motor_rad_s,
            state.motor_bristle_rad[i],
            step_s,
            self.drive.gear_loss(transmitted_n_m),
        );
        rate.motor_bristle_rad[i] = motor_friction.bristle_rate;
        let current_a = state.current_a[i];
        let constant_n_m_a = self.torque_constant(i, state, external);
        let motor_n_m = (self.drive).motor_torque(constant_n_m_a, current_a, motor_rad);
        // What a gear that is not even passes on, it takes by the same ratio.
        let taken_n_m = transmitted_n_m - error.slope * transmitted_n_m;
        rate.motor_rad_s[i] =
            (self.drive).motor_acceleration(motor_n_m - taken_n_m - motor_friction.force);
        rate.current_a[i] = (self.drive).current_rate(
            terminal_v,
            current_a,
            constant_n_m_a * motor_rad_s,
            self.resistance_ohm[i],
        );
    }

    /// One guide, between platform and ring.
    fn add_guide(
        &self,
        i: usize,
        guide: &GuideState,
        state: &State,
        step_s: f64,
        forces: &mut Forces,
        rate: &mut State,
    ) {
        let guide_forces = self.guides.forces(
            guide,
            &state.twist,
            state.ring_rad_s[i],
            state.guide_bristle_m[i],
            step_s,
        );
        forces.platform += guide_forces.on_platform(guide);
        forces.ring_n_m[i] += guide_forces.on_ring_n_m(guide);
        rate.guide_bristle_m[i] = guide_forces.bristle_rate_m_s;
    }

    /// Accelerations while rigid guides tie platform and rings together.
    fn accelerate_as_one(
        &self,
        guides: &[GuideState; AXES],
        state: &State,
        body: &Matrix3<f64>,
        forces: &Forces,
        rate: &mut State,
    ) -> Result<(), OffGuide> {
        let jacobian = self.jacobian(guides)?;
        let mut bias_rad_s2 = Vector3::zeros();
        for (i, guide) in guides.iter().enumerate() {
            let gap_m_s2 = guide.gap_bias_m_s2(&state.twist, state.ring_rad_s[i]);
            bias_rad_s2[i] = -gap_m_s2 / self.geometry.lever_m(i, guide)?;
        }
        let inertial_n_m = forces.ring_n_m - self.ring_inertia_kg_m2 * bias_rad_s2;
        let mass = body + self.ring_inertia_kg_m2 * jacobian.tr_mul(&jacobian);
        let force = forces.platform + jacobian.tr_mul(&inertial_n_m);
        rate.twist = solve_symmetric(&mass, &force);
        rate.ring_rad_s = jacobian * rate.twist + bias_rad_s2;
        Ok(())
    }

    /// After a step: puts the pivots back on rigid guides, from which the integrator's error lets them stray.
    pub fn close_gaps(&self, state: &mut State) -> Result<(), OffGuide> {
        if !self.guides.are_rigid() {
            return Ok(());
        }
        let guides = self.geometry.guides(&state.pose, &state.ring_rad);
        for (i, guide) in guides.iter().enumerate() {
            if guide.gap_m.abs() > TORN_OFF_M {
                return Err(OffGuide { guide: i });
            }
            let lever_m = self.geometry.lever_m(i, guide)?;
            state.ring_rad[i] -= guide.gap_m / lever_m;
            state.ring_rad_s[i] = -guide.gap_by_pose().dot(&state.twist) / lever_m;
        }
        Ok(())
    }
}

/// Solves a symmetric 3x3 system by its adjugate. A mass matrix is positive definite, so the determinant never is zero.
fn solve_symmetric(matrix: &Matrix3<f64>, right: &Vector3<f64>) -> Vector3<f64> {
    let (a, b, c) = (matrix.column(0), matrix.column(1), matrix.column(2));
    let (bc, ca, ab) = (b.cross(&c), c.cross(&a), a.cross(&b));
    Vector3::new(bc.dot(right), ca.dot(right), ab.dot(right)) * (1.0 / a.dot(&bc))
}

//! The simulated machine: platform, guides, rings, transmissions and motors, between the bridges' terminals and the
//! encoders' discs.
//!
//! SI units throughout, f64, deterministic: no clock, no random number, and elementary functions from `libm`, so that a
//! trace is the same on every host. Each part stands in a file of its own; `dynamics.rs` ties them together.
//!
//! | file | idea |
//! |---|---|
//! | `parameters` | every number, with its origin |
//! | `imperfections` | which departures from an ideal machine are simulated |
//! | `state` | the state vector |
//! | `body` | platform and payload |
//! | `drive` | winding, motor, transmission |
//! | `pivot_geometry`, `built` | how a pivot, its ring and its guide are built; the reference stage's |
//! | `geometry`, `curves` | where a pivot lies on its guide, with every error of that; run-out and straightness |
//! | `guide` | a guide's forces: across it, along it, at its ends |
//! | `friction`, `stops`, `bumpers` | friction by bristles, of rings and of guides; ends of the guides; the carriages' bumpers |
//! | `contacts` | collisions, with their energy |
//! | `surroundings` | the floor's shaking, the warmth of windings and track |
//! | `dynamics` | the equations of motion |

mod body;
mod built;
mod bumpers;
mod contacts;
mod curves;
mod drive;
mod dynamics;
mod friction;
mod geometry;
mod guide;
mod imperfections;
mod parameters;
mod pivot_geometry;
mod state;
mod stops;
mod surroundings;

pub use body::Body;
pub use built::ENCODER_HARMONICS_RAD;
pub use bumpers::CARRIAGE_RAD;
pub use contacts::{CONTACTS, Contact};
pub use drive::{CyclicError, Drive, DriveModel};
pub use dynamics::External;
pub use friction::{Friction, FrictionState};
pub use geometry::{Geometry, GuideState, OffGuide};
pub use imperfections::{Imperfections, NAMED, Named};
pub use parameters::{
    FrictionParameters, GearParameters, Payload, PlantParameters, TrackParameters,
    WindingParameters,
};
pub use pivot_geometry::{AXES, PivotGeometry};
pub use stops::EndStops;

use dynamics::Dynamics;
use nalgebra::{Matrix3, Vector3};
use state::State;
use surroundings::Surroundings;

/// Why the plant stands still: its equations no longer hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Broken {
    /// A pivot cannot be on its guide at this pose: the platform was torn out of the guides.
    Unreachable {
        /// Last pose (m, m, rad).
        pose: [f64; 3],
        /// Which guide, 0 to 2.
        guide: usize,
    },
    /// A tooth of a gear has broken.
    Tooth {
        /// Which drive, 0 to 2.
        drive: usize,
        /// What the transmission passed on to its ring, N m.
        torque_n_m: f64,
    },
    /// A state is no longer finite: a force or a voltage that is not a number, or a step that is far too long.
    NotFinite,
}

/// The machine in motion.
#[derive(Clone, Debug)]
pub struct Plant {
    parameters: PlantParameters,
    dynamics: Dynamics,
    state: State,
    external: External,
    surroundings: Surroundings,
    broken: Option<Broken>,
}

impl Plant {
    /// A plant at rest in the centre of the track, theta = 0.
    #[must_use]
    pub fn new(parameters: PlantParameters) -> Self {
        let dynamics = Dynamics::new(&parameters);
        let mut plant = Self {
            parameters,
            dynamics,
            state: State::zeros(),
            external: External::default(),
            surroundings: Surroundings::new(&parameters),
            broken: None,
        };
        plant.set_pose_at_rest([0.0; 3]);
        plant
    }

    /// Puts the machine at rest, currentless, springs and bristles relaxed, at a pose (m, m, rad multi-turn).
    /// A pose that no pivots can take breaks the plant; any other mends it.
    pub fn set_pose_at_rest(&mut self, pose: [f64; 3]) {
        let pose = Vector3::from(pose);
        match self.dynamics.geometry.rings_rad(&pose) {
            Ok(ring_rad) => {
                self.broken = None;
                self.state = State::at_rest(pose, ring_rad);
                for i in 0..AXES {
                    // The motor's angle is the ring's and the error, which is that of the motor's angle: closer than a nanorad.
                    for _ in 0..3 {
                        let error = self.dynamics.drive.cyclic_error(i, self.state.motor_rad[i]);
                        self.state.motor_rad[i] = ring_rad[i] + error.angle_rad;
                    }
                }
            }
            Err(reason) => self.break_down(reason),
        }
    }

    /// Gives the machine a platform velocity (m/s, m/s, rad/s) with rings and motors following at the same rate.
    pub fn set_velocity(&mut self, velocity: [f64; 3]) {
        self.state.twist = Vector3::from(velocity);
        self.state.ring_rad_s = self.jacobian() * self.state.twist;
        self.state.motor_rad_s = self.state.ring_rad_s;
    }

    /// Pushes from outside until the next call.
    pub fn set_external(&mut self, external: External) {
        self.external = external;
    }

    /// Changes the supply that cuts voltages and against which currents die, V.
    pub fn set_supply_v(&mut self, supply_v: f64) {
        self.parameters.supply_v = supply_v;
        self.dynamics.drive.set_supply_v(supply_v);
    }

    /// Changes the load on the platform, which keeps its velocity.
    pub fn set_payload(&mut self, payload: Payload) {
        self.parameters.payload = payload;
        self.dynamics.body = Body::new(&self.parameters);
    }

    /// Integrates over `step_s` (3 to 16 us is what the parameters are made for) with constant drives: one classic
    /// Runge-Kutta step of fourth order. A broken plant stands still.
    pub fn step(&mut self, step_s: f64, drives: &[Drive; AXES]) {
        if self.broken.is_some() {
            return;
        }
        self.meet_surroundings(step_s);
        match self.runge_kutta(step_s, drives) {
            Ok(next) if next.is_finite() => {
                self.state = next;
                self.broken = self.broken_tooth();
            }
            Ok(_) => self.broken = Some(Broken::NotFinite),
            Err(reason) => self.break_down(reason),
        }
    }

    fn broken_tooth(&self) -> Option<Broken> {
        if !self.parameters.imperfections.tooth_limit {
            return None;
        }
        let most_n_m = self.parameters.gear.tooth_torque_n_m;
        (self.transmitted_n_m().into_iter().enumerate())
            .find(|(_, torque_n_m)| torque_n_m.abs() > most_n_m)
            .map(|(drive, torque_n_m)| Broken::Tooth { drive, torque_n_m })
    }

    /// What the surroundings are over the next step.
    fn meet_surroundings(&mut self, step_s: f64) {
        self.surroundings.step(step_s, self.state.current_a.into());
        let (floor, gravity) = (self.surroundings.floor_m_s2(), self.parameters.gravity_m_s2);
        let more = self.external.floor_m_s2;
        self.dynamics.gravity_m_s2 = [0, 1].map(|axis| gravity[axis] + (floor[axis] - more[axis]));
        self.dynamics.resistance_ohm = self.surroundings.resistance_ohm();
        if let Some(warmer_k) = self.surroundings.track_warmer_k() {
            self.dynamics.geometry.warm(warmer_k);
        }
    }

    /// Why the plant stands still, if it is broken.
    #[must_use]
    pub fn broken(&self) -> Option<Broken> {
        self.broken
    }

    /// The numbers it was built from.
    #[must_use]
    pub fn parameters(&self) -> &PlantParameters {
        &self.parameters
    }

    /// Platform pose: x (m), y (m), theta (rad, multi-turn).
    #[must_use]
    pub fn pose(&self) -> [f64; 3] {
        self.state.pose.into()
    }

    /// Platform velocity: m/s, m/s, rad/s.
    #[must_use]
    pub fn velocity(&self) -> [f64; 3] {
        self.state.twist.into()
    }

    /// Ring angles, rad, multi-turn.
    #[must_use]
    pub fn pivots_rad(&self) -> [f64; AXES] {
        self.state.ring_rad.into()
    }

    /// Ring rates, rad/s.
    #[must_use]
    pub fn pivot_rates_rad_s(&self) -> [f64; AXES] {
        self.state.ring_rad_s.into()
    }

    /// Places of the pivots on their guides, m from the platform's centre.
    #[must_use]
    pub fn rhos_m(&self) -> [f64; AXES] {
        self.guides().map(|guide| guide.rho_m)
    }

    /// How far the pivots have pushed their guides aside, m, to the guides' left. Rigid guides are not.
    #[must_use]
    pub fn gaps_m(&self) -> [f64; AXES] {
        self.guides().map(|guide| guide.gap_m)
    }

    /// Motor angles seen at the ring, rad, multi-turn.
    #[must_use]
    pub fn motors_rad(&self) -> [f64; AXES] {
        self.state.motor_rad.into()
    }

    /// Motor rates seen at the ring, rad/s.
    #[must_use]
    pub fn motor_rates_rad_s(&self) -> [f64; AXES] {
        self.state.motor_rad_s.into()
    }

    /// How much warmer the windings are than where their resistance was measured, K.
    #[must_use]
    pub const fn windings_warmer_k(&self) -> [f64; AXES] {
        self.surroundings.warmer_k()
    }

    /// How much warmer the track is than where its radius was measured, K; 0 where its warmth does nothing.
    #[must_use]
    pub fn track_warmer_k(&self) -> f64 {
        self.surroundings.track_warmer_k().unwrap_or_default()
    }

    /// Torques that the transmissions pass on to the rings, N m.
    #[must_use]
    pub fn transmitted_n_m(&self) -> [f64; AXES] {
        [0, 1, 2].map(|i| (self.dynamics.transmission(i, &self.state, &self.external)).0)
    }

    /// Winding currents, A.
    #[must_use]
    pub fn currents_a(&self) -> [f64; AXES] {
        self.state.current_a.into()
    }

    /// Jacobian from (m/s, m/s, rad/s) to ring rates (rad/s) where it stands.
    #[must_use]
    pub fn jacobian(&self) -> Matrix3<f64> {
        // A state was on its guides when it was taken over; NaN would show a broken invariant at once.
        (self.dynamics.jacobian(&self.guides())).unwrap_or_else(|_| Matrix3::repeat(f64::NAN))
    }

    /// Mass matrix of platform, payload and rings for (x, y, theta), SI, without the motors.
    #[must_use]
    pub fn mass_matrix(&self) -> Matrix3<f64> {
        self.dynamics
            .mass_matrix(self.state.pose.z, &self.jacobian())
    }

    /// Kinetic energy of platform, payload, rings and motors, J.
    #[must_use]
    pub fn kinetic_energy_j(&self) -> f64 {
        let State {
            twist,
            ring_rad_s,
            motor_rad_s,
            ..
        } = self.state;
        let body = (self.dynamics).mass_matrix(self.state.pose.z, &Matrix3::zeros());
        0.5 * twist.dot(&(body * twist))
            + 0.5 * self.parameters.ring_inertia_kg_m2 * ring_rad_s.norm_squared()
            + 0.5 * self.parameters.motor_inertia_kg_m2 * motor_rad_s.norm_squared()
    }

    /// Energy in the transmissions' springs, the guides, the bristles, the end stops and the bumpers, J.
    #[must_use]
    pub fn elastic_energy_j(&self) -> f64 {
        let state = &self.state;
        let guides = self.guides();
        let bumpers_j = self.dynamics.bumpers.energy_j(&state.ring_rad);
        let drives_j: f64 = (0..AXES)
            .map(|i| {
                let error = self.dynamics.drive.cyclic_error(i, state.motor_rad[i]);
                let windup_rad = state.motor_rad[i] - error.angle_rad - state.ring_rad[i];
                self.dynamics.drive.spring_energy_j(windup_rad)
                    + self.dynamics.ring_friction.energy_j(state.bristle_rad[i])
                    + (self.dynamics.motor_friction).energy_j(state.motor_bristle_rad[i])
                    + (self.dynamics.guides).energy_j(&guides[i], state.guide_bristle_m[i])
            })
            .sum();
        drives_j + bumpers_j
    }

    fn guides(&self) -> [GuideState; AXES] {
        (self.dynamics.geometry).guides(&self.state.pose, &self.state.ring_rad)
    }

    fn break_down(&mut self, OffGuide { guide }: OffGuide) {
        self.broken = Some(Broken::Unreachable {
            pose: self.state.pose.into(),
            guide,
        });
    }

    fn runge_kutta(&self, step_s: f64, drives: &[Drive; AXES]) -> Result<State, OffGuide> {
        let start = &self.state;
        let terminals_v = self.dynamics.terminals_v(start, drives, &self.external);
        let rate = |state: &State| {
            self.dynamics
                .derivative(state, &terminals_v, &self.external, step_s)
        };
        let first = rate(start)?;
        let second = rate(&start.plus(0.5 * step_s, &first))?;
        let third = rate(&start.plus(0.5 * step_s, &second))?;
        let fourth = rate(&start.plus(step_s, &third))?;
        let mut end = start
            .plus(step_s / 6.0, &first)
            .plus(step_s / 3.0, &second)
            .plus(step_s / 3.0, &third)
            .plus(step_s / 6.0, &fourth);
        for (i, &drive) in drives.iter().enumerate() {
            let (before_a, after_a) = (start.current_a[i], end.current_a[i]);
            end.current_a[i] = self.dynamics.drive.settle_current(drive, before_a, after_a);
        }
        self.dynamics.close_gaps(&mut end)?;
        Ok(end)
    }
}

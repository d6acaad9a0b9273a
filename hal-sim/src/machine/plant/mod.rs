//! The simulated machine: platform, guides, rings, transmissions and motors, between the bridges' terminals and the
//! encoders' discs.
//!
//! SI units throughout, f64, deterministic: no clock, no random number, and elementary functions from `libm`, so that a
//! trace is the same on every host. Each part stands in a file of its own; `dynamics.rs` ties them together.
//!
//! | file | idea |
//! |---|---|
//! | `parameters` | every number, with its origin; which imperfections are simulated |
//! | `state` | the state vector |
//! | `body` | platform and payload |
//! | `drive` | winding, motor, transmission |
//! | `friction`, `stops` | friction of a ring; ends of the guides |
//! | `dynamics` | the equations of motion |

mod body;
mod drive;
mod dynamics;
mod friction;
mod parameters;
mod state;
mod stops;

pub use body::Body;
pub use drive::{Drive, DriveModel};
pub use dynamics::External;
pub use friction::{Friction, FrictionState};
pub use parameters::{AXES, Imperfections, Payload, PlantParameters};
pub use stops::EndStops;

use dynamics::Dynamics;
use kinematics::InverseError;
use nalgebra::{Matrix3, Vector3};
use state::State;

/// Why the plant stands still: its equations no longer hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Broken {
    /// The platform was torn out of the guides: no pivot angles belong to this pose.
    Unreachable {
        /// Last pose (m, m, rad).
        pose: [f64; 3],
        /// What the inverse kinematics said.
        reason: InverseError,
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
            state: State {
                pose: Vector3::zeros(),
                twist: Vector3::zeros(),
                motor_rad: Vector3::zeros(),
                motor_rad_s: Vector3::zeros(),
                current_a: Vector3::zeros(),
                bristle_rad: Vector3::zeros(),
            },
            external: External::default(),
            broken: None,
        };
        plant.set_pose_at_rest([0.0; 3]);
        plant
    }

    /// Puts the machine at rest, currentless, springs and bristles relaxed, at a pose (m, m, rad multi-turn).
    /// A pose that no pivots can take breaks the plant; any other mends it.
    pub fn set_pose_at_rest(&mut self, pose: [f64; 3]) {
        let pose = Vector3::from(pose);
        match self.dynamics.inverse(&pose) {
            Ok(inverse) => {
                self.broken = None;
                self.state = State {
                    pose,
                    twist: Vector3::zeros(),
                    motor_rad: Vector3::from(inverse.pivots),
                    motor_rad_s: Vector3::zeros(),
                    current_a: Vector3::zeros(),
                    bristle_rad: Vector3::zeros(),
                };
            }
            Err(reason) => self.break_down(reason),
        }
    }

    /// Gives the machine a platform velocity (m/s, m/s, rad/s) with the motors following at the same rate.
    pub fn set_velocity(&mut self, velocity: [f64; 3]) {
        self.state.twist = Vector3::from(velocity);
        self.state.motor_rad_s = Vector3::from(self.pivot_rates_rad_s());
    }

    /// Pushes from outside until the next call.
    pub fn set_external(&mut self, external: External) {
        self.external = external;
    }

    /// Changes the supply that cuts voltages and against which currents die, V.
    pub fn set_supply_v(&mut self, supply_v: f64) {
        self.parameters.supply_v = supply_v;
        self.dynamics.drive = DriveModel::new(&self.parameters);
    }

    /// Integrates over `step_s` (10 to 15 us is what the parameters are made for) with constant drives: one classic
    /// Runge-Kutta step of fourth order. A broken plant stands still.
    pub fn step(&mut self, step_s: f64, drives: &[Drive; AXES]) {
        if self.broken.is_some() {
            return;
        }
        match self.runge_kutta(step_s, drives) {
            Ok(next) if next.is_finite() => self.state = next,
            Ok(_) => self.broken = Some(Broken::NotFinite),
            Err(reason) => self.break_down(reason),
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
        // The state was reachable when it was taken over; NaN would show a broken invariant at once.
        self.dynamics
            .inverse(&self.state.pose)
            .map_or([f64::NAN; AXES], |inverse| inverse.pivots)
    }

    /// Ring rates, rad/s.
    #[must_use]
    pub fn pivot_rates_rad_s(&self) -> [f64; AXES] {
        (self.jacobian() * self.state.twist).into()
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

    /// Winding currents, A.
    #[must_use]
    pub fn currents_a(&self) -> [f64; AXES] {
        self.state.current_a.into()
    }

    /// Jacobian from (m/s, m/s, rad/s) to ring rates (rad/s) where it stands.
    #[must_use]
    pub fn jacobian(&self) -> Matrix3<f64> {
        self.dynamics.inverse(&self.state.pose).map_or_else(
            |_| Matrix3::repeat(f64::NAN),
            |inverse| self.dynamics.jacobian(&inverse.guides),
        )
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
        let twist = self.state.twist;
        0.5 * twist.dot(&(self.mass_matrix() * twist))
            + 0.5 * self.parameters.motor_inertia_kg_m2 * self.state.motor_rad_s.norm_squared()
    }

    /// Energy in the transmissions' springs, the bristles and the end stops, J.
    #[must_use]
    pub fn elastic_energy_j(&self) -> f64 {
        let Ok(inverse) = self.dynamics.inverse(&self.state.pose) else {
            return f64::NAN;
        };
        (0..AXES)
            .map(|i| {
                self.dynamics
                    .drive
                    .spring_energy_j(self.state.motor_rad[i] - inverse.pivots[i])
                    + self.dynamics.friction.energy_j(self.state.bristle_rad[i])
                    + self.dynamics.stops.energy_j(&inverse.guides[i])
            })
            .sum()
    }

    fn break_down(&mut self, reason: InverseError) {
        self.broken = Some(Broken::Unreachable {
            pose: self.state.pose.into(),
            reason,
        });
    }

    fn runge_kutta(&self, step_s: f64, drives: &[Drive; AXES]) -> Result<State, InverseError> {
        let rate = |state: &State| {
            self.dynamics
                .derivative(state, drives, &self.external, step_s)
        };
        let start = &self.state;
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
        Ok(end)
    }
}

//! A tour of a simulated machine, and the same of a body in closed form.

use super::machine::{Machine, TIMING, Want};
use commissioning::platform::{Evaluation, Tour};
use hal_sim::machine::devices::StageParameters;
use kinematics::{Pose, inverse};
use std::f64::consts::TAU;

pub const EVALUATION: Evaluation = Evaluation {
    track_radius_m: 0.1,
    smoothing_s: 0.005,
    gear_ratio: 50.0,
    presliding: 2e-4,
};
/// How fast it turns meanwhile.
const RATE_RAD_S: f64 = 0.9;
/// Ticks a sample, which is the mean of them: of angles and of currents alike, so that both are of the same instant.
const EVERY: usize = 10;

/// A pose of the tour: once round at 45 mm while it turns, shaken along x, y and theta.
fn pose(time_s: f64) -> [f64; 3] {
    let from = (time_s / 0.5).min(1.0);
    let out = 0.45 * from * (TAU * 0.23 * time_s).sin();
    let shake = |hz: f64| from * (TAU * hz * time_s).sin();
    [
        out * (TAU * 0.11 * time_s).cos() + 0.08 * shake(3.1),
        out * (TAU * 0.11 * time_s).sin() + 0.08 * shake(2.3),
        RATE_RAD_S * time_s * from + 0.10 * shake(3.7),
    ]
}

pub fn pivots(pose: [f64; 3]) -> [f64; 3] {
    let [x, y, theta] = pose;
    inverse(&Pose { x, y, theta }).expect("inside").pivots
}

pub fn drive(parameters: &StageParameters, seconds: f64) -> Tour {
    let mut machine = Machine::at(parameters, [0.0; 3]);
    machine.gains = [8.0, 400.0];
    let zero = machine.angle_rad;
    let start = pivots([0.0; 3]);
    let plant = &parameters.plant;
    let constant = plant.gear_ratio * plant.torque_constant_n_m_a;
    let mut tour = Tour {
        step_s: TIMING.tick_s * EVERY as f64,
        angle_rad: Default::default(),
        torque_n_m: Default::default(),
    };
    let mut sums = [[0.0; 2]; 3];
    for tick in 0..(seconds / TIMING.tick_s) as usize {
        let at = |tick: usize| pivots(pose(tick as f64 * TIMING.tick_s));
        let (now, next) = (at(tick), at(tick + 1));
        let wants = [0, 1, 2].map(|i| Want {
            angle_rad: zero[i] + now[i] - start[i],
            rate_rad_s: (next[i] - now[i]) / TIMING.tick_s,
        });
        machine.servo_tick(wants, [0.0; 3], None);
        for (i, [current, angle]) in sums.iter_mut().enumerate() {
            *current += machine.current_a[i] / EVERY as f64;
            *angle += machine.angle_rad[i] / EVERY as f64;
        }
        if tick % EVERY == EVERY - 1 {
            for i in 0..3 {
                tour.angle_rad[i].push(sums[i][1] - zero[i] + start[i]);
                tour.torque_n_m[i].push(constant * sums[i][0]);
            }
            sums = [[0.0; 2]; 3];
        }
    }
    tour
}

/// Torques of a rigid body on rings without friction, by Lagrange's equations from its kinetic energy alone: derivatives by differences, the
/// Jacobian from the positions. Nothing of it is the fit's.
pub struct Body {
    pub mass_kg: f64,
    pub centre_m: [f64; 2],
    /// About its own centre.
    pub inertia_kg_m2: f64,
    pub ring_kg_m2: f64,
}

impl Body {
    fn energy_j(&self, q: [f64; 3], rate: [f64; 3]) -> f64 {
        let (sin, cos) = q[2].sin_cos();
        let [x, y] = self.centre_m;
        let (arm_x, arm_y) = (x * cos - y * sin, x * sin + y * cos);
        let v = [
            0.1 * rate[0] - arm_y * rate[2],
            0.1 * rate[1] + arm_x * rate[2],
        ];
        0.5 * self.mass_kg * (v[0] * v[0] + v[1] * v[1])
            + 0.5 * self.inertia_kg_m2 * rate[2] * rate[2]
    }

    /// Slopes of the energy by q (`of_rate` false) or by its rate.
    fn slopes(&self, q: [f64; 3], rate: [f64; 3], of_rate: bool) -> [f64; 3] {
        [0, 1, 2].map(|k| {
            let at = |by: f64| {
                let (mut q, mut rate) = (q, rate);
                if of_rate {
                    rate[k] += by
                } else {
                    q[k] += by
                }
                self.energy_j(q, rate)
            };
            (at(1e-5) - at(-1e-5)) / 2e-5
        })
    }

    fn torques(&self, time_s: f64) -> [f64; 3] {
        let step = 1e-4;
        let rate = |time: f64| {
            [0, 1, 2].map(|k| (pose(time + step)[k] - pose(time - step)[k]) / (2.0 * step))
        };
        let momentum = |time: f64| self.slopes(pose(time), rate(time), true);
        let (after, before, by_place) = (
            momentum(time_s + step),
            momentum(time_s - step),
            self.slopes(pose(time_s), rate(time_s), false),
        );
        let force = nalgebra::Vector3::from(
            [0, 1, 2].map(|k| (after[k] - before[k]) / (2.0 * step) - by_place[k]),
        );
        let jacobian = nalgebra::Matrix3::from_fn(|i, k| {
            let at = |by: f64| {
                let mut q = pose(time_s);
                q[k] += by;
                pivots(q)[i]
            };
            (at(1e-6) - at(-1e-6)) / 2e-6
        });
        let carried = jacobian
            .transpose()
            .try_inverse()
            .expect("no singular place")
            * force;
        let ring = |i: usize| {
            (pivots(pose(time_s + step))[i] - 2.0 * pivots(pose(time_s))[i]
                + pivots(pose(time_s - step))[i])
                / (step * step)
        };
        [0, 1, 2].map(|i| carried[i] + self.ring_kg_m2 * ring(i))
    }

    pub fn tour(&self) -> Tour {
        let times: Vec<f64> = (1_200..16_000).map(|k| f64::from(k) * 5e-4).collect();
        let torques: Vec<_> = times.iter().map(|&time| self.torques(time)).collect();
        Tour {
            step_s: 5e-4,
            angle_rad: [0, 1, 2].map(|i| times.iter().map(|&time| pivots(pose(time))[i]).collect()),
            torque_n_m: [0, 1, 2].map(|i| torques.iter().map(|torque| torque[i]).collect()),
        }
    }
}

pub const BODY: Body = Body {
    mass_kg: 6.3,
    centre_m: [0.012, -0.007],
    inertia_kg_m2: 0.031,
    ring_kg_m2: 0.024,
};

//! What simulated machines carry, from a tour; and a body in closed form.

mod machine;

use commissioning::platform::{Evaluation, Platform, PlatformError, Tour, platform};
use hal_sim::machine::devices::StageParameters;
use kinematics::{Pose, inverse};
use machine::{Machine, TIMING, Want, unknown};
use std::f64::consts::TAU;

const EVALUATION: Evaluation = Evaluation {
    track_radius_m: 0.1,
    smoothing_s: 0.02,
    drive_inertia: None,
    presliding: [1e-4, 2e-4],
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

fn pivots(pose: [f64; 3]) -> [f64; 3] {
    let [x, y, theta] = pose;
    inverse(&Pose { x, y, theta }).expect("inside").pivots
}

fn drive(parameters: &StageParameters, seconds: f64) -> Tour {
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
                tour.torque_n_m[i].push(constant * sums[i][0] / parameters.analog.current_gain[i]);
            }
            sums = [[0.0; 2]; 3];
        }
    }
    tour
}

#[test]
fn what_unknown_machines_carry() {
    let mut off = [const { Vec::new() }; 4];
    for seed in 0..4 {
        let parameters = unknown(seed);
        let tour = drive(&parameters, 9.0);
        let found = platform(&tour, &EVALUATION).expect("a platform");
        let plant = &parameters.plant;
        let payload = &plant.payload;
        let mass = plant.platform_mass_kg + payload.mass_kg;
        let inertia = plant.platform_inertia_kg_m2
            + payload.inertia_kg_m2
            + payload.mass_kg * payload.eccentricity_m.powi(2);
        let (sin, cos) = payload.direction_rad.sin_cos();
        let centre = [cos, sin].map(|part| part * payload.mass_kg * payload.eccentricity_m / mass);
        off[0].push((found.mass_kg / mass - 1.0).abs());
        off[1].push((found.inertia_kg_m2 / inertia - 1.0).abs());
        off[2].push(
            (found.drive_inertia / (plant.motor_inertia_kg_m2 + plant.ring_inertia_kg_m2) - 1.0)
                .abs(),
        );
        let [x, y] = found.moment_kg_m.map(|moment| moment / found.mass_kg);
        off[3].push(1e3 * (x - centre[0]).hypot(y - centre[1]));
    }
    let figures = [
        ("mass", 0.0046, 0.0058),
        ("inertia", 0.010, 0.027),
        ("motor and ring", 0.0095, 0.011),
        ("centre of mass, mm", 0.14, 0.23),
    ];
    for ((name, median, worst), off) in figures.into_iter().zip(&mut off) {
        off.sort_by(f64::total_cmp);
        println!(
            "{name}: median {:.4}, worst {:.4}",
            off[off.len() / 2],
            off[off.len() - 1]
        );
        assert!(
            off[off.len() / 2] < median && off[off.len() - 1] < worst,
            "{name}"
        );
    }
}

/// Torques of a rigid body on rings without friction, by Lagrange's equations from its kinetic energy alone: derivatives by differences, the
/// Jacobian from the positions. Nothing of it is the fit's.
struct Body {
    mass_kg: f64,
    centre_m: [f64; 2],
    /// About its own centre.
    inertia_kg_m2: f64,
    ring_kg_m2: f64,
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

    fn tour(&self) -> Tour {
        let times: Vec<f64> = (1_200..16_000).map(|k| f64::from(k) * 5e-4).collect();
        let torques: Vec<_> = times.iter().map(|&time| self.torques(time)).collect();
        Tour {
            step_s: 5e-4,
            angle_rad: [0, 1, 2].map(|i| times.iter().map(|&time| pivots(pose(time))[i]).collect()),
            torque_n_m: [0, 1, 2].map(|i| torques.iter().map(|torque| torque[i]).collect()),
        }
    }
}

const BODY: Body = Body {
    mass_kg: 6.3,
    centre_m: [0.012, -0.007],
    inertia_kg_m2: 0.031,
    ring_kg_m2: 0.024,
};

fn is_right(found: &Platform) {
    let Body {
        mass_kg,
        centre_m: [x, y],
        inertia_kg_m2,
        ring_kg_m2,
    } = BODY;
    let about_centre = inertia_kg_m2 + mass_kg * (x * x + y * y);
    assert!((found.mass_kg / mass_kg - 1.0).abs() < 2e-3, "{found:?}");
    // Smoothing a tour that turns costs a little.
    assert!(
        (found.inertia_kg_m2 / about_centre - 1.0).abs() < 4e-3,
        "{found:?}"
    );
    assert!(
        (found.drive_inertia / ring_kg_m2 - 1.0).abs() < 2e-3,
        "{found:?}"
    );
    assert!(
        (found.moment_kg_m[0] / (mass_kg * x) - 1.0).abs() < 1e-2,
        "{found:?}"
    );
    assert!(
        (found.moment_kg_m[1] / (mass_kg * y) - 1.0).abs() < 1e-2,
        "{found:?}"
    );
    assert!(found.guide_n.abs() < 0.01 && found.friction[0].abs() < 1e-3);
}

#[test]
fn a_body_by_lagrange_is_found_again() {
    let tour = BODY.tour();
    is_right(&platform(&tour, &EVALUATION).expect("a platform"));
    is_right(
        &platform(
            &tour,
            &Evaluation {
                drive_inertia: Some(BODY.ring_kg_m2),
                ..EVALUATION
            },
        )
        .expect("a platform"),
    );
}

#[test]
fn tours_that_tell_nothing_are_refused() {
    let tour = BODY.tour();
    let mut short = tour.clone();
    short.torque_n_m[1].pop();
    assert_eq!(platform(&short, &EVALUATION), Err(PlatformError::Lengths));
    // Always in the same place: nothing moves, and nothing follows.
    let mut still = tour.clone();
    for angles in &mut still.angle_rad {
        let first = angles[0];
        angles.fill(first);
    }
    assert!(matches!(
        platform(&still, &EVALUATION),
        Err(PlatformError::Condition { .. })
    ));
    // Shaken in the middle alone: mass, inertia and rings are the same there.
    let mut middle = tour.clone();
    for (sample, time) in (1_200..16_000).map(|k| f64::from(k) * 5e-4).enumerate() {
        let shake = |hz: f64| (TAU * hz * time).sin();
        let angles = pivots([
            0.005 * shake(3.1),
            0.005 * shake(2.3),
            2.0 * time + 0.1 * shake(3.7),
        ]);
        for (all, angle) in middle.angle_rad.iter_mut().zip(angles) {
            all[sample] = angle;
        }
    }
    let refused = platform(&middle, &EVALUATION);
    assert!(
        matches!(refused, Err(PlatformError::Condition { condition }) if condition < 1e6),
        "{refused:?}"
    );
    // A pivot whose torque is told with the wrong sign.
    let mut reversed = tour.clone();
    reversed.torque_n_m[2]
        .iter_mut()
        .for_each(|torque| *torque = -*torque);
    assert!(matches!(
        platform(&reversed, &EVALUATION),
        Err(PlatformError::Residual { .. })
    ));
}

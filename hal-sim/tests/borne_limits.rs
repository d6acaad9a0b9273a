//! Limits of motion that the drives are told to bear, against the currents that the plant's own mass matrix asks for: never more in any
//! plan, and more than that a little beyond.

use firmware::control::servo::{BorneLimits, largest_limits};
use firmware::motion::{AxisState, Constraints, Plan, RotationCentre, Stop, plan_line, plan_stop};
use firmware::parameters::{Parameters, Platform};
use hal_sim::machine::plant::{Payload, Plant, PlantParameters};
use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

const RADIUS_M: f64 = 0.1;
/// Units of a position, and of an [`AxisState`], in a track radius or a turn.
const UNIT: f64 = 4_294_967_296.0;
const AXIS_UNIT: f64 = UNIT * 1_099_511_627_776.0;
/// Share of the current limit that plans may ask for, and what a hot winding has more of.
const PLANNED: f64 = 0.95;
const HOT: f64 = 1.4;
/// Between two of the places that the controller looks at.
const BETWEEN: f64 = 1.02;

/// The plant's rings and body; its motors are with the rings, and nothing gives way.
struct Machine {
    plant: Plant,
}

/// Pose, velocity and acceleration in SI.
#[derive(Clone, Copy, Debug)]
struct Motion {
    q: Vector3<f64>,
    v: Vector3<f64>,
    a: Vector3<f64>,
}

impl Machine {
    fn new(parameters: &Parameters) -> Self {
        let platform = &parameters.platform;
        let [x, y] = platform.payload_centre_mm.map(|mm| mm * 1e-3);
        let plant = PlantParameters {
            platform_mass_kg: platform.mass_kg,
            platform_inertia_kg_m2: platform.inertia_kg_m2,
            payload: Payload {
                mass_kg: platform.payload_kg,
                inertia_kg_m2: platform.payload_inertia_kg_m2,
                eccentricity_m: x.hypot(y),
                direction_rad: y.atan2(x),
            },
            ring_inertia_kg_m2: parameters.drives[0].inertia_kg_m2,
            motor_inertia_kg_m2: 1e-9,
            ..PlantParameters::REFERENCE
        };
        Self {
            plant: Plant::new(plant),
        }
    }

    /// Mass matrix and Jacobian at a pose.
    fn at(&mut self, q: &Vector3<f64>) -> (Matrix3<f64>, Matrix3<f64>) {
        self.plant.set_pose_at_rest((*q).into());
        (self.plant.mass_matrix(), self.plant.jacobian())
    }

    /// Rates and accelerations of the pivots, and the torques that they give: Lagrange's equation, `d/dt (M v) - 1/2 d(v M v)/dq`, by
    /// differences.
    fn torques(&mut self, motion: &Motion) -> [Vector3<f64>; 3] {
        const STEP: f64 = 1e-5;
        let Motion { q, v, a } = motion;
        let (mass, jacobian) = self.at(q);
        let scale = Vector3::new(RADIUS_M, RADIUS_M, 1.0);
        let mut along = [Matrix3::zeros(), Matrix3::zeros()];
        let mut energy_change = Vector3::zeros();
        for k in 0..3 {
            let mut step = Vector3::zeros();
            step[k] = STEP * scale[k];
            let (more, less) = (self.at(&(q + step)), self.at(&(q - step)));
            let over = 1.0 / (2.0 * step[k]);
            let mass_change = (more.0 - less.0) * over;
            along[0] += mass_change * v[k];
            along[1] += (more.1 - less.1) * over * v[k];
            energy_change[k] = 0.5 * v.dot(&(mass_change * v));
        }
        let force = mass * a + along[0] * v - energy_change;
        let back = jacobian.try_inverse().expect("inside the track");
        [
            jacobian * v,
            jacobian * a + along[1] * v,
            back.tr_mul(&force),
        ]
    }

    /// The motion whose pivots have these accelerations.
    fn with_pivots(&mut self, q: Vector3<f64>, v: Vector3<f64>, pivots: Vector3<f64>) -> Motion {
        let rest = Motion {
            q,
            v,
            a: Vector3::zeros(),
        };
        let [_, bias, _] = self.torques(&rest);
        let back = self.at(&q).1.try_inverse().expect("inside the track");
        Motion {
            a: back * (pivots - bias),
            ..rest
        }
    }
}

/// Parts of what the motors may be asked for: of their current, and of what the supply gives beside it; over 1 is too much.
fn asked(parameters: &Parameters, machine: &mut Machine, motion: &Motion, limit_a: f64) -> f64 {
    let [rates, _, torques] = machine.torques(motion);
    let mut most = 0.0_f64;
    for (i, drive) in parameters.drives.iter().enumerate() {
        let constant = drive.torque_constant_n_m_a * drive.gear_ratio;
        let friction = drive.coulomb_n_m * rates[i].signum() + drive.viscous_n_m_s * rates[i];
        let current_a = (torques[i] + friction) / constant;
        let left_v = parameters.power.supply_v * 0.98 - constant * rates[i].abs();
        let drives = current_a * rates[i] > 0.0;
        let by_volts = current_a.abs() * HOT * drive.resistance_ohm / left_v;
        most = most.max(current_a.abs() / limit_a);
        if drives {
            most = most.max(if left_v > 0.0 {
                by_volts
            } else {
                f64::INFINITY
            });
        }
    }
    most
}

/// The platform's motion where its point `centre` moves as the axes do.
fn motion_of(axes: &[AxisState; 3], centre: [f64; 2], hz: f64) -> Motion {
    let theta = (axes[2].position >> 40) as i32 as f64 / UNIT * TAU;
    let (sin, cos) = theta.sin_cos();
    let unit = [RADIUS_M, RADIUS_M, TAU];
    let v = [0, 1, 2].map(|i| axes[i].velocity as f64 / AXIS_UNIT * hz * unit[i]);
    let a = [0, 1, 2].map(|i| axes[i].acceleration as f64 / AXIS_UNIT * hz * hz * unit[i]);
    let at = [0, 1].map(|i| axes[i].position as f64 / AXIS_UNIT * RADIUS_M);
    let [p, q] = centre.map(|radii| radii * RADIUS_M);
    let arm = [p * cos - q * sin, p * sin + q * cos];
    let square = v[2] * v[2];
    Motion {
        q: Vector3::new(at[0] - arm[0], at[1] - arm[1], theta),
        v: Vector3::new(v[0] + v[2] * arm[1], v[1] - v[2] * arm[0], v[2]),
        a: Vector3::new(
            a[0] + a[2] * arm[1] + square * arm[0],
            a[1] - a[2] * arm[0] + square * arm[1],
            a[2],
        ),
    }
}

prop_compose! {
    /// Machines with limits of motion that nobody has thought of, from gentle ones to such as no motor bears.
    fn machines()(
        payload_kg in prop_oneof![Just(0.0), 0.0..8.0_f64],
        payload_inertia_kg_m2 in 0.0..0.05_f64,
        centre_mm in [-40.0..40.0_f64, -40.0..40.0],
        current_limit_a in 4.0..7.0_f64,
        supply_v in 40.0..52.0_f64,
        ring in 0.8..1.3_f64,
        motor in 0.8..1.2_f64,
        rate in 4.0..16.0_f64,
        acceleration in prop_oneof![50.0..400.0_f64, Just(2_000.0)],
        stop_s in 0.01..0.1_f64,
        [speed, turn] in [0.3..2.0_f64, 0.3..2.0],
        hard in 1.0..8.0_f64,
    ) -> Parameters {
        let mut parameters = Parameters::REFERENCE;
        parameters.platform = Platform { payload_kg, payload_inertia_kg_m2, payload_centre_mm: centre_mm, ..parameters.platform };
        parameters.power.current_limit_a = current_limit_a;
        parameters.power.supply_v = supply_v;
        for drive in &mut parameters.drives {
            drive.inertia_kg_m2 *= ring;
            drive.torque_constant_n_m_a *= motor;
        }
        let limits = &mut parameters.limits;
        limits.pivot_rate_rad_s = rate;
        limits.pivot_acceleration_rad_s2 = acceleration;
        limits.speed_mm_s *= speed;
        limits.turn_speed_deg_s *= turn;
        limits.acceleration_mm_s2 *= hard;
        limits.turn_acceleration_deg_s2 *= hard;
        limits.jerk_mm_s3 *= hard;
        limits.turn_jerk_deg_s3 *= hard;
        parameters.supervision.stop_s = stop_s;
        parameters
    }
}

fn borne(parameters: &Parameters) -> Parameters {
    BorneLimits::new(parameters).applied_to(parameters)
}

/// A place of the platform in the disk.
fn place([r, direction, turn]: [f64; 3]) -> [f64; 3] {
    let r = 0.8 * r.sqrt();
    [r * direction.cos(), r * direction.sin(), turn / TAU]
}

fn settings(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(18),
        ..ProptestConfig::default()
    }
}

/// The states of a line and of an urgent stop out of it.
fn states(from: [f64; 3], to: [f64; 3], at: f64, constraints: &Constraints) -> Vec<[AxisState; 3]> {
    let centre = RotationCentre::new(constraints.rotation_centre).expect("near");
    let [from, to] = [from, to].map(|at| centre.from_platform(&at.map(|at| (at * UNIT) as i64)));
    let Ok(line) = plan_line(7, from, to, constraints) else {
        return Vec::new();
    };
    let start = from.map(AxisState::at_rest);
    let at = (at * line.ticks() as f64) as u64;
    let mut all = several(&line, &start, 60);
    if let Some(stop) = plan_stop(8, &line, &start, at, constraints, Stop::Urgent) {
        all.extend(several(&stop, &line.state_after(&start, at), 60));
    }
    all
}

fn several(plan: &Plan, start: &[AxisState; 3], count: u64) -> Vec<[AxisState; 3]> {
    let ticks = plan.ticks();
    (0..=count)
        .map(|k| plan.state_after(start, ticks * k / count))
        .collect()
}

proptest! {
    #![proptest_config(settings(400))]

    /// Lines and urgent stops, with the platform's centre moved.
    #[test]
    fn no_plan_asks_for_more(
        parameters in machines(), ends in [[0.0..1.0_f64, -PI..PI, -PI..PI], [0.0..1.0, -PI..PI, -PI..PI]], at in 0.0..1.0_f64,
    ) {
        let parameters = borne(&parameters);
        let constraints = Constraints::new(parameters.limits, parameters.geometry);
        let mut machine = Machine::new(&parameters);
        for axes in states(place(ends[0]), place(ends[1]), at, &constraints) {
            let motion = motion_of(&axes, [0.0; 2], parameters.limits.rate_hz);
            let part = asked(&parameters, &mut machine, &motion, PLANNED * parameters.power.current_limit_a);
            prop_assert!(part < BETWEEN, "{part} {motion:?}");
        }
    }

    /// With any other point moved: what the platform's speed asks for then is in the reserve.
    #[test]
    fn no_plan_about_another_point_reaches_the_limit(
        parameters in machines(), ends in [[0.0..1.0_f64, -PI..PI, -PI..PI], [0.0..1.0, -PI..PI, -PI..PI]], at in 0.0..1.0_f64,
        (r, direction) in (0.0..0.6_f64, -PI..PI),
    ) {
        let mut parameters = borne(&parameters);
        parameters.limits.speed_mm_s = parameters.limits.speed_mm_s.min(200.0);
        parameters.limits.turn_speed_deg_s = parameters.limits.turn_speed_deg_s.min(360.0);
        let mut constraints = Constraints::new(parameters.limits, parameters.geometry);
        let centre = RotationCentre::new([r * direction.cos(), r * direction.sin()]).expect("near").point();
        constraints.rotation_centre = centre;
        let mut machine = Machine::new(&parameters);
        for axes in states(place(ends[0]), place(ends[1]), at, &constraints) {
            let motion = motion_of(&axes, centre, parameters.limits.rate_hz);
            let part = asked(&parameters, &mut machine, &motion, parameters.power.current_limit_a);
            prop_assert!(part < BETWEEN, "{part} {motion:?}");
        }
    }
}

/// A motion at the edge: where, the direction of the platform's speed, whether and which way pivots are accelerated.
fn at_the_edge(
    machine: &mut Machine,
    parameters: &Parameters,
    [place, direction]: [f64; 2],
    speed: f64,
    pivots: Vector3<f64>,
) -> Motion {
    let limits = &parameters.limits;
    let q = Vector3::new(0.08 * place.cos(), 0.08 * place.sin(), 0.0);
    let v = Vector3::new(
        limits.speed_mm_s * 1e-3 * direction.cos(),
        limits.speed_mm_s * 1e-3 * direction.sin(),
        limits.turn_speed_deg_s.to_radians(),
    );
    let fastest = (machine.at(&q).1 * v).amax();
    let v = v * (speed * (limits.pivot_rate_rad_s / fastest).min(1.0));
    machine.with_pivots(q, v, pivots)
}

proptest! {
    #![proptest_config(settings(12))]

    /// 15 % more acceleration than is borne is too much somewhere at the edge, and so is a stop of a fault that is shorter by a fifth: the
    /// friction that helps it is not counted.
    #[test]
    fn what_is_borne_is_no_less_than_it_has_to_be(parameters in machines()) {
        let mut wanted = parameters.clone();
        wanted.limits.pivot_acceleration_rad_s2 = 2_000.0;
        wanted.supervision.stop_s = 0.01;
        // Fast enough for every pivot to reach its rate, at which the supply leaves enough: all pivots are looked at with that rate, which
        // not all of them have at once.
        wanted.limits.turn_speed_deg_s = 1_000.0;
        let [rate, _] = largest_limits(&wanted);
        wanted.limits.pivot_rate_rad_s = wanted.limits.pivot_rate_rad_s.min(0.8 * rate);
        let wanted = borne(&wanted);
        let mut machine = Machine::new(&wanted);
        let [_, largest] = largest_limits(&wanted);
        let acceleration = wanted.limits.pivot_acceleration_rad_s2;
        prop_assert!((acceleration / largest - 1.0).abs() < 1e-3);
        let limit_a = wanted.power.current_limit_a;
        let (mut planned, mut stopped) = (0.0_f64, 0.0_f64);
        for case in 0..24 * 8 * 8 * 2 {
            let [place, direction, signs, back] = [case % 24, case / 24 % 8, case / 192 % 8, case / 1536];
            let at = [f64::from(place) * TAU / 24.0, f64::from(direction) * TAU / 8.0];
            let signs = Vector3::from([1, 2, 4].map(|bit| if signs & bit == 0 { 1.0 } else { -1.0 }));
            let speed = if back == 0 { 1.0 } else { -1.0 };
            let mut motion = |more: f64| at_the_edge(&mut machine, &wanted, at, speed, signs * acceleration * more);
            let [over, full] = [motion(1.15), motion(1.0)];
            planned = planned.max(asked(&wanted, &mut machine, &over, PLANNED * limit_a));
            for instant in 1..10 {
                stopped = stopped.max(in_stop(&wanted, &mut machine, &full, 0.05 * f64::from(instant), 0.8));
            }
        }
        prop_assert!(planned > 1.0, "{planned}");
        prop_assert!(stopped > 1.0 || wanted.supervision.stop_s <= 0.01, "{stopped}");
    }
}

/// What a fault's stop out of a motion asks for, a part of it over, when it is as long as that much of what it should be.
fn in_stop(
    parameters: &Parameters,
    machine: &mut Machine,
    motion: &Motion,
    u: f64,
    share: f64,
) -> f64 {
    let rate = 1.0 - u * u * (3.0 - 2.0 * u);
    let change = -6.0 * u * (1.0 - u) / (share * parameters.supervision.stop_s);
    let slowed = Motion {
        q: motion.q,
        v: motion.v * rate,
        a: motion.a * (rate * rate) + motion.v * change,
    };
    asked(
        parameters,
        machine,
        &slowed,
        parameters.power.current_limit_a,
    )
}

proptest! {
    #![proptest_config(settings(400))]

    /// A fault in the middle of a line or of an urgent stop.
    #[test]
    fn no_stop_of_a_fault_reaches_the_limit(
        parameters in machines(), ends in [[0.0..1.0_f64, -PI..PI, -PI..PI], [0.0..1.0, -PI..PI, -PI..PI]], at in 0.0..1.0_f64, u in 0.0..1.0_f64,
    ) {
        let parameters = borne(&parameters);
        let constraints = Constraints::new(parameters.limits, parameters.geometry);
        let mut machine = Machine::new(&parameters);
        for axes in states(place(ends[0]), place(ends[1]), at, &constraints) {
            let motion = motion_of(&axes, [0.0; 2], parameters.limits.rate_hz);
            let part = in_stop(&parameters, &mut machine, &motion, u, 1.0);
            prop_assert!(part < BETWEEN, "{part} {motion:?}");
        }
    }

    /// What is proposed is taken.
    #[test]
    fn what_is_proposed_is_borne(parameters in machines()) {
        let proposed = borne(&parameters);
        let again = BorneLimits::new(&proposed);
        prop_assert_eq!(again.excess(&proposed), 1.0, "{:?}", again);
        let limits = &proposed.limits;
        prop_assert!(limits.pivot_rate_rad_s <= parameters.limits.pivot_rate_rad_s);
        prop_assert!(limits.pivot_acceleration_rad_s2 <= parameters.limits.pivot_acceleration_rad_s2);
        prop_assert!(proposed.supervision.stop_s >= parameters.supervision.stop_s);
    }
}

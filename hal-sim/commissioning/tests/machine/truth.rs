//! What a machine is, from the simulator's own numbers and matrices, against what was found.

use super::steady::{KNEE_A, all_rates};
use super::{Excited, Machine, PLAN, Plan, TIMING, WEAKER, excite};
use commissioning::chain::{Chain, Place};
use commissioning::drive_model::{DriveModel, Electrical, Guess, Known, Responses, drive_model};
use commissioning::frequency_response::{Line, frequency_response};
use commissioning::friction::friction;
use hal_sim::machine::devices::StageParameters;
use hal_sim::machine::plant::Plant;
use hal_sim::rig::loop_model;
use nalgebra::{DMatrix, Matrix3};
use std::f64::consts::TAU;

/// Resistances of the windings as their pulses had them, roughly: what the motor constants are found with.
const ROUGH_OHM: f64 = 1.02;

/// Where what is moved is told apart, track radii.
const FAR_OUT: f64 = 0.7;

pub struct Identified {
    pub excited: Excited,
    pub lines: Vec<Line>,
    pub model: DriveModel,
}

pub fn identify(parameters: &StageParameters, plan: &Plan) -> Identified {
    let mut machine = Machine::at(parameters, plan.pose);
    let steady = all_rates(&mut machine);
    let motor_constants = [0, 1, 2].map(|i| {
        let warm = 1.0
            + parameters.plant.winding.resistance_per_k
                * machine.stage.plant.windings_warmer_k()[i];
        let found = friction(
            &steady[i],
            ROUGH_OHM * warm * parameters.plant.resistance_ohm,
        )
        .expect("there is friction");
        found.motor_constant
    });
    let known = Known {
        knee_a: KNEE_A,
        motor_constants,
        guess: Guess::STAGE,
        to_hz: 2_500.0,
    };
    let excited = excite(parameters, plan);
    let lines = frequency_response(&excited.runs, &TIMING).expect("there are responses");
    let weaker = Plan {
        rms_v: plan.rms_v / WEAKER,
        ..*plan
    };
    let weaker = excite(parameters, &weaker);
    let weaker = frequency_response(&weaker.runs, &TIMING).expect("there are responses");
    let far = Plan {
        pose: [FAR_OUT * parameters.plant.track_radius_m, 0.0, 0.0],
        periods: 2,
        ..*plan
    };
    let far = excite(parameters, &far);
    let far = frequency_response(&far.runs, &TIMING).expect("there are responses");
    let responses = Responses {
        lines: &lines,
        weaker: &weaker,
        times: WEAKER,
        far: &far,
        far_place: &Place::new(FAR_OUT, 0.0).expect("inside"),
    };
    let model = drive_model(&excited.runs, &responses, &TIMING, &known).expect("there is a model");
    Identified {
        excited,
        lines,
        model,
    }
}

/// What is compared, in this order; errors over the true value, the worst of what there is three of.
pub const NAMES: [&str; 13] = [
    "R J / K",
    "K",
    "R",
    "L",
    "inertia at a ring",
    "motor and ring",
    "mass",
    "inertia",
    "resonance 1",
    "resonances, worst",
    "dead time, V",
    "K, meters' errors and all",
    "inertia at a ring, meters' errors and all",
];

pub fn errors(parameters: &StageParameters, found: &Identified) -> [f64; 13] {
    let (plant, analog) = (&parameters.plant, &parameters.analog);
    let DriveModel {
        electrical,
        mechanical,
    } = &found.model;
    let supply = analog.supply_gain;
    let inertia = ring_inertia(plant_at(parameters, PLAN.pose));
    let found_inertia = mechanical.chain.inertia(&Place::centre());
    let worst = |error: &dyn Fn(usize) -> f64| {
        (0..3).map(error).fold(0.0_f64, |most, error| {
            if error.abs() > most.abs() {
                error
            } else {
                most
            }
        })
    };
    let gain = |i: usize| analog.current_gain[i];
    let ohm = |i: usize| {
        plant.resistance_ohm * (1.0 + plant.winding.resistance_per_k * found.excited.warmer_k[i])
    };
    let constant = plant.gear_ratio * plant.torque_constant_n_m_a;
    let square = plant.track_radius_m * plant.track_radius_m;
    let payload = &plant.payload;
    let mass = square * (plant.platform_mass_kg + payload.mass_kg);
    let load_inertia = plant.platform_inertia_kg_m2
        + payload.inertia_kg_m2
        + payload.mass_kg * payload.eccentricity_m.powi(2);
    let drive_inertia = plant.motor_inertia_kg_m2 + plant.ring_inertia_kg_m2;
    let resonances = resonances_hz(parameters);
    let found_resonances = mechanical.chain.resonances_hz(&Place::centre());
    let resonance = |k: usize| found_resonances[k] / resonances[k] - 1.0;
    let all_resonances = (0..6).map(resonance).fold(0.0_f64, |most, error| {
        if error.abs() > most.abs() {
            error
        } else {
            most
        }
    });
    // Meters that read too much make everything of volts and amperes as much larger: that is no error of the method.
    let torque = torque(parameters);
    let lost_v = 200e-9 * 40e3 * found.excited.machine.supply_v;
    [
        worst(&|i| {
            let found =
                electrical[i].resistance_ohm / electrical[i].motor_constant * found_inertia[(i, i)];
            found / (ohm(i) / constant * inertia[(i, i)] * torque / gain(i)) - 1.0
        }),
        worst(&|i| electrical[i].motor_constant / (constant * supply) - 1.0),
        worst(&|i| electrical[i].resistance_ohm / (ohm(i) * supply / gain(i)) - 1.0),
        worst(&|i| electrical[i].inductance_h / (plant.inductance_h * supply / gain(i)) - 1.0),
        worst(&|i| found_inertia[(i, i)] / (inertia[(i, i)] * torque) - 1.0),
        (mechanical.chain.motor_inertia + mechanical.chain.ring_inertia) / (drive_inertia * torque)
            - 1.0,
        mechanical.chain.load.mass / (mass * torque) - 1.0,
        mechanical.chain.load.inertia / (load_inertia * torque) - 1.0,
        resonance(0),
        all_resonances,
        worst(&|i| electrical[i].dead_time_v - lost_v),
        worst(&|i| electrical[i].motor_constant / constant - 1.0),
        worst(&|i| found_inertia[(i, i)] / inertia[(i, i)] - 1.0),
    ]
}

/// Mechanics and drives as they are, as warm as they were while they were excited.
pub fn as_warm(parameters: &StageParameters, excited: &Excited) -> (Chain, [Electrical; 3]) {
    let (chain, mut electrical) = loop_model(parameters);
    for (drive, warmer_k) in electrical.iter_mut().zip(excited.warmer_k) {
        drive.resistance_ohm *= 1.0 + parameters.plant.winding.resistance_per_k * warmer_k;
    }
    (chain, electrical)
}

/// Median, 90 % and the largest.
pub fn spread(sizes: &mut [f64]) -> [f64; 3] {
    sizes.sort_by(f64::total_cmp);
    [0.5, 0.9, 1.0].map(|part| sizes[((sizes.len() - 1) as f64 * part).round() as usize])
}

/// Springs and dampers, in this order.
pub const OFF_NAMES: [&str; 4] = [
    "transmission's stiffness",
    "its damping, weaker",
    "guides' stiffness",
    "their damping, weaker",
];

/// How far they are from what was found, over what that says that they may be. Dampers that are stronger do no harm.
pub fn off_over_uncertainty(parameters: &StageParameters, found: &DriveModel) -> [f64; 4] {
    let (truth, _) = loop_model(parameters);
    let torque = torque(parameters);
    let (chain, most) = (&found.mechanical.chain, found.mechanical.uncertainty());
    let off = |found: f64, truth: f64| (found / (truth * torque)).ln();
    [
        off(chain.stiffness, truth.stiffness).abs() / most.stiffness,
        off(chain.damping, truth.damping).max(0.0) / most.damping,
        off(chain.guide_stiffness, truth.guide_stiffness).abs() / most.guide_stiffness,
        off(chain.guide_damping, truth.guide_damping).max(0.0) / most.guide_damping,
    ]
}

/// What torques are by the meters, over what they are.
fn torque(parameters: &StageParameters) -> f64 {
    let analog = &parameters.analog;
    analog.supply_gain * analog.current_gain.iter().sum::<f64>() / 3.0
}

fn plant_at(parameters: &StageParameters, pose: [f64; 3]) -> Plant {
    let mut plant = Plant::new(parameters.plant);
    plant.set_pose_at_rest(pose);
    plant
}

/// What the rings move, kg m^2, by the simulator's own mass matrix.
pub fn ring_inertia(plant: Plant) -> Matrix3<f64> {
    let inverse = plant.jacobian().try_inverse().expect("no singular place");
    let motors = Matrix3::identity() * plant.parameters().motor_inertia_kg_m2;
    inverse.transpose() * plant.mass_matrix() * inverse + motors
}

/// Frequencies of the machine without play and friction, Hz, from its stiffness and mass matrices in the simulator's coordinates (motors, rings,
/// x, y, theta; SI): eigenvalues of `M^-1 K`.
pub fn resonances_hz(parameters: &StageParameters) -> Vec<f64> {
    let plant = plant_at(parameters, PLAN.pose);
    let numbers = plant.parameters();
    let (jacobian, rings) = (plant.jacobian(), numbers.ring_inertia_kg_m2);
    let body = plant.mass_matrix() - rings * jacobian.transpose() * jacobian;
    let lever = numbers.track_radius_m;
    let mut mass = DMatrix::zeros(9, 9);
    let mut stiffness = DMatrix::zeros(9, 9);
    for i in 0..3 {
        mass[(i, i)] = numbers.motor_inertia_kg_m2;
        mass[(3 + i, 3 + i)] = rings;
        let k = numbers.transmission_stiffness_n_m_rad;
        stiffness[(i, i)] += k;
        stiffness[(3 + i, 3 + i)] += k + numbers.guide_stiffness_n_m * lever * lever;
        stiffness[(i, 3 + i)] -= k;
        stiffness[(3 + i, i)] -= k;
        for j in 0..3 {
            mass[(6 + i, 6 + j)] = body[(i, j)];
            let coupling = numbers.guide_stiffness_n_m * lever * lever * jacobian[(i, j)];
            stiffness[(3 + i, 6 + j)] -= coupling;
            stiffness[(6 + j, 3 + i)] -= coupling;
        }
    }
    let across = numbers.guide_stiffness_n_m * lever * lever * jacobian.transpose() * jacobian;
    for i in 0..3 {
        for j in 0..3 {
            stiffness[(6 + i, 6 + j)] += across[(i, j)];
        }
    }
    let all = mass.try_inverse().expect("masses") * stiffness;
    let mut hz: Vec<f64> = all
        .complex_eigenvalues()
        .iter()
        .map(|square| square.re.max(0.0).sqrt() / TAU)
        .collect();
    hz.sort_by(f64::total_cmp);
    hz.split_off(3)
}

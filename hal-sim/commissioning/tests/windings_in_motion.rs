//! Windings of simulated machines that turn, from records with a row each fourth tick: as commissioning has them.

mod machine;

use commissioning::drive_model::{Besides, Equations, electrical};
use commissioning::frequency_response::Run;
use commissioning::friction::{MotorConstant, SteadyRate, friction};
use machine::{PLAN, Plan, TIMING, excite, unknown};

const TICKS_PER_ROW: usize = 4;
const KNEE_A: f64 = 0.043;
/// Lines stay under half of the rows' rate.
const TO_HZ: f64 = 2_300.0;

fn thinned(mut run: Run) -> Run {
    run.ticks_per_row = TICKS_PER_ROW;
    for record in run.experiments.iter_mut().flatten() {
        for signals in &mut record.pivots {
            for values in [
                &mut signals.volts,
                &mut signals.current_a,
                &mut signals.angle_rad,
            ] {
                *values = values.iter().copied().step_by(TICKS_PER_ROW).collect();
            }
        }
    }
    run
}

/// Resistance that pulses had, over a cold winding's: 6 % too large, since the gears give way to the motor, and the encoder does not see it.
const PULSES_OHM: f64 = 1.06;

/// Steady rates say what a motor constant is with a resistance; it is that of the resistance that is found, not of the one that was thought before.
#[test]
fn a_motor_constant_is_that_of_the_resistance_that_is_found() {
    let parameters = unknown(1);
    let plant = &parameters.plant;
    let [ohm, constant] = [plant.resistance_ohm, plant.ring_torque_constant_n_m_a()];
    let steady = [1.0, 3.0, -1.0, -3.0].map(|rate_rad_s: f64| {
        let current_a = 0.1 * rate_rad_s.signum() + 0.02 * rate_rad_s;
        SteadyRate {
            rate_rad_s,
            current_a,
            volts: ohm * current_a + constant * rate_rad_s + 0.38 * rate_rad_s.signum(),
            dead_time_share: rate_rad_s.signum(),
        }
    });
    let before = friction(&steady, PULSES_OHM * ohm).expect("friction");
    let excited = excite(
        &parameters,
        &Plan {
            to_hz: TO_HZ,
            ..PLAN
        },
    );
    let runs: Vec<Run> = excited.runs.into_iter().map(thinned).collect();
    let equations = Equations::new(&runs, &TIMING, 0, KNEE_A).expect("records");
    let besides = Besides {
        motor_constant: before.motor_constant,
        mechanics: None,
    };
    let found = electrical(&equations, &TIMING, &besides).expect("a winding");
    let off =
        |constant: f64| 100.0 * (constant / before.motor_constant.with(found.resistance_ohm) - 1.0);
    println!(
        "found {:+.4} %, before {:+.4} %",
        off(found.motor_constant),
        off(before.motor_constant.with(PULSES_OHM * ohm))
    );
    assert!(
        off(found.motor_constant).abs() < 1e-3
            && off(before.motor_constant.with(PULSES_OHM * ohm)).abs() > 0.02
    );
}

/// The dead time takes of the volts by the sign of the current. What of it is not seen is taken for resistance: with the sign at the rows alone, or
/// with the records of drives that are not excited, 1 to 4 %.
#[test]
fn the_dead_time_is_not_taken_for_resistance() {
    let (mut off_ohm, mut off_v) = (Vec::new(), Vec::new());
    for seed in 1..=3 {
        let parameters = unknown(seed);
        let (plant, analog) = (&parameters.plant, &parameters.analog);
        let plan = Plan {
            to_hz: TO_HZ,
            ..PLAN
        };
        let excited = excite(&parameters, &plan);
        let runs: Vec<Run> = excited.runs.into_iter().map(thinned).collect();
        let dead_v = 200e-9 * 40e3 * excited.machine.supply_v;
        for pivot in 0..3 {
            let equations = Equations::new(&runs, &TIMING, pivot, KNEE_A).expect("records");
            let besides = Besides {
                motor_constant: MotorConstant::known(
                    plant.ring_torque_constant_n_m_a() * analog.supply_gain,
                ),
                mechanics: None,
            };
            let found = electrical(&equations, &TIMING, &besides).expect("a winding");
            let warm = 1.0 + plant.winding.resistance_per_k * excited.warmer_k[pivot];
            // As the controller's meters have it.
            let ohm = plant.resistance_ohm * warm * analog.supply_gain / analog.current_gain[pivot];
            off_ohm.push(100.0 * (found.resistance_ohm / ohm - 1.0));
            off_v.push(100.0 * (found.dead_time_v / dead_v - 1.0));
        }
    }
    for (name, off, most_mean, most) in [
        // 0.07 of the mean are the supply's ripple, which the supply's average leaves.
        ("resistance", off_ohm, 0.3, 0.64),
        ("dead time", off_v, 1.16, 1.62),
    ] {
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        let worst = off.iter().map(|off| off.abs()).fold(0.0, f64::max);
        println!("{name}: mean {mean:+.2} %, worst {worst:.2} %");
        assert!(mean.abs() < most_mean && worst < most, "{name}: {off:.2?}");
    }
}

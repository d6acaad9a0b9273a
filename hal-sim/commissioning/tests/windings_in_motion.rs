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

/// Resistance of the windings at the steady rates, over that while they are identified: they have cooled meanwhile.
const THEN: f64 = 1.06;

/// What steady rates say of a motor constant does not hang on how warm the windings were then.
#[test]
fn a_motor_constant_is_right_whatever_the_resistance_was_at_steady_rates() {
    let parameters = unknown(1);
    let plant = &parameters.plant;
    let constant = plant.ring_torque_constant_n_m_a();
    let excited = excite(
        &parameters,
        &Plan {
            to_hz: TO_HZ,
            ..PLAN
        },
    );
    let dead_v = 200e-9 * 40e3 * excited.machine.supply_v;
    let runs: Vec<Run> = excited.runs.into_iter().map(thinned).collect();
    let equations = Equations::new(&runs, &TIMING, 0, KNEE_A).expect("records");
    let off_with = |then: f64| {
        let steady = [1.0, 3.0, -1.0, -3.0].map(|rate_rad_s: f64| {
            let current_a = 0.1 * rate_rad_s.signum() + 0.02 * rate_rad_s;
            SteadyRate {
                rate_rad_s,
                current_a,
                volts: then * plant.resistance_ohm * current_a
                    + constant * rate_rad_s
                    + dead_v * rate_rad_s.signum(),
                dead_time_share: rate_rad_s.signum(),
            }
        });
        let motor_constant =
            (friction(&steady, plant.resistance_ohm).expect("friction")).motor_constant;
        let besides = Besides {
            motor_constant,
            mechanics: None,
        };
        let found = electrical(&equations, &TIMING, &besides).expect("a winding");
        let off = |found: f64| 100.0 * (found / constant - 1.0);
        [
            found.motor_constant,
            motor_constant.with(plant.resistance_ohm),
        ]
        .map(off)
    };
    let [sound, _] = off_with(1.0);
    let [other, with_wrong_resistance] = off_with(THEN);
    println!(
        "{sound:+.4} %, {other:+.4} %, with the other resistance {with_wrong_resistance:+.4} %"
    );
    assert!((other - sound).abs() < 1e-3, "{sound} {other}");
    assert!(sound.abs() < 0.028, "{sound}");
    assert!(with_wrong_resistance > 0.05, "{with_wrong_resistance}");
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

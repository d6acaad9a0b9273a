//! Friction of simulated machines at steady rates, and of one in closed form.

mod machine;

use commissioning::friction::{FrictionError, SteadyRate, friction};
use machine::{Machine, TIMING, Want, unknown};
use std::f64::consts::TAU;

/// Rates that are tried, rad/s.
const RATES: [f64; 3] = [0.3, 1.0, 3.0];

fn steady_rates(machine: &mut Machine, rate: f64) -> [SteadyRate; 3] {
    let start = machine.angle_rad;
    let mut phase = 0.0;
    let mut speed = 0.0;
    let mut sums = [[0.0; 2]; 3];
    // Whole turns of the motors: ten, or a second.
    let turn_s = TAU / 50.0 / rate.abs();
    let ticks = ((1.0 / turn_s).max(10.0).round() * turn_s / TIMING.tick_s).round() as usize;
    let settle = 6_000;
    for tick in 0..settle + ticks {
        speed += (rate - speed) * 2e-3;
        phase += speed * TIMING.tick_s;
        let wants = [0, 1, 2].map(|i| Want { angle_rad: start[i] + phase, rate_rad_s: speed });
        let mut record = commissioning::record::Record::default();
        machine.servo_tick(wants, [0.0; 3], Some(&mut record));
        if tick >= settle {
            for (sum, signals) in sums.iter_mut().zip(&record.pivots) {
                sum[0] += signals.current_a[0] / ticks as f64;
                sum[1] += signals.volts[0] / ticks as f64;
            }
        }
    }
    sums.map(|[current_a, volts]| SteadyRate { rate_rad_s: rate, current_a, volts })
}

/// The rings are coupled: carriages that do not slide keep a torque between them, and a drive then carries a part of another's friction. What
/// all three carry is right; one alone is as far off as the guides' friction lets it.
#[test]
fn friction_of_unknown_machines() {
    let (mut off, mut off_alone) = (Vec::new(), Vec::new());
    for seed in 0..4 {
        let parameters = unknown(seed);
        let mut machine = Machine::at(&parameters, [0.0; 3]);
        machine.gains = [4.0, 200.0];
        let steady: Vec<_> = (RATES.iter()).flat_map(|rate| [*rate, -rate]).map(|rate| steady_rates(&mut machine, rate)).collect();
        let plant = &parameters.plant;
        let constant = plant.gear_ratio * plant.torque_constant_n_m_a;
        let found = [0, 1, 2].map(|drive| {
            let of_drive: Vec<_> = steady.iter().map(|all| all[drive]).collect();
            // As the meter of its current has it.
            let meter = parameters.analog.current_gain[drive];
            friction(&of_drive, constant / meter).expect("friction")
        });
        let (rings, motors) = (&plant.ring_friction, &plant.motor_friction);
        for rate in RATES {
            let total = rings.coulomb + motors.coulomb + (rings.viscous + motors.viscous) * rate;
            let mean = found.iter().map(|found| found.at(rate)).sum::<f64>() / 3.0;
            off.push((mean / total - 1.0).abs());
            off_alone.extend(found.map(|found| (found.at(rate) / total - 1.0).abs()));
        }
    }
    for (name, off, median, worst) in [("of all three", &mut off, 0.05, 0.05), ("of one alone", &mut off_alone, 0.07, 0.2)] {
        off.sort_by(f64::total_cmp);
        let last = off.len() - 1;
        println!("friction {name}: median {:.4}, 90 % {:.4}, worst {:.4}", off[last / 2], off[last * 9 / 10], off[last]);
        assert!(off[last / 2] < median && off[last] < worst, "{name}");
    }
}

#[test]
fn friction_in_closed_form_is_found_again() {
    let steady = |offset_a: f64, bump_a: f64| -> Vec<_> {
        (RATES.iter())
            .flat_map(|rate| [*rate, -rate])
            .enumerate()
            .map(|(k, rate)| SteadyRate {
                rate_rad_s: rate,
                current_a: (0.35 * rate.signum() + 0.06 * rate) / 2.5 + offset_a + bump_a * f64::from(k == 2),
                volts: 2.0 * 0.14 * rate.signum() + 2.6 * rate,
            })
            .collect()
    };
    let found = friction(&steady(0.02, 0.0), 2.5).expect("friction");
    assert!((found.coulomb_n_m - 0.35).abs() < 1e-12 && (found.viscous_n_m_s - 0.06).abs() < 1e-12);
    assert!((found.offset_a - 0.02).abs() < 1e-12 && (found.volts[0] - 0.28).abs() < 1e-12 && (found.volts[1] - 2.6).abs() < 1e-12);
    assert!(found.residual < 1e-9);
    // Something that catches at one rate.
    assert!(matches!(friction(&steady(0.0, 0.2), 2.5), Err(FrictionError::Uneven { .. })));
    let one_way: Vec<_> = steady(0.0, 0.0).into_iter().filter(|one| one.rate_rad_s > 0.0).collect();
    assert_eq!(friction(&one_way, 2.5), Err(FrictionError::TooFew { forwards: 3, backwards: 0 }));
    let more = [1.5, -1.5].map(|rate| SteadyRate { rate_rad_s: rate, current_a: 0.2 * f64::signum(rate), volts: 4.0 });
    let near: Vec<_> = steady(0.0, 0.0).into_iter().chain(more).filter(|one| one.rate_rad_s.abs() < 2.0 && one.rate_rad_s.abs() > 0.5).collect();
    assert_eq!(friction(&near, 2.5), Err(FrictionError::TooNear));
    let reversed: Vec<_> = steady(0.0, 0.0).into_iter().map(|one| SteadyRate { current_a: -one.current_a, ..one }).collect();
    assert!(matches!(friction(&reversed, 2.5), Err(FrictionError::Negative { .. })));
}

//! Friction of simulated machines at steady rates, and of one in closed form.

mod machine;

use commissioning::friction::{FrictionError, SteadyRate, friction, mean};
use machine::steady::{RATES, all_rates};
use machine::{Machine, unknown};

/// The rings are coupled: carriages that do not slide keep a torque between them, and a drive then carries a part of another's friction. What
/// all three carry is right; one alone is as far off as the guides' friction lets it.
#[test]
fn friction_of_unknown_machines() {
    let (mut off, mut off_alone, mut off_constant) = (Vec::new(), Vec::new(), Vec::new());
    for seed in 0..4 {
        let parameters = unknown(seed);
        let mut machine = Machine::at(&parameters, [0.0; 3]);
        let steady = all_rates(&mut machine);
        let plant = &parameters.plant;
        let constant = plant.gear_ratio * plant.torque_constant_n_m_a;
        let mut meters = [1.0; 3];
        let found = [0, 1, 2].map(|drive| {
            let of_drive = &steady[drive];
            // Not known better than to 3 %.
            let ohm = 1.03
                * plant.resistance_ohm
                * (1.0 + 0.0039 * machine.stage.plant.windings_warmer_k()[drive]);
            let found = friction(of_drive, ohm).expect("friction");
            off_constant.push(
                (found.motor_constant.with(ohm) / (constant * parameters.analog.supply_gain) - 1.0)
                    .abs(),
            );
            // As the controller's meters have it.
            meters[drive] = parameters.analog.current_gain[drive] * parameters.analog.supply_gain;
            found
        });
        let (rings, motors) = (&plant.ring_friction, &plant.motor_friction);
        for rate in RATES {
            let total = rings.coulomb + motors.coulomb + (rings.viscous + motors.viscous) * rate;
            let [coulomb, viscous] = mean(&found);
            let meter = meters.iter().sum::<f64>() / 3.0;
            off.push(((coulomb + viscous * rate) / (total * meter) - 1.0).abs());
            off_alone.extend(found.map(|found| (found.at(rate) / (total * meter) - 1.0).abs()));
        }
    }
    let figures = [
        ("friction of all three", &mut off, 0.0045, 0.009),
        ("friction of one alone", &mut off_alone, 0.062, 0.16),
        ("motor constant", &mut off_constant, 0.003, 0.006),
    ];
    for (name, off, median, worst) in figures {
        off.sort_by(f64::total_cmp);
        let last = off.len() - 1;
        println!(
            "{name}: median {:.4}, 90 % {:.4}, worst {:.4}",
            off[last / 2],
            off[last * 9 / 10],
            off[last]
        );
        assert!(off[last / 2] < median && off[last] < worst, "{name}");
    }
}

#[test]
fn friction_in_closed_form_is_found_again() {
    // At the slowest rate the current is too small at times.
    let counts = |rate: f64| rate.signum() * (1.0 - 0.3 * f64::from(rate.abs() < 0.5));
    let steady = |offset_a: f64, bump_a: f64| -> Vec<_> {
        (RATES.iter())
            .flat_map(|rate| [*rate, -rate])
            .enumerate()
            .map(|(k, rate)| SteadyRate {
                rate_rad_s: rate,
                current_a: (0.35 * rate.signum() + 0.06 * rate) / 2.5
                    + offset_a
                    + bump_a * f64::from(k == 2),
                volts: 2.1 * (0.35 * rate.signum() + 0.06 * rate) / 2.5
                    + 0.38 * counts(rate)
                    + 2.5 * rate,
                dead_time_share: counts(rate),
            })
            .collect()
    };
    let found = friction(&steady(0.02, 0.0), 2.1).expect("friction");
    assert!((found.coulomb_n_m - 0.35).abs() < 1e-12 && (found.viscous_n_m_s - 0.06).abs() < 1e-12);
    // The offset of the sensor is in the volts of the resistance, both ways alike.
    assert!(
        (found.offset_a - 0.02).abs() < 1e-12
            && (found.motor_constant.with(2.1) - 2.5).abs() < 1e-12
    );
    // Whatever resistance was thought of, it says what it is with another one: of the volts a rad/s takes what 0.0115 A take on 0.2 ohm.
    let other = friction(&steady(0.02, 0.0), 1.9).expect("friction");
    assert_eq!(other.motor_constant, found.motor_constant);
    assert!((found.motor_constant.with(1.9) - 2.502_302_7).abs() < 1e-7);
    assert!((found.break_away_v - (2.1 * 0.35 / 2.5 + 0.38)).abs() < 1e-12);
    assert!(found.residual < 1e-9);
    // Something that catches at one rate.
    assert!(matches!(
        friction(&steady(0.0, 0.2), 2.1),
        Err(FrictionError::Uneven { .. })
    ));
    let one_way: Vec<_> = steady(0.0, 0.0)
        .into_iter()
        .filter(|one| one.rate_rad_s > 0.0)
        .collect();
    assert_eq!(
        friction(&one_way, 2.1),
        Err(FrictionError::TooFew {
            forwards: 3,
            backwards: 0
        })
    );
    let more = [1.5, -1.5].map(|rate| SteadyRate {
        rate_rad_s: rate,
        current_a: 0.2 * f64::signum(rate),
        volts: 4.0,
        dead_time_share: f64::signum(rate),
    });
    let near: Vec<_> = steady(0.0, 0.0)
        .into_iter()
        .chain(more)
        .filter(|one| one.rate_rad_s.abs() < 2.0 && one.rate_rad_s.abs() > 0.5)
        .collect();
    assert_eq!(friction(&near, 2.1), Err(FrictionError::TooNear));
    let reversed: Vec<_> = steady(0.0, 0.0)
        .into_iter()
        .map(|one| SteadyRate {
            current_a: -one.current_a,
            ..one
        })
        .collect();
    assert!(matches!(
        friction(&reversed, 2.1),
        Err(FrictionError::Negative { .. })
    ));
    let against: Vec<_> = steady(0.0, 0.0)
        .into_iter()
        .map(|one| SteadyRate {
            volts: -one.volts,
            ..one
        })
        .collect();
    assert_eq!(friction(&against, 2.1), Err(FrictionError::AgainstTheVolts));
}

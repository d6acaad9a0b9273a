//! Pulses on simulated machines, and on a winding in closed form.

mod machine;

use commissioning::record::{Signals, Timing};
use commissioning::winding::{WindingError, WindingGuess, winding};
use machine::{Machine, TIMING, unknown};

const GUESS: WindingGuess = WindingGuess {
    resistance_ohm: 2.1,
    inductance_h: 0.7e-3,
    motor_constant: 3.0,
    dead_time_v: 0.2,
    knee_a: 0.043,
};

/// 2 ms of these volts on one drive, with 1 ms before and 5 ms after, at rest.
fn pulse(machine: &mut Machine, drive: usize, volts: f64) -> Signals {
    let mut signals = Signals::default();
    for tick in 0..160 {
        let mut wanted = [0.0; 3];
        wanted[drive] = if (20..60).contains(&tick) { volts } else { 0.0 };
        let given = machine.tick(wanted);
        signals.volts.push(given[drive]);
        signals.current_a.push(machine.current_a[drive]);
        signals.angle_rad.push(machine.angle_rad[drive]);
    }
    for _ in 0..2_000 {
        machine.tick([0.0; 3]);
    }
    signals
}

const SIZES_V: [f64; 4] = [2.0, -2.0, 4.0, -4.0];

#[test]
fn windings_of_unknown_machines() {
    let (mut off_r, mut off_l) = (Vec::new(), Vec::new());
    for seed in 0..10 {
        let parameters = unknown(seed);
        let mut machine = Machine::at(&parameters, [0.0; 3]);
        for drive in 0..3 {
            let pulses = SIZES_V.map(|volts| pulse(&mut machine, drive, volts));
            let found = winding(&pulses, &TIMING, &GUESS).expect("a sound winding");
            let warm = 1.0 + 0.0039 * machine.stage.plant.windings_warmer_k()[drive];
            // As the controller's meters have it.
            let meters = parameters.analog.supply_gain / parameters.analog.current_gain[drive];
            off_r.push(
                (found.resistance_ohm / (parameters.plant.resistance_ohm * warm * meters) - 1.0)
                    .abs(),
            );
            off_l.push((found.inductance_h / (parameters.plant.inductance_h * meters) - 1.0).abs());
            assert_eq!(found.sense, 1, "{seed} {drive}");
        }
    }
    // Motors are ahead of their rings for the first milliseconds, and only the rings are seen: that is what is left of L. Of R's median
    // 0.0008 are the supply's ripple, which the supply's average leaves.
    for (name, off, median, worst) in [
        ("R", &mut off_r, 0.0062, 0.012),
        ("L", &mut off_l, 0.035, 0.1),
    ] {
        off.sort_by(f64::total_cmp);
        println!("{name}: median {:.4}, worst {:.4}", off[15], off[29]);
        assert!(off[15] < median && off[29] < worst, "{name}");
    }
}

/// A winding without motion in closed form: `i = (u - d) / R (1 - exp(-(t - t0) R / L))`, sampled as the stage does.
fn closed_form(resistance_ohm: f64, inductance_h: f64, dead_v: f64, volts: f64) -> Signals {
    let mut signals = Signals::default();
    let (start, end) = (20, 60);
    let time = |tick: i32| f64::from(tick) * TIMING.tick_s - TIMING.duty_s;
    let size = (volts.abs() - dead_v) / resistance_ohm;
    let rise = |s: f64| size * (1.0 - (-s * resistance_ohm / inductance_h).exp());
    for tick in 0..100 {
        let on_s = time(tick - start);
        let pulse_s = f64::from(end - start) * TIMING.tick_s;
        let current = if on_s <= 0.0 {
            0.0
        } else if on_s <= pulse_s {
            rise(on_s)
        } else {
            // At no volts a pulse is swallowed, and so takes no dead time.
            rise(pulse_s) * (-(on_s - pulse_s) * resistance_ohm / inductance_h).exp()
        };
        signals.volts.push(if (start..end).contains(&tick) {
            volts
        } else {
            0.0
        });
        signals.current_a.push(current * volts.signum());
        signals.angle_rad.push(0.0);
    }
    signals
}

#[test]
fn a_winding_in_closed_form_is_found_again() {
    // A knee that is hardly there, as in the closed form.
    let guess = WindingGuess {
        knee_a: 1e-3,
        ..GUESS
    };
    let pulses = SIZES_V.map(|volts| closed_form(3.1, 1.1e-3, 0.3, volts));
    let found = winding(&pulses, &TIMING, &guess).expect("a winding");
    println!("{found:?}");
    assert!((found.resistance_ohm / 3.1 - 1.0).abs() < 2e-3);
    assert!((found.inductance_h / 1.1e-3 - 1.0).abs() < 5e-3);
    assert!((found.dead_time_v - 0.3).abs() < 5e-3);
    assert_eq!(found.sense, 0);
    // The duty acts when it does: half a tick later it is another inductance.
    let late = Timing {
        duty_s: TIMING.duty_s + 25e-6,
        ..TIMING
    };
    let other = winding(&pulses, &late, &guess).expect("a winding");
    assert!((other.inductance_h / 1.1e-3 - 1.0).abs() > 0.02);
}

#[test]
fn what_is_wrong_is_said() {
    let sound = SIZES_V.map(|volts| closed_form(2.1, 0.7e-3, 0.3, volts));
    let with = |change: fn(&mut Signals)| {
        let mut pulses = sound.clone();
        pulses.iter_mut().for_each(change);
        winding(&pulses, &TIMING, &GUESS).expect_err("it is not sound")
    };
    assert!(winding(&sound, &TIMING, &GUESS).is_ok());
    assert!(matches!(
        with(|pulse| pulse.current_a.fill(0.0)),
        WindingError::Open { .. }
    ));
    assert_eq!(with(|pulse| pulse.volts.fill(0.0)), WindingError::NoPulse);
    assert_eq!(
        with(|pulse| pulse.current_a.truncate(5)),
        WindingError::Lengths
    );
    assert_eq!(
        with(|pulse| pulse.current_a.iter_mut().for_each(|a| *a = -*a)),
        WindingError::Reversed
    );
    let short = SIZES_V.map(|volts| closed_form(0.2, 0.1e-3, 0.3, volts));
    assert!(matches!(
        winding(&short, &TIMING, &GUESS),
        Err(WindingError::Short { .. })
    ));
    let other = SIZES_V.map(|volts| closed_form(5.0, 0.7e-3, 0.3, volts));
    assert!(matches!(
        winding(&other, &TIMING, &GUESS),
        Err(WindingError::Unexpected { .. })
    ));
}

//! Responses of a linear machine whose answer is known in closed form, in open and in closed loop; and what is refused.

mod machine;

use commissioning::chain::{Chain, Place};
use commissioning::closed_loop::closed_loop;
use commissioning::drive_model::{Electrical, Guess};
use commissioning::frequency_response::{Line, ResponseError, Run, frequency_response, hold};
use commissioning::record::{Record, Signals, Timing};
use machine::{PERIOD, harmonics, period_v};
use nalgebra::{Complex, Matrix3, Vector3};
use std::f64::consts::TAU;

/// Steps of the integration, us, and when within the period before a tick its samples are taken.
const STEPS: usize = 50;
const DUTY_AT: usize = 32;
const ANGLE_AT: usize = 35;
const CURRENT_AT: usize = 40;
const TIMING: Timing = Timing {
    tick_s: 50e-6,
    duty_s: 32e-6,
    angle_s: -15e-6,
    current_s: -10e-6,
};

/// Three coupled drives without friction: `L i' = u - R i - K w`, `M w' = K i`.
const OHM: f64 = 2.3;
const HENRY: f64 = 0.8e-3;
const CONSTANT: f64 = 2.7;
const INERTIA: Matrix3<f64> = Matrix3::new(
    0.041, 0.006, 0.004, 0.006, 0.038, 0.005, 0.004, 0.005, 0.044,
);

/// From volts to currents and to angles, as continuous signals.
fn response(hz: f64) -> [Matrix3<Complex<f64>>; 2] {
    let s = Complex::new(0.0, TAU * hz);
    let mobility =
        INERTIA.try_inverse().expect("masses").map(Complex::from) * (Complex::from(CONSTANT) / s);
    let impedance = Matrix3::identity() * (OHM + s * HENRY) + mobility * Complex::from(CONSTANT);
    let current = impedance.try_inverse().expect("an impedance");
    [current, mobility * current / s]
}

/// Angle, rate, current.
type State = [Vector3<f64>; 3];

fn step(state: &State, volts: &Vector3<f64>, mobility: &Matrix3<f64>) -> State {
    let step_s = 1e-6;
    let slope = |state: &State| {
        [
            state[1],
            mobility * state[2],
            (volts - state[2] * OHM - state[1] * CONSTANT) / HENRY,
        ]
    };
    let add = |by: f64, rate: &State| [0, 1, 2].map(|k| state[k] + rate[k] * by);
    let a = slope(state);
    let b = slope(&add(0.5 * step_s, &a));
    [0, 1, 2].map(|k| state[k] + b[k] * step_s)
}

/// Three experiments on rings that turn at 1 rad/s, with a feedback from the angles to the volts, V/rad.
fn run(bins: &[usize], feedback: f64, first_tick: usize) -> Run {
    let volts = period_v(bins, 1.5);
    let mobility = INERTIA.try_inverse().expect("masses") * CONSTANT;
    let experiments = [0, 1, 2].map(|drive| {
        let mut state = [Vector3::zeros(), Vector3::repeat(1.0), Vector3::zeros()];
        let mut record = Record {
            first_tick,
            ..Record::default()
        };
        let (mut angle, mut current) = (state[0], state[2]);
        let mut told = Vector3::repeat(CONSTANT);
        for tick in 0..first_tick + 2 * PERIOD {
            let wanted = Vector3::repeat(tick as f64 * TIMING.tick_s);
            let mut next = Vector3::repeat(CONSTANT) + (wanted - angle) * feedback;
            next[drive] += volts[tick % PERIOD];
            if tick >= first_tick {
                for (i, signals) in record.pivots.iter_mut().enumerate() {
                    signals.volts.push(next[i]);
                    signals.current_a.push(current[i]);
                    signals.angle_rad.push(angle[i]);
                }
            }
            for at in 0..STEPS {
                if at == ANGLE_AT {
                    angle = state[0];
                }
                if at == CURRENT_AT {
                    current = state[2];
                }
                state = step(&state, if at < DUTY_AT { &told } else { &next }, &mobility);
            }
            told = next;
        }
        vec![record]
    });
    Run {
        period_ticks: PERIOD,
        ticks_per_row: 1,
        bins: bins.to_vec(),
        experiments,
    }
}

/// Worst distance of angles and currents from the closed form, over their size.
fn worst(lines: &[Line]) -> [f64; 2] {
    let mut worst = [0.0_f64; 2];
    for line in lines {
        let [current, angle] = response(line.hz);
        let off = |found: Matrix3<Complex<f64>>, expected: Matrix3<Complex<f64>>| {
            (found - expected).norm() / expected.norm()
        };
        worst[0] = worst[0].max(off(line.angle_by_volts(), angle));
        // Up to here what images add to the current's samples is small.
        if line.hz < 500.0 {
            worst[1] = worst[1].max(off(line.current_by_volts(), current));
        }
    }
    worst
}

#[test]
fn responses_are_those_of_the_closed_form() {
    let bins = harmonics(2, 3e3);
    // Not at the beginning of a period: a record knows where it starts.
    for (feedback, first_tick) in [(0.0, 3 * PERIOD), (150.0, 3 * PERIOD + 777)] {
        let lines =
            frequency_response(&[run(&bins, feedback, first_tick)], &TIMING).expect("responses");
        assert_eq!(lines.len(), bins.len());
        let [angle, current] = worst(&lines);
        println!("feedback {feedback} V/rad: angles off by {angle:.1e}, currents by {current:.1e}");
        assert!(angle < 2e-3 && current < 3e-3);
        assert!(lines.iter().all(|line| line.quality() > 0.999));
        // A microsecond is seen.
        let late = Timing {
            duty_s: TIMING.duty_s + 1e-6,
            ..TIMING
        };
        let off = worst(
            &frequency_response(&[run(&bins, feedback, first_tick)], &late).expect("responses"),
        )[0];
        assert!(off > 0.01, "{off}");
    }
}

#[test]
fn what_cannot_be_evaluated_is_said() {
    let bins = harmonics(2, 3e3);
    let sound = run(&bins, 0.0, 2 * PERIOD);
    let with = |change: &dyn Fn(&mut Run)| {
        let mut run = sound.clone();
        change(&mut run);
        frequency_response(&[run], &TIMING).expect_err("it is refused")
    };
    assert_eq!(
        with(&|run| run.period_ticks = 4000),
        ResponseError::Period(4000)
    );
    assert_eq!(
        with(&|run| run.bins = vec![9, 12, 13]),
        ResponseError::Spacing(12, 13)
    );
    assert_eq!(with(&|run| run.bins = vec![2048]), ResponseError::Bin(2048));
    assert_eq!(
        with(&|run| run.experiments[1][0].pivots[2].volts.truncate(9)),
        ResponseError::Lengths { pivot: 3 }
    );
    assert_eq!(
        with(&|run| run.experiments[1][0].pivots[2] = Signals::default()),
        ResponseError::TooShort {
            experiment: 2,
            pivot: 3,
            blocks: 0
        }
    );
    // A drive that does not drive: the second experiment is like the first.
    let same = with(&|run| run.experiments[1] = run.experiments[0].clone());
    assert!(matches!(same, ResponseError::NotExcited { .. }), "{same:?}");
}

/// A row every four ticks: the lines under an eighth of the ticks' rate come out as from all of them.
#[test]
fn every_fourth_tick_is_enough_for_lines_below_an_eighth_of_the_rate() {
    let bins = harmonics(2, 2.3e3);
    let mut sparse = run(&bins, 150.0, 3 * PERIOD + 776);
    sparse.ticks_per_row = 4;
    for record in sparse.experiments.iter_mut().flatten() {
        for signals in &mut record.pivots {
            for values in [
                &mut signals.volts,
                &mut signals.current_a,
                &mut signals.angle_rad,
            ] {
                *values = values.iter().copied().step_by(4).collect();
            }
        }
    }
    let lines = frequency_response(std::slice::from_ref(&sparse), &TIMING).expect("responses");
    let [angle, current] = worst(&lines);
    println!("every fourth tick: angles off by {angle:.1e}, currents by {current:.1e}");
    assert!(angle < 3.3e-4 && current < 4.8e-4);
    sparse.ticks_per_row = 3;
    assert_eq!(
        frequency_response(&[sparse], &TIMING).expect_err("it is refused"),
        ResponseError::Rows(3)
    );
}

/// The loop that a feedback makes, from what is added to it and what currents and angles then are, against `1 / (1 + L)`.
#[test]
fn closed_loops_are_those_of_the_feedback() {
    let (bins, feedback) = (harmonics(2, 2.3e3), 150.0);
    let runs = [run(&bins, feedback, 3 * PERIOD + 777)];
    let lines = frequency_response(&runs, &TIMING).expect("responses");
    let drive = Electrical {
        resistance_ohm: OHM,
        inductance_h: HENRY,
        motor_constant: CONSTANT,
        dead_time_v: 0.0,
        deviations: [0.0; 4],
    };
    // Motors that turn as their rings do.
    let rigid = Chain {
        stiffness: 1e12,
        damping: 0.0,
        ..Guess::STAGE.0
    };
    let peak_v = period_v(&bins, 1.5)
        .iter()
        .fold(0.0_f64, |peak, volts| peak.max(volts.abs()));
    let found = closed_loop(
        &runs,
        &lines,
        peak_v,
        (&[drive; 3], &rigid, &Place::centre()),
        &TIMING,
    );
    let (mut worst_plant, mut worst_loop) = (0.0_f64, 0.0_f64);
    for line in &found {
        let [_, plant] = response(line.hz);
        let read = hold(line.hz, &TIMING) * Complex::cis(TAU * line.hz * TIMING.angle_s);
        let difference = Matrix3::identity() + plant * (read * feedback);
        let expected = difference.try_inverse().expect("a loop");
        worst_plant = worst_plant.max((line.plant - plant).norm() / plant.norm());
        worst_loop = worst_loop.max((line.sensitivity - expected).norm() / expected.norm());
    }
    println!("plants off by {worst_plant:.1e}, sensitivities by {worst_loop:.1e}");
    // What images add to the current's samples; the figures and a tenth more.
    assert!(worst_plant < 9e-3 && worst_loop < 9.4e-3);
}

/// Scatter from period to period is what the deviation says.
#[test]
fn deviations_are_those_of_the_noise() {
    let bins = harmonics(2, 3e3);
    let clean = run(&bins, 0.0, 2 * PERIOD);
    let expected = frequency_response(std::slice::from_ref(&clean), &TIMING).expect("responses");
    let mut seed = 7_u64;
    let mut noise = || {
        let mut sum = 0.0;
        for _ in 0..12 {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            sum += (seed >> 11) as f64 / (1_u64 << 53) as f64;
        }
        sum - 6.0
    };
    let mut shares = Vec::new();
    for _ in 0..6 {
        let mut noisy = clean.clone();
        for record in noisy.experiments.iter_mut().flatten() {
            for angle in record
                .pivots
                .iter_mut()
                .flat_map(|signals| &mut signals.angle_rad)
            {
                *angle += 1e-6 * noise();
            }
        }
        let found = frequency_response(&[noisy], &TIMING).expect("responses");
        for (found, expected) in found.iter().zip(&expected) {
            let (off, deviation) = (
                found.angle_by_volts() - expected.angle_by_volts(),
                found.angle_by_volts_deviation(),
            );
            shares.extend(
                off.iter()
                    .zip(deviation.iter())
                    .map(|(off, deviation)| (off.norm() / deviation).powi(2)),
            );
        }
    }
    let mean = shares.iter().sum::<f64>() / shares.len() as f64;
    println!("errors over their deviations, squared: {mean:.2}");
    // The variance is from three blocks, two parts each: four degrees of freedom, so that the mean of its inverse is 2.
    assert!(mean > 1.5 && mean < 2.5, "{mean}");
}

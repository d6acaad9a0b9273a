//! A transmission so soft that the reference's gains are unstable: with notches and half the gain it does not hunt.

use firmware::fault::FaultKind;
use firmware::parameters::{Notch, Parameters};
use hal_sim::machine::devices::StageParameters;
use hal_sim::rig::run::{RunOptions, controller_parameters, stage_parameters};
use tests::Bench;

/// Resonance of rings against motors, Hz, of the reference stage and of this one.
const REFERENCE_HZ: f64 = 1_500.0;
const SOFT_HZ: f64 = 600.0;

fn soft_stage() -> (StageParameters, Parameters) {
    let options = RunOptions {
        mismatch_percent: 0.0,
        ..RunOptions::default()
    };
    let (mut stage, parameters) = (stage_parameters(&options), controller_parameters(&options));
    let softer = SOFT_HZ / REFERENCE_HZ;
    stage.plant.transmission_stiffness_n_m_rad *= softer * softer;
    stage.plant.transmission_damping_n_m_s_rad *= softer;
    (stage, parameters)
}

/// As `cargo bench -p hal-sim --bench loop` measures it.
fn with_notches(parameters: &Parameters) -> Parameters {
    let mut fitted = parameters.clone();
    let servo = &mut fitted.servo;
    for (gains, filters) in servo.gains.iter_mut().zip(&mut servo.filters) {
        gains.velocity_v_s_rad *= 0.5;
        gains.integral_v_rad *= 0.25;
        gains.position_1_s *= 0.5;
        filters.notches = [0.95, 1.12].map(|part| Notch {
            frequency_hz: SOFT_HZ * part,
            width_hz: SOFT_HZ * 0.3,
            gain: 0.3,
        });
    }
    fitted
}

#[test]
fn without_notches_it_is_told_as_oscillating() {
    let (stage, parameters) = soft_stage();
    let mut bench = Bench::told(&stage, &parameters);
    assert_eq!(bench.error_after("FRF"), "0");
    bench.run(20_000);
    assert_eq!(bench.fault_kind(), Some(FaultKind::Oscillation));
}

#[test]
fn with_notches_it_neither_hunts_nor_rings() {
    let (stage, parameters) = soft_stage();
    let mut bench = Bench::told(&stage, &with_notches(&parameters));
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    for line in ["MOV X 30 Y 10 W 20", "MOV X 0 Y 0 W 0", "MOV X 60"] {
        assert_eq!(bench.error_after(line), "0");
        bench.settle();
    }
    // Ten seconds at rest, from a second after the motion on, 50 ms at a time: friction creeps, which is none of the loop's hunting.
    bench.run(20_000);
    let (mut worst_rms, mut worst_swing, mut peak) = (0.0_f64, 0, 0.0_f64);
    for _ in 0..200 {
        let (mut errors, mut duties) = (Vec::new(), Vec::new());
        for _ in 0..1_000 {
            bench.tick();
            errors.push(bench.following_errors());
            duties.push(bench.sample().duty.map(|duty| duty.0));
        }
        for i in 0..3 {
            let mean = errors.iter().map(|all| all[i]).sum::<f64>() / 1e3;
            let square = errors
                .iter()
                .map(|all| (all[i] - mean).powi(2))
                .sum::<f64>()
                / 1e3;
            worst_rms = worst_rms.max(square.sqrt());
            peak = errors.iter().fold(peak, |peak, all| peak.max(all[i].abs()));
            let (low, high) = (
                duties.iter().map(|all| all[i]).min(),
                duties.iter().map(|all| all[i]).max(),
            );
            worst_swing = worst_swing.max(high.zip(low).map_or(0, |(high, low)| high - low));
        }
    }
    assert_eq!(bench.fault(), None);
    println!(
        "{worst_rms:.3} counts rms in 50 ms, {peak:.1} at most; duty within {worst_swing} of 4,200"
    );
    assert!(
        worst_rms < 0.57 && peak < 5.1 && worst_swing <= 2,
        "{worst_rms}, {peak}, {worst_swing}"
    );
}

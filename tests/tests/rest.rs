//! The stage at rest: quiet, told as settled, back at once when it is pushed; and servos that do not come to rest.

use firmware::fault::FaultKind;
use hal_sim::machine::devices::StageParameters;
use hal_sim::rig::run::{RunOptions, stage_parameters};
use tests::Bench;

const LEVEL: &str = "CCL 1 ADVANCED";
const REST: u32 = 0x5450_0308;
const WINDOW: u32 = 0x5450_0400;

fn set(bench: &mut Bench, id: u32, value: f64) {
    assert_eq!(bench.error_after(&format!("SPA 1 {id} {value}")), "0");
}

fn ready(stage: &StageParameters, parameters: &[(u32, f64)]) -> Bench {
    let mut bench = Bench::new(stage);
    assert_eq!(bench.error_after(LEVEL), "0");
    for &(id, value) in parameters {
        set(&mut bench, id, value);
    }
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    bench
}

fn machine(mismatch_percent: f64, noise_rad: f64) -> StageParameters {
    let mut stage = stage_parameters(&RunOptions {
        mismatch_percent,
        ..RunOptions::default()
    });
    for encoder in &mut stage.encoders {
        encoder.noise_rad = noise_rad;
    }
    stage
}

/// Root mean square of the true pose about its mean over so many ticks, nm and nrad.
fn quiet(bench: &mut Bench, ticks: u32) -> [f64; 2] {
    let (mut sums, mut squares) = ([0.0; 3], [0.0; 3]);
    let first = bench.rig.front.stage.plant.pose();
    for _ in 0..ticks {
        bench.tick();
        let pose = bench.rig.front.stage.plant.pose();
        for i in 0..3 {
            let off = (pose[i] - first[i]) * 1e9;
            sums[i] += off;
            squares[i] += off * off;
        }
    }
    let count = f64::from(ticks);
    let variance = [0, 1, 2].map(|i| squares[i] / count - (sums[i] / count).powi(2));
    [(variance[0] + variance[1]).sqrt(), variance[2].sqrt()]
}

/// It hunted from some second on, with 7 nm and 36 to 134 nrad; the second looked at here is the twelfth. The worst of six hundred seconds
/// has 3 nm and 20 nrad on these machines (MEASURED.md, ten minutes): a slow walk, and no hunting.
#[test]
fn a_stage_at_rest_does_not_hunt() {
    for mismatch_percent in [0.0, -20.0, 20.0] {
        let mut bench = ready(&machine(mismatch_percent, 30e-9), &[]);
        // Something that the motors have to hold: without it they float in their gaps.
        assert_eq!(bench.error_after("MOV X 20 Y -10 W 36"), "0");
        bench.run(230_000);
        let [way_nm, turn_nrad] = quiet(&mut bench, 20_000);
        println!("{mismatch_percent} %: {way_nm} nm, {turn_nrad} nrad");
        assert!(
            way_nm < 3.3 && turn_nrad < 22.0,
            "{way_nm} nm, {turn_nrad} nrad"
        );
    }
}

/// The gap of a light machine with strong motors, in which they float: with a share of the gains of 0.115 it loses its target.
#[test]
fn a_stage_with_much_backlash_comes_to_rest_and_stays_there() {
    for mismatch_percent in [-10.0, -30.0] {
        let mut stage = machine(mismatch_percent, 30e-9);
        stage.plant.backlash_rad = 2e-6;
        let mut bench = ready(&stage, &[]);
        assert_eq!(bench.error_after("MOV X 20 Y -10 W 36"), "0");
        bench.run(30_000);
        for _ in 0..500 {
            bench.run(200);
            assert_eq!(bench.value("ONT? X"), 1.0, "{mismatch_percent} %");
        }
    }
}

/// 200 nrad are 2.1 counts rms, and the window is two.
#[test]
fn on_target_is_not_lost_in_noise_that_is_larger_than_the_window() {
    let mut bench = ready(&machine(0.0, 200e-9), &[(WINDOW, 2.0)]);
    bench.run(160_000);
    for _ in 0..500 {
        bench.run(100);
        assert_eq!(bench.value("ONT? X"), 1.0);
    }
}

/// A push finds nearly the loop that there is without rest mode.
#[test]
fn a_push_brings_the_full_loop_back() {
    let mut peaks = Vec::new();
    for stiffness in [0.1, 1.0] {
        let mut bench = ready(&machine(0.0, 30e-9), &[(REST, stiffness)]);
        bench.run(60_000);
        bench.forget_errors();
        bench.push(1.0);
        bench.run(400);
        peaks.push(bench.worst_error_counts() as f64);
        // 20 ms after the push it is as good as over.
        bench.forget_errors();
        bench.run(200);
        let left = bench.worst_error_counts();
        assert!(left < 5, "{left} counts are left");
    }
    println!("{peaks:?} counts");
    assert!(peaks[0] < 1.8 * peaks[1], "{peaks:?}");
}

/// Gains and what they are set to. Each of them made the motors go to and fro at more than half of their voltage for 8 to 10 s, until they
/// were too hot.
#[test]
fn a_servo_that_oscillates_is_found_within_200_ms() {
    const POSITION: u32 = 0x5450_0300;
    const VELOCITY: u32 = 0x5450_0301;
    const INTEGRAL: u32 = 0x5450_0302;
    for (id, value) in [
        (VELOCITY, 200.0),
        (VELOCITY, 500.0),
        (POSITION, 2_000.0),
        (INTEGRAL, 200_000.0),
    ] {
        let mut bench = ready(&machine(20.0, 30e-9), &[]);
        assert_eq!(bench.error_after(LEVEL), "0");
        set(&mut bench, id, value);
        // Something that wakes it.
        bench.push(0.5);
        let mut ticks = 0;
        while bench.fault().is_none() && ticks < 20_000 {
            bench.tick();
            ticks += 1;
        }
        println!(
            "{id:#x} {value}: {:?} after {} ms",
            bench.fault_kind(),
            f64::from(ticks) / 20.0
        );
        assert_eq!(
            bench.fault_kind(),
            Some(FaultKind::Oscillation),
            "{id:#x} {value}"
        );
        assert!(ticks < 4_000, "{id:#x} {value}: {ticks} ticks");
    }
    // The twin: pushes, and small moves to and fro, with the gains that belong to it.
    let mut twin = ready(&machine(20.0, 200e-9), &[]);
    for k in 0..40 {
        twin.push(if k % 2 == 0 { 1.0 } else { -1.0 });
        twin.run(150);
    }
    twin.push(0.0);
    for _ in 0..10 {
        assert_eq!(twin.error_after("MVR X 0.01"), "0");
        twin.run(300);
        assert_eq!(twin.error_after("MVR X -0.01"), "0");
        twin.run(300);
    }
    assert_eq!(twin.fault(), None);
}

/// Gains for a machine that is heavier and weaker by a third are twice as high, and so is what a count of noise makes of the voltage.
#[test]
fn gains_for_a_heavier_machine_are_no_frozen_encoder() {
    let scale = 1.35 / 0.65;
    let gains = [(0x5450_0301, 40.0 * scale), (0x5450_0302, 14_000.0 * scale)];
    let mut bench = ready(&machine(35.0, 30e-9), &gains);
    bench.run(400_000);
    assert_eq!(bench.fault(), None);
}

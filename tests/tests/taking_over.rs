//! The pose that the servo takes over, by referencing and by `SVO`: one that can be told and commanded again, where the
//! encoders say that the stage is.

use firmware::mode::Mode;
use firmware::parameters::Parameters;
use hal_sim::rig::run::{RunOptions, stage_parameters};
use kinematics::{Angle, direct};
use tests::Bench;

/// Seeds of the encoders' noise.
const SEEDS: u64 = 20;
/// Steps of what is told, in a mm and in a deg.
const STEPS: f64 = 1e6;
/// By how much the setpoint may be off the reading that it comes from: half a step, and the resolution of the tick's numbers, mm
/// and deg.
const ROUNDING: f64 = 0.5 / STEPS + 4e-7;

/// Just switched on, with noise of this seed.
fn stage(seed: u64) -> Bench {
    Bench::new(&stage_parameters(&RunOptions {
        seed,
        ..RunOptions::default()
    }))
}

/// mm and deg of 2^-32 track radii and turns.
fn units() -> [f64; 3] {
    let radius_mm = Parameters::REFERENCE.geometry.radius_mm;
    [radius_mm, radius_mm, 360.0].map(|whole| whole / 4_294_967_296.0)
}

/// The platform's setpoint, units.
fn setpoint(bench: &Bench) -> [i64; 3] {
    bench.sample().setpoint.position
}

/// The target.
fn target(bench: &mut Bench) -> [f64; 3] {
    ["X", "Y", "W"].map(|axis| bench.value(&format!("MOV? {axis}")))
}

/// Sends a line that switches the servo on, and holds the setpoint of the first tick that drives against the reading of the one
/// before, which took the command.
fn take_over(bench: &mut Bench, line: &str) {
    bench.send(&format!("{line}\n"));
    let mut pivots = None;
    for _ in 0..100 {
        bench.tick();
        if bench.mode() == Mode::Holding {
            break;
        }
        pivots = Some(bench.sample().pivots);
    }
    assert_eq!(bench.mode(), Mode::Holding);
    let pivots = pivots.expect("a tick before");
    let turns = pivots[0].turns();
    let whole = Angle::from_units(i64::from(turns) << 32);
    let pose = direct::<f64>(&pivots.map(|pivot| (pivot - whole).radians())).expect("a pose");
    let radius_mm = Parameters::REFERENCE.geometry.radius_mm;
    let w_deg = pose.theta.to_degrees() + f64::from(turns) * 360.0;
    let measured = [pose.x * radius_mm, pose.y * radius_mm, w_deg];
    for (i, unit) in units().into_iter().enumerate() {
        let step = setpoint(bench)[i] as f64 * unit - measured[i];
        // The turns are counted from the command on.
        let step = if i == 2 {
            step - (step / 360.0).round() * 360.0
        } else {
            step
        };
        assert!(step.abs() < ROUNDING, "{line}: {measured:?}, {step}");
    }
}

/// The target is a number of six decimals, it means the setpoint to the unit, and to command it sends nothing.
fn assert_is_told(bench: &mut Bench) {
    let told = target(bench);
    for (i, unit) in units().into_iter().enumerate() {
        let short = (told[i] * STEPS).round() / STEPS;
        // One in five hundred lies at the edge of what means the same unit: that is told with all its digits.
        let at_edge = (short / unit - setpoint(bench)[i] as f64).abs() > 0.499;
        assert!(told[i] == short || at_edge, "{told:?}");
        assert_eq!(setpoint(bench)[i], (told[i] / unit).round() as i64);
    }
    let before = (setpoint(bench), bench.sample().commands);
    let [x, y, w] = told;
    assert_eq!(bench.error_after(&format!("MOV X {x} Y {y} W {w}")), "0");
    assert_eq!((setpoint(bench), bench.sample().commands), before);
}

#[test]
fn what_referencing_takes_over_is_told() {
    for seed in 0..SEEDS {
        let mut bench = stage(seed);
        take_over(&mut bench, "FRF");
        assert_is_told(&mut bench);
    }
}

#[test]
fn right_after_referencing_the_centre_of_rotation_can_be_set() {
    for seed in 0..SEEDS {
        let mut bench = stage(seed);
        take_over(&mut bench, "FRF");
        let (told, before) = (target(&mut bench), setpoint(&bench));
        assert_eq!(bench.error_after("SPI R 20 S 10"), "0", "seed {seed}");
        assert_eq!(setpoint(&bench), before, "nothing moves");
        // W is some 1e-6 deg: X and Y are those of another point.
        for (now, told) in target(&mut bench).into_iter().zip(told) {
            assert!((now - told).abs() < 1e-5, "{now} {told}");
        }
    }
}

#[test]
fn what_a_servo_takes_over_that_goes_on_again_is_told() {
    let mut bench = stage(1);
    take_over(&mut bench, "FRF");
    assert_eq!(bench.error_after("MOV X 12.3 Y -7.5 W 1045.25"), "0");
    bench.settle();
    assert_eq!(bench.error_after("SVO X 0"), "0");
    // Friction lets go of what the motors held: some time to come to rest.
    bench.run(4_000);
    take_over(&mut bench, "SVO X 1");
    assert_is_told(&mut bench);
}

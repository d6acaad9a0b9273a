//! The pose that the servo takes over where it goes on.

use hal_sim::rig::run::{RunOptions, stage_parameters};
use tests::Bench;

/// Seeds of the encoders' noise.
const SEEDS: u64 = 20;

/// Just switched on, with noise of this seed.
fn stage(seed: u64) -> Bench {
    Bench::new(&stage_parameters(&RunOptions {
        seed,
        ..RunOptions::default()
    }))
}

/// The platform's setpoint, units.
fn setpoint(bench: &Bench) -> [i64; 3] {
    bench.sample().setpoint.position
}

/// The target.
fn target(bench: &mut Bench) -> [f64; 3] {
    ["X", "Y", "W"].map(|axis| bench.value(&format!("MOV? {axis}")))
}

#[test]
fn right_after_referencing_the_centre_of_rotation_can_be_set() {
    for seed in 0..SEEDS {
        let mut bench = stage(seed);
        assert_eq!(bench.error_after("FRF"), "0");
        let (told, before) = (target(&mut bench), setpoint(&bench));
        assert_eq!(bench.error_after("SPI R 20 S 10"), "0", "seed {seed}");
        assert_eq!(setpoint(&bench), before, "nothing moves");
        // W is some 1e-6 deg: X and Y are those of another point.
        for (now, told) in target(&mut bench).into_iter().zip(told) {
            assert!((now - told).abs() < 1e-5, "{now} {told}");
        }
    }
}

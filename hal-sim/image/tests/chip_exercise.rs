//! The comparison of chip and host, and that it can fail. Needs `cargo stage` first, then
//! `cargo chip-test --test chip_exercise`.

use firmware::mode::Mode;
use hal_sim::rig::run::RunOptions;
use image::chip::{Divergence, Exercise, ExerciseOptions, exercise};

fn exercised(ticks: u64, flip: Option<u64>, calibrated: bool) -> Exercise {
    let options = ExerciseOptions {
        ticks,
        run: RunOptions::default(),
        flip,
        calibrated,
    };
    println!("seed {}", options.run.seed);
    exercise(&options).expect("the image: build it with `cargo stage`")
}

#[test]
fn a_bit_of_an_encoder_count_flipped_on_the_host_is_found_at_its_tick() {
    const FLIPPED: u64 = 7_001;
    let found = exercised(10_000, Some(FLIPPED), false);
    let Some(Divergence::Hash { tick, chip, host }) = found.divergence else {
        panic!("{:?}", found.divergence);
    };
    assert_eq!((u64::from(tick), found.agreed), (FLIPPED, FLIPPED));
    assert_ne!(chip, host);
}

#[test]
fn chip_and_host_agree_through_new_targets_in_motion_and_a_broken_encoder() {
    let found = exercised(20_000, None, false);
    assert_eq!(found.divergence, None);
    assert_eq!((found.agreed, found.tally.all().ticks), (20_000, 20_000));
    let in_motion = (found.tally.by_doing())
        .find(|(doing, _)| doing.commanded && doing.mode == Mode::Moving)
        .map_or(0, |(_, cost)| cost.ticks);
    assert!(in_motion > 3, "{found:?}");
}

#[test]
fn chip_and_host_agree_on_a_calibrated_machine() {
    let found = exercised(8_000, None, true);
    assert_eq!(found.divergence, None);
    assert_eq!(found.agreed, 8_000);
    let in_motion = found
        .tally
        .by_doing()
        .filter(|(doing, _)| doing.mode == Mode::Moving);
    assert!(
        in_motion.map(|(_, cost)| cost.ticks).sum::<u64>() > 5_000,
        "{found:?}"
    );
}

//! A built machine with its calibration in the controller: true poses against commanded ones, what is refused, what is
//! kept, and that a calibration of nothing changes no bit.

use desk::calibrate::lines;
use firmware::calibration::MachineCalibration;
use hal_sim::machine::devices::StageParameters;
use hal_sim::rig::{built_stage, calibration_told};
use tests::Bench;
use tests::calibrated::nothing_off;

/// Targets on the rim, in the middle, and many turns away.
const TARGETS: [[f64; 3]; 7] = [
    [0.0, 0.0, 0.0],
    [79.9, 0.0, 45.0],
    [-40.0, 69.0, -100.0],
    [-40.0, -69.0, 230.0],
    [25.0, -30.0, 1234.5],
    [0.0, 79.9, -725.0],
    [10.0, 5.0, 3.0],
];

fn give(bench: &mut Bench, calibration: &MachineCalibration) {
    assert_eq!(bench.error_after("CCL 1 ADVANCED"), "0");
    for line in lines(calibration) {
        assert_eq!(bench.error_after(&line), "0", "{line}");
    }
}

fn referenced(stage: &StageParameters, calibration: Option<&MachineCalibration>) -> Bench {
    let mut bench = Bench::new(stage);
    bench.run(100);
    if let Some(calibration) = calibration {
        give(&mut bench, calibration);
    }
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    bench
}

/// Ticks over which a pose at rest is averaged: what is left of noise is no error of the calibration.
const AVERAGED_TICKS: usize = 4_000;

/// Where the platform is in the mean, m and rad.
fn mean_pose(bench: &mut Bench) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for _ in 0..AVERAGED_TICKS {
        bench.run(1);
        let pose = bench.rig.front.stage.plant.pose();
        sum = [0, 1, 2].map(|k| sum[k] + pose[k]);
    }
    sum.map(|sum| sum / AVERAGED_TICKS as f64)
}

/// Largest distance and angle between where the platform is and where it was sent, m and rad.
fn worst_miss(bench: &mut Bench) -> [f64; 2] {
    let mut worst = [0.0_f64; 2];
    for [x, y, w] in TARGETS {
        assert_eq!(bench.error_after(&format!("MOV X {x} Y {y} W {w}")), "0");
        bench.settle();
        bench.run(2_000);
        assert_eq!(bench.fault(), None, "{x} {y} {w}");
        let [tx, ty, tw] = mean_pose(bench);
        let miss_m = (tx - x * 1e-3).hypot(ty - y * 1e-3);
        worst[0] = worst[0].max(miss_m);
        worst[1] = worst[1].max((tw - w.to_radians()).abs());
        // What the controller says is where it is.
        let told = bench.value("POS? X") * 1e-3;
        println!(
            "{x} {y} {w}: {:.1} nm, told {:.1} nm off",
            miss_m * 1e9,
            (told - tx) * 1e9
        );
    }
    println!(
        "worst: {:.1} nm, {:.3} urad",
        worst[0] * 1e9,
        worst[1] * 1e6
    );
    worst
}

#[test]
fn a_calibrated_machine_is_where_it_was_sent() {
    let stage = built_stage(&StageParameters::REFERENCE);
    let before = worst_miss(&mut referenced(&stage, None));
    assert!(before[0] > 50e-6 && before[1] > 300e-6, "{before:?}");
    let calibration = calibration_told(&stage);
    let after = worst_miss(&mut referenced(&stage, Some(&calibration)));
    assert!(after[0] < 1.2e-9 && after[1] < 1.1e-8, "{after:?}");
}

/// As large as encoders usually are off their rings' centres: 400 urad once a turn, 80 times what the default has.
#[test]
fn a_machine_with_encoders_off_their_centres_is_referenced_in_any_turn() {
    let mut stage = built_stage(&StageParameters::REFERENCE);
    for (encoder, phase_rad) in stage.encoders.iter_mut().zip([0.3, 2.1, 4.7]) {
        encoder.eccentricity_rad = 4e-4;
        encoder.eccentricity_phase_rad = phase_rad;
    }
    let after = worst_miss(&mut referenced(&stage, Some(&calibration_told(&stage))));
    assert!(after[0] < 1.2e-9 && after[1] < 1.1e-8, "{after:?}");
}

/// Two machines tick by tick: one that has a calibration of nothing, and one that has none.
#[test]
fn a_calibration_of_nothing_changes_no_bit() {
    let stage = StageParameters::REFERENCE;
    let mut with = Bench::new(&stage);
    let mut without = Bench::new(&stage);
    for bench in [&mut with, &mut without] {
        bench.run(100);
    }
    give(&mut with, &nothing_off());
    // As long as that took.
    while without.sample().tick < with.sample().tick {
        without.tick();
    }
    for bench in [&mut with, &mut without] {
        bench.send("FRF\nMOV X 40 Y -20 W 200\n");
    }
    for _ in 0..20_000 {
        with.tick();
        without.tick();
        let (one, other) = (with.sample(), without.sample());
        assert_eq!(one.pivot_setpoints, other.pivot_setpoints);
        assert_eq!((one.duty, one.pivots), (other.duty, other.pivots));
    }
    assert_eq!(with.say("POS?\n"), without.say("POS?\n"));
}

#[test]
fn all_of_it_is_taken_or_nothing() {
    let stage = built_stage(&StageParameters::REFERENCE);
    let calibration = calibration_told(&stage);
    let mut bench = Bench::new(&stage);
    bench.run(100);
    let all = lines(&calibration);
    assert_eq!(bench.error_after(&all[0]), "60");
    assert_eq!(bench.error_after("CCL 1 ADVANCED"), "0");
    assert_eq!(bench.error_after("CAL BEG SIM2 2026-11-23"), "4010");
    // Nothing was begun.
    assert_eq!(bench.error_after(&all[1]), "89");
    assert_eq!(bench.error_after(all.last().unwrap()), "89");
    let mut end_after = |left_out: usize| {
        for (i, line) in all.iter().enumerate() {
            if i != left_out && i + 1 < all.len() {
                assert_eq!(bench.error_after(line), "0", "{line}");
            }
        }
        let end = if left_out == 0 {
            "CAL END 17"
        } else {
            all.last().unwrap()
        };
        bench.error_after(end)
    };
    assert_eq!(end_after(7), "4008");
    assert_eq!(end_after(usize::MAX), "0");
    assert!(
        bench
            .say("CAL?\n")
            .starts_with("STATE=ON \nSERIAL=SIM \nDATE=2026-11-23 \nTEMPERATURE=20.5 \nCHECKSUM=")
    );
    // Absurd numbers, with the right checksum; the one before stays.
    let mut absurd = calibration.clone();
    absurd.numbers[1][0] = 0.5;
    for line in lines(&absurd) {
        let wanted = if line.starts_with("CAL END") {
            "4009"
        } else {
            "0"
        };
        assert_eq!(bench.error_after(&line), wanted, "{line}");
    }
    let checksum = format!("CHECKSUM={}\n", calibration.checksum());
    assert!(bench.say("CAL?\n").ends_with(&checksum));
    // Not with the servo on.
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    for line in ["CAL OFF", "CAL ON", "CAL DEL"] {
        assert_eq!(bench.error_after(line), "89", "{line}");
    }
}

#[test]
fn it_is_kept_over_a_restart_and_counts_from_the_start() {
    let stage = built_stage(&StageParameters::REFERENCE);
    let calibration = calibration_told(&stage);
    let mut bench = referenced(&stage, Some(&calibration));
    let told = bench.say("CAL?\n");
    assert_eq!(bench.error_after("SVO X 0"), "0");
    bench.run(4_000);
    bench.reset("power");
    bench.run(100);
    assert_eq!(bench.say("CAL?\n"), told);
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    let after = worst_miss(&mut bench);
    assert!(after[0] < 1.2e-9, "{after:?}");
    // Off, and off after another start.
    assert_eq!(bench.error_after("SVO X 0"), "0");
    bench.run(4_000);
    assert_eq!(bench.error_after("CCL 1 ADVANCED\nCAL OFF"), "0");
    bench.run(4_000);
    bench.reset("power");
    bench.run(100);
    assert!(bench.say("CAL?\n").starts_with("STATE=OFF"));
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    assert_eq!(bench.say("POS?\n"), bench.say("CAL POS?\n"));
    assert!(worst_miss(&mut bench)[0] > 50e-6);
}

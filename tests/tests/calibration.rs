//! A built machine with its calibration in the controller: true poses against commanded ones, what is refused, what is
//! kept, and that a calibration of nothing changes no bit.

use desk::calibrate::lines;
use firmware::calibration::MachineCalibration;
use firmware::control::CalibrationInForce;
use hal_sim::machine::devices::StageParameters;
use hal_sim::rig::{built_stage, calibration_told};
use kinematics::Geometry;
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

/// What tables of accuracy command a machine by is what the tick does, to the bit.
#[test]
fn held_encoders_are_those_of_the_tick() {
    let stage = built_stage(&StageParameters::REFERENCE);
    for calibration in [calibration_told(&stage), nothing_off()] {
        let mut bench = referenced(&stage, Some(&calibration));
        let (of_tick, margins) = calibration.for_tick(&Geometry::REFERENCE).unwrap();
        let in_force = CalibrationInForce {
            is_on: !of_tick.are_zero(),
            calibration: of_tick,
            margins,
        };
        for [x, y, w] in TARGETS {
            assert_eq!(bench.error_after(&format!("MOV X {x} Y {y} W {w}")), "0");
            bench.settle();
            let sample = bench.sample();
            let held = in_force.held_encoders(&sample.setpoint.position);
            assert_eq!(held, Some(sample.pivot_setpoints), "{x} {y} {w}");
        }
    }
}

/// All lengths of a machine that is warmer by some K.
fn grown(stage: &StageParameters, times: f64) -> StageParameters {
    let mut stage = *stage;
    stage.plant.track_radius_m *= times;
    for pivot in &mut stage.plant.pivots {
        pivot.radius_error_m *= times;
        pivot.guide_offset_m *= times;
        pivot.ring_centre_m = pivot.ring_centre_m.map(|m| m * times);
        pivot.runout_m = pivot.runout_m.map(|pair| pair.map(|m| m * times));
        pivot.straightness_m = pivot.straightness_m.map(|m| m * times);
    }
    stage
}

/// 12 ppm per K and 4 K: 3.8 um on the rim, none of it left where the temperature is told.
#[test]
fn a_warm_machine_is_where_it_was_sent() {
    let stage = built_stage(&StageParameters::REFERENCE);
    let calibration = calibration_told(&stage);
    let mut bench = referenced(&grown(&stage, 1.0 + 4.0 * 12e-6), Some(&calibration));
    let untold = worst_miss(&mut bench);
    assert!((3.7e-6..4.0e-6).contains(&untold[0]), "{untold:?}");
    assert_eq!(
        bench.say("TMP?\n"),
        "TEMPERATURE=UNKNOWN \nGROWTH=0 \nSTATE=UNKNOWN\n"
    );
    let before = bench.sample().pivot_setpoints;
    assert_eq!(bench.error_after("TMP 24.5 12"), "0");
    assert_eq!(
        bench.say("TMP?\n"),
        "TEMPERATURE=24.5 \nGROWTH=12 \nOVER=4.000 \nSTATE=OFF\n"
    );
    bench.run(1_000);
    assert_eq!(bench.sample().pivot_setpoints, before);
    let told = worst_miss(&mut bench);
    assert!(told[0] < 1.33e-9 && told[1] < 1.14e-8, "{told:?}");
    // What is recorded is in the same lengths as what is told.
    let [told_mm, target_mm] = ["POS? Y", "MOV? Y"].map(|query| bench.value(query));
    assert!((told_mm - target_mm).abs() < 1e-5, "{told_mm} {target_mm}");
    let events = bench.say("EVT?\n");
    let warning = "4.0 K over the temperature of the calibration";
    assert!(events.contains(warning), "{events}");
    // The growth stays; within 2 K there is nothing to warn of.
    assert_eq!(bench.error_after("TMP 22"), "0");
    assert!(
        bench
            .say("TMP?\n")
            .ends_with("GROWTH=12 \nOVER=1.500 \nSTATE=CALIBRATED\n")
    );
    let events = bench.say("EVT?\n");
    assert!(
        events.contains("at the temperature of the calibration again"),
        "{events}"
    );
}

#[test]
fn what_is_no_temperature_is_refused() {
    let stage = built_stage(&StageParameters::REFERENCE);
    let mut bench = referenced(&stage, Some(&calibration_told(&stage)));
    for (line, error) in [
        ("TMP -51", "17"),
        ("TMP 101", "17"),
        ("TMP 20 51", "17"),
        ("TMP 20 -1", "17"),
        ("TMP", "24"),
        ("TMP 20 12 3", "24"),
    ] {
        assert_eq!(bench.error_after(line), error, "{line}");
    }
    assert!(bench.say("TMP?\n").starts_with("TEMPERATURE=UNKNOWN"));
    // Not on the way, where half of it would be in other lengths.
    bench.send("MOV X 50\n");
    bench.run(400);
    assert_eq!(bench.error_after("TMP 24 12"), "53");
    bench.settle();
    // Nor while a point beside the platform's centre is moved, which the tick knows in track radii. Without growth it is the same point.
    assert_eq!(bench.error_after("SPI R 10 S 5"), "0");
    bench.run(100);
    assert_eq!(bench.error_after("TMP 24"), "0");
    assert_eq!(bench.error_after("TMP 24 12"), "34");
    assert!(bench.say("TMP?\n").contains("GROWTH=0 "));
}

/// The measured pose by the drawing beside that of the built machine, in one record.
#[test]
fn both_poses_are_recorded() {
    let stage = built_stage(&StageParameters::REFERENCE);
    let mut bench = referenced(&stage, Some(&calibration_told(&stage)));
    assert_eq!(bench.error_after("MOV X 30 Y -20 W 100"), "0");
    bench.settle();
    let setup = "DRC 1 X 2 2 X 210 3 Y 210 4 W 210 5 0 0 6 0 0 7 0 0 8 0 0";
    assert_eq!(bench.error_after(setup), "0");
    assert_eq!(bench.error_after("DRT 0 4 0"), "0");
    bench.run(4_000);
    let record = bench.say("DRR? 1 1 1 2 3 4\n");
    let row = record.lines().last().expect("a row");
    let row: Vec<f64> = (row.split_whitespace())
        .map(|number| number.parse().expect("a number"))
        .collect();
    assert!((row[0] - row[1]).abs() > 1e-3, "{row:?}");
    assert!((row[0] - bench.value("POS? X")).abs() < 1e-5);
    let drawn = bench.say("CAL POS?\n");
    for (i, letter) in [(1, "X="), (2, "Y="), (3, "W=")] {
        let line = drawn.lines().find(|line| line.starts_with(letter));
        let value: f64 = line.unwrap()[2..].trim().parse().unwrap();
        assert!(
            (row[i] - value).abs() < 1e-4,
            "{letter}: {} {value}",
            row[i]
        );
    }
}

//! What the data recorder says of a move, against what the simulator knows of the same ticks.

use firmware::mode::Mode;
use hal_sim::rig::run::{RunOptions, stage_parameters};
use tests::Bench;

const TURN: f64 = 4_294_967_296.0;
const TICKS: usize = 2_000;

/// One tick, from outside the controller: setpoint and true pose (mm, mm, deg), first pivot's error (deg), duty, state.
struct Truth {
    setpoint: [f64; 3],
    pose: [f64; 3],
    pivot_error_deg: f64,
    duty: f64,
    moving: bool,
}

/// One tick; the true pose is that at the encoders' latch, before it.
fn tick(bench: &mut Bench) -> Truth {
    let [x, y, theta] = bench.rig.front.stage.latched_pose();
    bench.tick();
    let sample = bench.sample();
    let [px, py, turns] = sample.setpoint.position.map(|units| units as f64 / TURN);
    Truth {
        setpoint: [px * 100.0, py * 100.0, turns * 360.0],
        pose: [x * 1e3, y * 1e3, theta.to_degrees()],
        pivot_error_deg: (sample.pivots[0] - sample.pivot_setpoints[0]).units() as f64 / TURN
            * 360.0,
        duty: f64::from(sample.duty[0].0) / 4200.0,
        moving: sample.mode == Mode::Moving,
    }
}

#[test]
fn a_record_is_what_happened() {
    let mut bench = Bench::ready();
    // Two turns away: what is recorded has fewer bits than that.
    assert_eq!(bench.error_after("MOV W 730"), "0");
    bench.settle();
    let setup = "DRC 1 X 1 2 Y 1 3 W 1 4 X 2 5 Y 2 6 W 2 7 1 3 8 1 73";
    assert_eq!(bench.error_after(setup), "0");
    assert_eq!(
        bench.error_after(&format!("SPA 1 0x16000201 {TICKS}\nDRT 0 2")),
        "0"
    );
    bench.send("MOV X 12 Y -7 W 1000\n");
    let mut truth: Vec<Truth> = Vec::new();
    while truth.iter().filter(|tick| tick.moving).count() < TICKS {
        truth.push(tick(&mut bench));
    }
    truth.retain(|tick| tick.moving);
    let answer = bench.say("DRR?\n");
    let (_, rows) = answer.split_once("# END_HEADER \n").expect("a head");
    assert_eq!(rows.lines().count(), TICKS);
    let mut worst_real = 0.0_f64;
    for (at, (row, truth)) in rows.lines().zip(&truth).enumerate() {
        let row: Vec<f64> = (row.split_whitespace())
            .map(|number| number.parse().expect("a number"))
            .collect();
        for i in 0..3 {
            // Half of what is recorded, 0.1 nm and 12 nrad, and half a last digit.
            let recorded_fine = [1e-7, 1e-7, 7e-7][i];
            let off = (row[i] - truth.setpoint[i]).abs();
            assert!(off < recorded_fine, "row {at}: setpoint {i} off by {off:e}");
            worst_real = worst_real.max((row[3 + i] - truth.pose[i]).abs());
        }
        assert!((row[6] - truth.pivot_error_deg).abs() < 1e-9, "row {at}");
        assert!((row[7] - truth.duty).abs() < 1e-9, "row {at}");
    }
    // Encoders a few counts (5e-6 deg, 9.4 nm) off by noise, and rings off the platform by their transmission.
    println!("real position off the plant's by {worst_real:e} mm or deg at most");
    assert!(worst_real < 1.31e-5, "{worst_real:e}");
}

/// What the recorder says of the servos against `LST?`, at rest after moves on a machine that is off the model: another way out of the tick.
#[test]
fn what_was_learnt_is_recorded() {
    let mut bench = Bench::new(&stage_parameters(&RunOptions {
        mismatch_percent: 20.0,
        ..RunOptions::default()
    }));
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    for line in ["MOV X 20 Y 5 W 30", "MOV X -20 Y -5 W -30"] {
        bench.say(&format!("{line}\n"));
        bench.settle();
    }
    bench.run(20_000);
    assert_eq!(bench.error_after("SPA 1 0x16000201 20"), "0");
    for pivot in 1..=3 {
        let tables = "DRC 1 {} 207 2 {} 208 3 {} 209 4 {} 205 5 {} 206 6 0 0 7 0 0 8 0 0";
        let setup = tables.replace("{}", &pivot.to_string());
        assert_eq!(bench.error_after(&setup), "0");
        assert_eq!(bench.error_after("DRT 0 4"), "0");
        bench.run(30);
        let told = bench.say("LST?\n");
        let answer = bench.say("DRR?\n");
        let row = answer.trim_end().lines().last().expect("a row");
        let recorded: Vec<f64> = (row.split_whitespace())
            .map(|number| number.parse().expect("a number"))
            .collect();
        let numbers = |name: &str| -> Vec<f64> {
            let name = format!("{name}{pivot}=");
            let line = told.lines().find_map(|line| line.strip_prefix(&name));
            (line.expect("it is told").split_whitespace())
                .map(|number| number.parse().expect("a number"))
                .collect()
        };
        let mut expected = numbers("LEARNT")[..3].to_vec();
        expected.extend(numbers("INTEGRAL"));
        expected.extend(numbers("CURRENT"));
        println!("pivot {pivot}: {recorded:?}, {expected:?}");
        // Half a millisecond lies between the two: friction is learnt, and the integral collects. Current has the loop's noise.
        for (k, off) in [1e-5, 1e-5, 5e-3, 5e-2, 5e-2].into_iter().enumerate() {
            assert!(
                (recorded[k] - expected[k]).abs() < off,
                "pivot {pivot}, table {}",
                k + 1
            );
        }
        assert!(recorded[1].abs() > 0.05, "nothing learnt: {recorded:?}");
    }
}

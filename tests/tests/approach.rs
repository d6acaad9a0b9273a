//! Lost motion of guides that give way under their carriages' friction, and what arriving from one side leaves of it.

use firmware::mode::Mode;
use hal_sim::machine::devices::StageParameters;
use tests::Bench;

/// In the middle, and where pivots stand close together and far apart.
const TARGETS: [[f64; 3]; 4] = [
    [0.0, 0.0, 20.0],
    [30.0, -20.0, 100.0],
    [-55.0, 40.0, -140.0],
    [10.0, 70.0, 250.0],
];
/// From where the stage comes, mm and deg.
const SIDES: [[f64; 3]; 6] = [
    [2.0, 0.0, 0.0],
    [-2.0, 0.0, 0.0],
    [0.0, 2.0, 0.0],
    [0.0, -2.0, 0.0],
    [0.0, 0.0, 3.0],
    [0.0, 0.0, -3.0],
];
/// What an approach may take, ms.
const MOST_MS: f64 = 12.0;
const AVERAGED_TICKS: usize = 2_000;

/// 1 N over 50 N/um, and nothing else that hides it.
fn unkind() -> StageParameters {
    let mut stage = StageParameters::REFERENCE;
    let on = &mut stage.plant.imperfections;
    on.guide_friction = true;
    on.guide_compliance = true;
    stage
}

fn referenced() -> Bench {
    let mut bench = Bench::new(&unkind());
    bench.run(100);
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    bench
}

fn move_to(bench: &mut Bench, [x, y, w]: [f64; 3]) {
    assert_eq!(bench.error_after(&format!("MOV X {x} Y {y} W {w}")), "0");
    bench.settle();
    bench.run(1_000);
    assert_eq!(bench.fault(), None);
}

/// Where the platform is in the mean, m.
fn mean_place(bench: &mut Bench) -> [f64; 2] {
    let mut sum = [0.0; 2];
    for _ in 0..AVERAGED_TICKS {
        bench.run(1);
        let [x, y, _] = bench.rig.front.stage.plant.pose();
        sum = [sum[0] + x, sum[1] + y];
    }
    sum.map(|sum| sum / AVERAGED_TICKS as f64)
}

/// Places of a target, arrived at from all sides, from their mean: rms over all targets, m.
fn scatter_m(bench: &mut Bench) -> f64 {
    let (mut square, mut count) = (0.0, 0.0);
    for target in TARGETS {
        let places = SIDES.map(|side| {
            move_to(bench, [0, 1, 2].map(|k| target[k] + side[k]));
            move_to(bench, target);
            mean_place(bench)
        });
        let mean = [0, 1].map(|k| places.iter().map(|place| place[k]).sum::<f64>() / 6.0);
        for [x, y] in places {
            square += (x - mean[0]).powi(2) + (y - mean[1]).powi(2);
            count += 1.0;
        }
    }
    f64::sqrt(square / count)
}

#[test]
fn from_one_side_motion_is_not_lost() {
    let mut bench = referenced();
    let from_any_side_m = scatter_m(&mut bench);
    assert_eq!(bench.error_after("APP 30"), "0");
    assert_eq!(bench.say("APP?\n"), "30\n");
    let from_one_side_m = scatter_m(&mut bench);
    println!(
        "from any side {:.1} nm, from one {:.2} nm",
        from_any_side_m * 1e9,
        from_one_side_m * 1e9
    );
    assert!(from_any_side_m > 10e-9);
    assert!(from_one_side_m < 0.2 * from_any_side_m);
}

/// Longer than straight to the target, ms, in the mean of all targets.
#[test]
fn it_takes_its_time() {
    let mut bench = referenced();
    let mut taken_ms = |line: &str| {
        assert_eq!(bench.error_after(line), "0");
        let mut ticks = 0;
        for [x, y, w] in TARGETS {
            let from = bench.sample().tick;
            assert_eq!(bench.error_after(&format!("MOV X {x} Y {y} W {w}")), "0");
            bench.settle();
            ticks += bench.sample().tick - from;
        }
        ticks as f64 / (TARGETS.len() as f64 * 20.0)
    };
    // From the last target to the first each time.
    taken_ms("APP 0");
    let (straight_ms, beside_ms) = (taken_ms("APP 0"), taken_ms("APP 30"));
    println!("straight {straight_ms:.0} ms, from beside {beside_ms:.0} ms");
    assert!((1.0..=MOST_MS).contains(&(beside_ms - straight_ms)));
}

/// It is no part of a motion that is stopped, or followed by another one, on the way to where the last way begins.
#[test]
fn a_stop_is_the_end_of_it() {
    let mut bench = referenced();
    assert_eq!(bench.error_after("APP 30"), "0");
    assert_eq!(bench.error_after("MOV X 20 Y 5 W 30"), "0");
    bench.run(400);
    assert_eq!(bench.error_after("HLT"), "10");
    bench.settle();
    let stopped = bench.value("POS? X");
    bench.run(10_000);
    assert_eq!(bench.mode(), Mode::Holding);
    assert!((bench.value("POS? X") - stopped).abs() < 1e-4);
    assert!((1.0..19.0).contains(&stopped), "{stopped}");
    // Another target on the way: the last one counts.
    assert_eq!(bench.error_after("MOV X -20 Y 5 W 30"), "0");
    bench.run(400);
    assert_eq!(bench.error_after("MOV X 12 Y -7 W 10"), "0");
    bench.settle();
    bench.run(2_000);
    assert!((bench.value("POS? X") - 12.0).abs() < 1e-4);
    assert!((bench.value("POS? Y") + 7.0).abs() < 1e-4);
    assert_eq!(bench.value("MOV? X"), 12.0);
    // On target means at the target, not beside it: nothing is left to come.
    assert_eq!(bench.error_after("MOV X 13"), "0");
    bench.settle();
    assert!((bench.value("POS? X") - 13.0).abs() < 1e-4);
}

/// Off again, every bit is as without; and a way that is none is refused.
#[test]
fn without_it_nothing_changes() {
    let (mut with, mut without) = (referenced(), referenced());
    assert_eq!(with.error_after("APP 201"), "17");
    assert_eq!(with.error_after("APP -1"), "17");
    assert_eq!(with.error_after("APP 50"), "0");
    assert_eq!(with.error_after("APP 0"), "0");
    while without.sample().tick < with.sample().tick {
        without.tick();
    }
    for bench in [&mut with, &mut without] {
        bench.send("MOV X 40 Y -20 W 200\n");
    }
    for _ in 0..10_000 {
        with.tick();
        without.tick();
        let (one, other) = (with.sample(), without.sample());
        assert_eq!(one.pivot_setpoints, other.pivot_setpoints);
        assert_eq!((one.duty, one.pivots), (other.duty, other.pivots));
    }
}

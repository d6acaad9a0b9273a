//! The encoders latch one right after the other: what a pivot turns meanwhile is taken off by rate.

use firmware::parameters::Parameters;
use hal_sim::machine::devices::StageParameters;
use hal_sim::machine::plant::Imperfections;
use tests::Bench;

const TRACK_RADIUS_M: f64 = 0.1;
const COUNTS_PER_RAD: f64 = 67_108_864.0 / std::f64::consts::TAU;

/// The pivots of a pose (m, m, rad) on a machine as drawn, rad.
fn pivots([x, y, theta]: [f64; 3]) -> [f64; 3] {
    [-30.0f64, 90.0, 210.0].map(|degrees| {
        let guide = theta + degrees.to_radians();
        guide + ((y * guide.cos() - x * guide.sin()) / TRACK_RADIUS_M).asin()
    })
}

/// What the controller takes each pivot to be over what it was when the first encoder latched, counts, at worst over a turn at full
/// speed on a machine without flaws.
fn worst_off(stage: &StageParameters, told: &Parameters) -> [f64; 3] {
    let mut stage = *stage;
    stage.plant.imperfections = Imperfections::NONE;
    let mut bench = Bench::told(&stage, told);
    bench.run(20);
    assert_eq!(bench.error_after("FRF"), "0");
    // Without friction nothing takes away what the test of the leads has stirred up.
    bench.run(1_000);
    assert_eq!(bench.error_after("JOG W 360"), "0");
    bench.run(10_000);
    let mut worst = [0.0f64; 3];
    for _ in 0..2_000 {
        let was = pivots(bench.rig.front.stage.latched_pose());
        bench.tick();
        let taken = bench.sample().pivots;
        for (worst, (taken, was)) in worst.iter_mut().zip(taken.iter().zip(was)) {
            *worst = worst.max((COUNTS_PER_RAD * (taken.radians() - was)).abs());
        }
    }
    worst
}

#[test]
fn pivots_that_latch_one_after_the_other_are_those_of_one_instant() {
    let off = worst_off(&StageParameters::REFERENCE, &Parameters::REFERENCE);
    println!("{off:?} counts");
    // Half a count is the encoder's.
    assert!(off.iter().all(|off| *off < 0.65), "{off:?}");
}

/// The offset is a port's, whichever pivot is plugged in there.
#[test]
fn it_is_the_port_that_latches_late() {
    let mut stage = StageParameters::REFERENCE;
    stage.wiring.port_of_ring = [2, 0, 1];
    let mut told = Parameters::REFERENCE;
    told.wiring.encoder_order = 312;
    let off = worst_off(&stage, &told);
    println!("{off:?} counts");
    assert!(off.iter().all(|off| *off < 0.65), "{off:?}");
}

/// The twin: encoders that do latch together, which the controller does not expect. At 6.28 rad/s a count is 14.9 ns.
#[test]
fn what_is_not_taken_off_shows() {
    let mut stage = StageParameters::REFERENCE;
    stage.latch_offsets_s = [0.0; 3];
    let off = worst_off(&stage, &Parameters::REFERENCE);
    println!("{off:?} counts");
    assert!(off[0] < 0.65, "{off:?}");
    assert!((3.8..4.7).contains(&off[1]), "{off:?}");
    assert!((7.8..8.7).contains(&off[2]), "{off:?}");
}

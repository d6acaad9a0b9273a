//! Turning slowly, where the motors' ripple is slow enough for the loop and yet is most of what is left of the error.

use hal_sim::rig::Told;
use hal_sim::rig::run::{RunOptions, controller_parameters, stage_parameters};
use tests::Bench;

/// Root mean square of the pivots' following errors over two seconds at 1 rad/s, encoder counts.
fn error(mismatch_percent: f64, told: Told) -> f64 {
    let options = RunOptions {
        mismatch_percent,
        ..RunOptions::default()
    };
    let stage = stage_parameters(&options);
    let parameters = told.parameters(&controller_parameters(&options), &stage);
    let mut bench = Bench::told(&stage, &parameters);
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    assert_eq!(bench.error_after("JOG W 57.29578"), "0");
    bench.run(20_000);
    let error = bench.rms_error(40_000);
    assert_eq!(bench.fault(), None);
    error
}

#[test]
fn ripple_that_is_told_leaves_less_than_a_count_at_a_radian_a_second() {
    for (mismatch_percent, most) in [(0.0, 0.51), (20.0, 0.51), (-20.0, 0.58)] {
        let [without, with] =
            [Told::Machine, Told::MachineAndRipple].map(|told| error(mismatch_percent, told));
        println!("{mismatch_percent} %: {without:.3} without, {with:.3} counts rms");
        // 6.2, 5.4 and 7.6 without.
        assert!(with < most && without > 5.0, "{with} of {without}");
    }
}

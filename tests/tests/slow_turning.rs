//! Turning slowly, where the motors' ripple is slow enough for the loop and yet is most of what is left of the error.

use firmware::parameters::Parameters;
use hal_sim::rig::run::{RunOptions, controller_parameters, stage_parameters};
use hal_sim::rig::{with_machine_told, with_ripple_told};
use tests::Bench;

/// Root mean square of the pivots' following errors over two seconds at 1 rad/s, encoder counts.
fn errors(mismatch_percent: f64, has_ripple_told: bool) -> f64 {
    let options = RunOptions {
        mismatch_percent,
        ..RunOptions::default()
    };
    let stage = stage_parameters(&options);
    let mut parameters: Parameters = with_machine_told(&controller_parameters(&options), &stage);
    if has_ripple_told {
        parameters = with_ripple_told(&parameters, &stage);
    }
    let mut bench = Bench::told(&stage, &parameters);
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    assert_eq!(bench.error_after("JOG W 57.29578"), "0");
    bench.run(20_000);
    let (mut sum, mut count) = (0.0, 0.0);
    for _ in 0..40_000 {
        bench.tick();
        let sample = bench.sample();
        for (pivot, setpoint) in sample.pivots.iter().zip(&sample.pivot_setpoints) {
            let counts = (*pivot - *setpoint).units() as f64 / 64.0;
            sum += counts * counts;
            count += 1.0;
        }
    }
    assert_eq!(bench.fault(), None);
    (sum / count).sqrt()
}

#[test]
fn ripple_that_is_told_leaves_less_than_a_count_at_a_radian_a_second() {
    for (mismatch_percent, most) in [(0.0, 0.51), (20.0, 0.51), (-20.0, 0.58)] {
        let [without, with] = [false, true].map(|told| errors(mismatch_percent, told));
        println!("{mismatch_percent} %: {without:.3} without, {with:.3} counts rms");
        // 6.2, 5.4 and 7.6 without.
        assert!(with < most && without > 5.0, "{with} of {without}");
    }
}

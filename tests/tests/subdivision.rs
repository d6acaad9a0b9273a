//! Errors of the encoders within the periods of their scales: what of them is left on the platform where the controller knows them, and
//! that they are no oscillation then.

use firmware::fault::FaultKind;
use firmware::parameters::Parameters;
use hal_sim::machine::devices::StageParameters;
use hal_sim::machine::plant::Imperfections;
use hal_sim::rig::with_subdivision_told;
use tests::Bench;

/// Poses at rest, and the ticks over which each is averaged.
const POSES: usize = 24;
const AVERAGED_TICKS: usize = 1_000;

/// The reference stage, which is kind, with errors of 0.8 urad within the periods.
fn stage() -> StageParameters {
    let mut stage = StageParameters::REFERENCE;
    stage.plant.imperfections = Imperfections {
        subdivisional_error: true,
        ..Imperfections::CALIBRATED
    };
    stage
}

fn referenced(stage: &StageParameters, parameters: &Parameters) -> Bench {
    let mut bench = Bench::told(stage, parameters);
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    bench
}

/// Root mean squares of the platform's place and angle off where it was sent, m and rad.
fn misses(bench: &mut Bench) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for i in 0..POSES {
        let turned = i as f64;
        let [x, y, w] = [
            60.0 * (1.7 * turned).sin(),
            45.0 * (2.3 * turned).cos(),
            7.3 * turned,
        ];
        assert_eq!(bench.error_after(&format!("MOV X {x} Y {y} W {w}")), "0");
        bench.settle();
        bench.run(2_000);
        let mut sum = [0.0; 3];
        for _ in 0..AVERAGED_TICKS {
            bench.tick();
            let pose = bench.rig.front.stage.plant.pose();
            sum = [0, 1, 2].map(|k| sum[k] + pose[k] / AVERAGED_TICKS as f64);
        }
        sums[0] += (sum[0] - x * 1e-3).powi(2) + (sum[1] - y * 1e-3).powi(2);
        sums[1] += (sum[2] - w.to_radians()).powi(2);
    }
    sums.map(|sum| (sum / POSES as f64).sqrt())
}

#[test]
fn a_platform_whose_encoders_are_corrected_is_where_it_was_sent() {
    let stage = stage();
    let parameters = Parameters::REFERENCE;
    let before = misses(&mut referenced(&stage, &parameters));
    let told = with_subdivision_told(&parameters, &stage);
    let after = misses(&mut referenced(&stage, &told));
    println!("{before:?} m and rad before, {after:?} after");
    // 69.5 nm and 225 nrad; 0.76 nm and 3.9 nrad.
    assert!(before[0] > 62e-9 && before[1] > 200e-9, "{before:?}");
    assert!(after[0] < 0.84e-9 && after[1] < 4.4e-9, "{after:?}");
}

/// At 4.2 rad/s the error has 10.5 kHz, just over half the rate of the ticks: readings go to and fro by as much as it is large, and the
/// velocity gain makes an oscillation of that where the threshold is the least.
#[test]
fn an_error_that_aliases_is_no_oscillation_where_it_is_known() {
    let stage = stage();
    let mut parameters = Parameters::REFERENCE;
    parameters.supervision.oscillation_v = 0.5;
    let told = with_subdivision_told(&parameters, &stage);
    let fault = |parameters: &Parameters| {
        let mut bench = referenced(&stage, parameters);
        assert_eq!(bench.error_after("JOG W 240.64"), "0");
        let mut rate_rad_s = 0.0;
        for _ in 0..40_000 {
            if bench.fault().is_none() {
                rate_rad_s = bench.sample().pivot_rates[0];
            }
            bench.tick();
        }
        println!("{:?} at {rate_rad_s} rad/s", bench.fault());
        (bench.fault_kind(), rate_rad_s)
    };
    let (kind, rate_rad_s) = fault(&parameters);
    // On the way up, at 8.3 kHz.
    assert!(kind == Some(FaultKind::Oscillation) && rate_rad_s > 3.0);
    let (kind, rate_rad_s) = fault(&told);
    assert!(kind.is_none() && rate_rad_s > 4.1);
}

/// Two machines tick by tick: one whose encoders have known scales and no error, and one of which nothing is known.
#[test]
fn a_correction_of_nothing_changes_no_bit() {
    let stage = StageParameters::REFERENCE;
    let mut parameters = Parameters::REFERENCE;
    for subdivision in &mut parameters.subdivision {
        subdivision.periods = 15_708;
    }
    let [with, without] = [&parameters, &Parameters::REFERENCE].map(|parameters| {
        let mut bench = Bench::told(&stage, parameters);
        bench.run(100);
        bench.send("FRF\nMOV X 40 Y -20 W 200\n");
        bench.run(30_000);
        assert_eq!(bench.fault(), None);
        (0..3)
            .map(|_| {
                bench.tick();
                let sample = bench.sample();
                (sample.pivots, sample.duty, sample.setpoint)
            })
            .collect::<Vec<_>>()
    });
    assert_eq!(with, without);
}

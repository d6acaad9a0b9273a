//! Parameters set on a running controller reach its loop.

use firmware::control::config::Config;
use firmware::fault::FaultKind;
use firmware::mode::Mode;
use firmware::parameters::Parameters;
use firmware::queues::Command;
use tests::Bench;
use tests::ideal::Ideal;

/// Referenced, holding, at level 1.
fn advanced() -> Bench {
    let mut bench = Bench::ready();
    assert_eq!(bench.error_after("CCL 1 ADVANCED"), "0");
    bench
}

/// Largest following error, encoder counts, of a move with `settings` set before it.
fn error_with(settings: &str) -> u64 {
    let mut bench = advanced();
    assert_eq!(bench.error_after(settings), "0");
    bench.forget_errors();
    assert_eq!(bench.error_after("MOV X 20 W 30"), "0");
    bench.settle();
    bench.worst_error_counts()
}

#[test]
fn gains_set_while_holding_change_the_next_move() {
    let before = error_with("");
    // Half the position and velocity gain, nothing learnt, no integral to speak of.
    let weak = error_with("SPA 1 0x54500300 150 1 0x54500301 20 1 0x54500302 100 1 0x54500303 0");
    assert!(weak > 28 * before, "{weak} counts, {before} before");
}

#[test]
fn setting_while_holding_does_not_move_the_stage() {
    let mut bench = advanced();
    bench.forget_errors();
    assert_eq!(
        bench.error_after("SPA 1 0x54500107 250 1 0x54500300 250 1 0x54500702 1 1 0x54500808 0.06"),
        "0"
    );
    bench.run(2_000);
    assert_eq!(bench.mode(), Mode::Holding);
    assert!(
        bench.worst_error_counts() <= 3,
        "{}",
        bench.worst_error_counts()
    );
}

#[test]
fn a_threshold_set_is_the_one_that_fires() {
    let move_with = |threshold_rad: f64| {
        let mut bench = advanced();
        let line = format!("SPA 1 0x54500500 {threshold_rad}");
        assert_eq!(bench.error_after(&line), "0");
        bench.forget_errors();
        bench.say("MOV X 20 W 30\n");
        bench.run(40_000);
        (bench.fault_kind(), bench.worst_error_counts())
    };
    let (fault, counts) = move_with(2e-3);
    assert_eq!(fault, None);
    let worst_rad = counts as f64 * std::f64::consts::TAU / f64::from(1 << 26);
    assert_eq!(
        move_with(worst_rad * 0.8).0,
        Some(FaultKind::FollowingError)
    );
    assert_eq!(move_with(worst_rad * 1.2).0, None);
}

#[test]
fn another_encoder_zero_takes_the_reference_and_moves_the_angle() {
    let mut bench = advanced();
    assert_eq!(bench.error_after("SPA 1 0x54500600 12345000"), "89");
    assert_eq!(bench.error_after("SVO X 0"), "0");
    let zeros: [u32; 3] = [12_345_678, 50_331_649, 67_000_000];
    // All three pivots a quarter of a turn further; the second one counts down.
    let quarter = 1 << 24;
    let count = |zero: u32| zero % (1 << 26);
    let line = format!(
        "SPA 1 0x54500600 {} 1 0x54500601 {} 1 0x54500602 {}",
        count(zeros[0] + (1 << 26) - quarter),
        count(zeros[1] + quarter),
        count(zeros[2] + (1 << 26) - quarter)
    );
    assert_eq!(bench.error_after(&line), "0");
    assert_eq!(bench.say("FRF? X\n"), "X=0\n");
    assert_eq!(bench.error_after("SVO X 1\nMOV X 0"), "5");
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    assert!(
        (bench.value("POS? W") - 90.0).abs() < 1.6e-5,
        "{}",
        bench.value("POS? W")
    );
    assert_eq!(bench.fault(), None);
    // Back: as it was.
    assert_eq!(bench.error_after("SVO X 0"), "0");
    assert_eq!(
        bench.error_after("SPA 1 0x54500600 12345678 1 0x54500601 50331649 1 0x54500602 67000000"),
        "0"
    );
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    let back_deg = bench.value("POS? W");
    assert!(back_deg.abs() < 2e-5, "{back_deg}");
}

/// Whoever asks, the loop itself takes constants only when they can do no harm.
#[test]
fn the_loop_takes_settings_only_at_rest_and_mountings_only_off() {
    let mut gains = Parameters::REFERENCE;
    gains.servo.gains[0].position_1_s = 250.0;
    let mut mounting = Parameters::REFERENCE;
    mounting.encoders[1].reversed = !mounting.encoders[1].reversed;
    let (gains, mounting) = (Config::new(&gains), Config::new(&mounting));
    for (line, mode, taken) in [
        (&b""[..], Mode::Off, [true, true]),
        (b"FRF\n", Mode::Holding, [true, false]),
        (b"FRF\nMOV X 50\n", Mode::Moving, [false, false]),
    ] {
        for (config, taken) in [&gains, &mounting].into_iter().zip(taken) {
            let mut stage = Ideal::new(1);
            stage.run(10);
            stage.ask(0, line);
            stage.run(100);
            let before = stage.rig.front.config.clone();
            assert_eq!(stage.sample().map(|sample| sample.mode), Some(mode));
            assert_eq!(stage.send(Command::Configure(config.clone())), Ok(()));
            stage.run(2);
            let wanted = if taken { config } else { &before };
            assert_eq!(&stage.rig.front.config, wanted, "{mode:?}");
        }
    }
}

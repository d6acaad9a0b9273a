//! How sharp the supervisor's thresholds are: how soon, how far, what a pause does, what a way back allows. Where `detections`
//! shows that a fault fires and its twin does not, these fail when a threshold is doubled or a count is not started anew.

use firmware::fault::FaultKind;
use firmware::mode::Mode;
use hal_sim::machine::devices::EncoderFault;
use tests::Bench;
use tests::trouble::PIVOT;

const FOLLOWING_ERROR: u32 = 0x5450_0500;
const LARGEST_RATE: u32 = 0x5450_0106;
const OVERSPEED: u32 = 0x5450_0505;
const FROZEN: u32 = 0x5450_0506;
const FROZEN_V: u32 = 0x5450_0507;
const OSCILLATION: u32 = 0x5450_0511;
const AT_END: u32 = 0x5450_0508;
const MOTOR_CURRENT: u32 = 0x5450_0509;
const MOTOR_HEATING: u32 = 0x5450_050A;
const LATE: u32 = 0x5450_050B;

/// The largest duty, and half a volt, PWM counts.
/// At 10 V of 48, which is 4.8 A of the motor: less than its current's limit.
const FULL: i16 = 875;
const HALF_A_VOLT: i16 = 43;
/// Ticks of one reading after which it is asked whether it should have changed, and what looking every fourth tick adds.
const SAME: u32 = 20;
const LOOKS: u32 = 6;
/// Noise of a duty at rest, in ticks of the rise of a voltage that moves nothing.
const SLACK: u32 = 14;

fn freeze(bench: &mut Bench, frozen: bool) {
    let fault = frozen.then_some(EncoderFault::Frozen);
    bench.rig.front.stage.encoders[PIVOT].set_fault(fault);
}

/// Ticks until there is a fault, which is of this kind.
#[track_caller]
fn ticks_to(bench: &mut Bench, kind: FaultKind) -> u32 {
    let before = bench.sample().tick;
    bench.run_until("found", |bench| bench.fault().is_some());
    assert_eq!(bench.fault_kind(), Some(kind));
    (bench.sample().tick - before) as u32
}

#[test]
fn a_motor_heats_in_its_time_and_is_no_fault_while_nothing_drives_it() {
    let limits = [(MOTOR_CURRENT, 1.0), (MOTOR_HEATING, 0.1)];
    let mut bench = Bench::holding(&limits);
    bench.push(2.9);
    let ticks = ticks_to(&mut bench, FaultKind::MotorHot);
    assert!((2_000..3_400).contains(&ticks), "{ticks}");
    // Hotter still at the end of a controlled stop.
    let mut bench = Bench::turning(&limits, 5.0);
    bench.push(2.9);
    ticks_to(&mut bench, FaultKind::MotorHot);
    assert_eq!(bench.mode(), Mode::Stopping, "on its path");
    bench.run_until("stopped", |bench| bench.mode() == Mode::Fault);
    bench.say("ERR?\nFLC\n");
    bench.run(50);
    assert_eq!((bench.mode(), bench.fault()), (Mode::Off, None));
}

#[test]
fn a_drive_may_be_at_its_end_for_as_long_as_it_says_and_a_pause_starts_anew() {
    let limits = [
        (FOLLOWING_ERROR, 0.05),
        (FROZEN, 0.05),
        (FROZEN_V, 36.0),
        (AT_END, 0.02),
        (0x5450_080D, 10.0),
    ];
    let mut bench = Bench::turning(&limits, 60.0);
    bench.jam();
    let mut ticks = 0;
    loop {
        bench.tick();
        if bench.fault().is_some() {
            break;
        }
        let is_full = bench.outputs.duty[PIVOT].0.abs() >= FULL;
        ticks = if is_full { ticks + 1 } else { 0 };
        assert!(ticks < 1_000);
    }
    assert_eq!(bench.fault_kind(), Some(FaultKind::Stalled));
    assert!((398..=406).contains(&ticks), "{ticks}");
    let mut twin = Bench::turning(&limits, 60.0);
    for _ in 0..3 {
        twin.jam_for(80);
        twin.run(400);
    }
    assert_eq!(twin.fault(), None);
}

#[test]
fn a_step_over_a_tick_that_did_not_come_is_no_overspeed() {
    let limits = [
        (FOLLOWING_ERROR, 0.05),
        (LARGEST_RATE, 5.5),
        (OVERSPEED, 1.05),
    ];
    let mut bench = Bench::turning(&limits, 300.0);
    for _ in 0..12 {
        bench.rig.front.miss_tick();
        bench.run(200);
    }
    assert_eq!(bench.fault(), None);
}

#[test]
fn a_frozen_encoder_is_found_by_the_way_its_setpoint_goes() {
    // 0.0002 rad at 0.3 deg/s.
    let mut bench = Bench::turning(&[(FROZEN_V, 36.0)], 0.3);
    freeze(&mut bench, true);
    let ticks = ticks_to(&mut bench, FaultKind::EncoderFrozen);
    assert!((760..760 + SAME).contains(&ticks), "{ticks}");
    // So little that the time alone counts.
    let mut bench = Bench::turning(&[(FROZEN_V, 36.0), (FROZEN, 2e-6)], 0.3);
    freeze(&mut bench, true);
    let ticks = ticks_to(&mut bench, FaultKind::EncoderFrozen);
    assert!((SAME..=SAME + LOOKS).contains(&ticks), "{ticks}");
    // The way counts from the last reading on.
    let mut twin = Bench::turning(&[(FROZEN_V, 36.0)], 0.3);
    for _ in 0..5 {
        freeze(&mut twin, true);
        twin.run(2 * SAME);
        freeze(&mut twin, false);
        twin.run(2_000);
    }
    assert_eq!(twin.fault(), None);
}

/// Ticks in which the duty has been further than half a volt from zero, or from what it was when the encoder froze, until that
/// is found; the stage turns slowly one way.
fn driven_ticks(bench: &mut Bench, before: i16, deg_s: f64) -> u32 {
    assert_eq!(bench.error_after(&format!("JOG W {deg_s}")), "0");
    let mut ticks = 0;
    loop {
        bench.tick();
        if bench.fault().is_some() {
            break;
        }
        let duty = bench.outputs.duty[PIVOT].0;
        let is_over = duty > before.max(0) + HALF_A_VOLT || duty < before.min(0) - HALF_A_VOLT;
        ticks = if is_over { ticks + 1 } else { 0 };
        assert!(bench.sample().tick < 200_000, "never found");
    }
    assert_eq!(bench.fault_kind(), Some(FaultKind::EncoderFrozen));
    ticks
}

#[test]
fn a_frozen_encoder_is_found_by_the_voltage_that_does_not_move_it() {
    // What holds against a push before it freezes is on neither side, on the same, or on the other.
    for (torque_n_m, deg_s) in [
        (0.0, 1.5),
        (0.0, -1.5),
        (3.0, 1.5),
        (-3.0, 1.5),
        (3.0, -1.5),
    ] {
        let mut bench = Bench::holding(&[(FROZEN, 0.05)]);
        bench.push(torque_n_m);
        bench.run(4_000);
        freeze(&mut bench, true);
        let before = bench.outputs.duty[PIVOT].0;
        let ticks = driven_ticks(&mut bench, before, deg_s);
        assert!(
            (SAME - SLACK..=SAME + SLACK).contains(&ticks),
            "{torque_n_m} N m, {deg_s} deg/s: {ticks}"
        );
    }
}

/// Where the servo is switched on anew, it is no longer what held before that a voltage is compared with.
#[test]
fn a_servo_that_is_switched_on_starts_anew() {
    for torque_n_m in [3.0, -3.0] {
        let mut bench = Bench::holding(&[(FROZEN, 0.05)]);
        bench.push(torque_n_m);
        bench.run(4_000);
        freeze(&mut bench, true);
        bench.run(100);
        let held = bench.outputs.duty[PIVOT].0;
        bench.say("SVO X 0\nDEL 5\nSVO X 1\n");
        // Further the way it was driven before.
        let deg_s = 1.5 * f64::from(held.signum());
        let ticks = driven_ticks(&mut bench, 0, deg_s);
        assert!(
            (SAME - SLACK..=SAME + SLACK).contains(&ticks),
            "{torque_n_m}: {ticks}"
        );
    }
}

#[test]
fn a_new_reading_ends_the_time_that_an_encoder_is_driven() {
    // What comes of it is an oscillation, too.
    let limits = [(FROZEN, 0.05), (FROZEN_V, 0.5), (OSCILLATION, 60.0)];
    let mut bench = Bench::turning(&limits, 1.5);
    for _ in 0..20 {
        freeze(&mut bench, true);
        bench.run(15);
        freeze(&mut bench, false);
        bench.run(30);
    }
    assert_eq!(bench.fault(), None);
}

#[test]
fn a_late_tick_is_forgiven_in_a_hundred() {
    let late_every = |ticks: u32| {
        let mut bench = Bench::turning(&[(LATE, 7.0)], 90.0);
        for _ in 0..60 {
            bench.rig.front.late = true;
            bench.run(1);
            bench.rig.front.late = false;
            bench.run(ticks - 1);
        }
        bench.fault_kind()
    };
    assert_eq!(late_every(75), Some(FaultKind::LoopLate));
    assert_eq!(late_every(101), None);
}

#[test]
fn a_supply_is_low_only_in_ticks_in_a_row_and_while_it_is_used() {
    let mut bench = Bench::turning(&[], 90.0);
    for _ in 0..10 {
        bench.rig.front.stage.set_supply_v(35.0);
        bench.run(3);
        bench.rig.front.stage.set_supply_v(48.0);
        bench.run(1);
    }
    assert_eq!(bench.fault(), None);
    let mut bench = Bench::default();
    bench.rig.front.stage.set_supply_v(30.0);
    bench.run(100);
    assert_eq!((bench.mode(), bench.fault()), (Mode::Off, None));
    bench.say("FRF\n");
    bench.run(10);
    assert_eq!(bench.fault_kind(), Some(FaultKind::SupplyLow));
}

/// Pushed harder and harder, a pivot is at fault as soon as it is off by as much as it may.
#[test]
fn a_following_error_is_found_at_its_limit() {
    for (deg_s, limit_rad) in [(0.0, 0.002), (120.0, 0.002 + 0.0001 * 120_f64.to_radians())] {
        let mut bench = match deg_s {
            0.0 => Bench::ready(),
            _ => Bench::turning(&[], deg_s),
        };
        bench.push(70.0);
        bench.run_until("found", |bench| bench.fault().is_some());
        let fault = bench.fault().expect("found");
        assert_eq!(fault.kind, FaultKind::FollowingError);
        let [value, limit] = [fault.value, fault.limit].map(f64::from);
        assert!((limit / limit_rad - 1.0).abs() < 7.5e-7, "{fault}");
        assert!((1.0..1.15).contains(&(value.abs() / limit)), "{fault}");
        assert_eq!(bench.mode(), Mode::Fault, "it brakes at once");
        assert!(bench.outputs.awake);
    }
}

/// Torques to and fro 40 times a second: at rest they can be nothing but a loop that oscillates, in motion they may be the
/// motion's.
#[test]
fn an_oscillation_counts_for_more_while_the_setpoint_hardly_moves() {
    let shaken = |deg_s: Option<f64>| {
        let limits = [(OSCILLATION, 1.0)];
        let mut bench =
            deg_s.map_or_else(|| Bench::holding(&limits), |w| Bench::turning(&limits, w));
        for k in 0..40 {
            bench.push(if k % 2 == 0 { 2.0 } else { -2.0 });
            bench.run(250);
        }
        bench.fault_kind()
    };
    assert_eq!(shaken(None), Some(FaultKind::Oscillation));
    assert_eq!(shaken(Some(0.5)), Some(FaultKind::Oscillation));
    assert_eq!(shaken(Some(60.0)), None);
}

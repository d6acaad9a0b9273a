//! What the supervisor finds out while the stage is driven: each fault fires, and its twin just under the threshold does not.
//! Through the simulated hardware and the firmware's own drivers; thresholds are set as a user sets them.

use firmware::fault::{FaultKind, Reaction};
use firmware::mode::Mode;
use hal_sim::machine::devices::{EncoderFault, StageParameters};
use tests::Bench;

const TURN: f64 = 4_294_967_296.0;
const FOLLOWING_ERROR: u32 = 0x5450_0500;
const FOLLOWING_ERROR_BY_RATE: u32 = 0x5450_0504;
const LARGEST_RATE: u32 = 0x5450_0106;
const OVERSPEED: u32 = 0x5450_0505;
const FROZEN: u32 = 0x5450_0506;
const AT_END: u32 = 0x5450_0508;
const MOTOR_CURRENT: u32 = 0x5450_0509;
const MOTOR_HEATING: u32 = 0x5450_050A;
const LATE: u32 = 0x5450_050B;

#[track_caller]
fn assert_fault(bench: &Bench, kind: FaultKind, pivot: Option<u8>) {
    let fault = bench.fault().unwrap_or_else(|| panic!("no {kind:?}"));
    assert_eq!((fault.kind, fault.pivot), (kind, pivot), "{fault}");
    // In so short a time a controlled stop is not over.
    let stops =
        kind.concerns_encoder() || matches!(kind, FaultKind::MotorHot | FaultKind::LoopLate);
    if !stops {
        assert_brakes(bench);
    }
    if fault.limit != 0.0 {
        let over = fault.value.abs() > fault.limit;
        assert_eq!(over, kind != FaultKind::PivotsTooClose, "{fault}");
    }
}

#[track_caller]
fn assert_brakes(bench: &Bench) {
    assert_eq!((bench.mode(), bench.outputs.awake), (Mode::Fault, true));
    assert!(bench.outputs.duty.iter().all(|duty| duty.0 == 0));
}

/// At rest, under servo or braked.
fn assert_at_rest(bench: &mut Bench) {
    bench.run(2_400);
    let rates = bench.rig.front.stage.plant.pivot_rates_rad_s();
    assert!(rates.iter().all(|rate| rate.abs() < 0.0052), "{rates:?}");
}

#[test]
fn the_following_error_may_be_larger_the_faster_it_goes() {
    // The same push leaves the same error at rest and in motion, over the limit of rest and under that of motion.
    let limits = [(FOLLOWING_ERROR, 2e-4), (FOLLOWING_ERROR_BY_RATE, 1e-3)];
    let mut bench = Bench::holding(&limits);
    bench.push_for(12.0, 2_000);
    assert_fault(&bench, FaultKind::FollowingError, Some(1));
    let mut twin = Bench::turning(&limits, 120.0);
    twin.push_for(12.0, 2_000);
    assert_eq!(twin.fault(), None);
    let mut twin = Bench::holding(&limits);
    twin.push_for(4.0, 2_000);
    assert_eq!(twin.fault(), None);
}

#[test]
fn an_encoder_that_freezes_is_found_whatever_the_pivot_does() {
    for (deg_s, most_ticks) in [(300.0, 6), (30.0, 6), (3.0, 6), (0.3, 1_000)] {
        let mut bench = Bench::turning(&[], deg_s);
        bench.rig.front.stage.encoders[1].set_fault(EncoderFault::Frozen);
        let before = bench.sample().tick;
        bench.run_until("found", |bench| bench.fault().is_some());
        assert_fault(&bench, FaultKind::EncoderFrozen, Some(1));
        let ticks = bench.sample().tick - before;
        assert!(ticks <= most_ticks, "{deg_s} deg/s: {ticks} ticks");
        bench.run_until("stopped", |bench| bench.mode() == Mode::Fault);
        assert_at_rest(&mut bench);
        assert_eq!(bench.say("FRF? W\n"), "W=0\n", "its turns are lost");
    }
    for deg_s in [300.0, 30.0, 3.0, 0.3] {
        // The twin: frozen for as many frames as are bridged.
        let mut twin = Bench::turning(&[], deg_s);
        for _ in 0..20 {
            twin.rig.front.stage.encoders[1].set_fault(EncoderFault::Frozen);
            twin.run(4);
            twin.rig.front.stage.encoders[1].set_fault(None);
            twin.run(100);
        }
        assert_eq!(twin.fault(), None, "{deg_s} deg/s");
    }
}

#[test]
fn an_encoder_that_has_frozen_at_rest_is_found_when_something_is_to_move() {
    for line in ["MOV X 10", "MOV W 0.02", "JOG W 0.01"] {
        let mut bench = Bench::ready();
        bench.rig.front.stage.encoders[1].set_fault(EncoderFault::Frozen);
        // Much longer, and the integral alone tells: the error that was there stays.
        bench.run(2_000);
        assert_eq!(bench.fault(), None, "as far as can be known");
        assert_eq!(bench.error_after(line), "0");
        bench.run_until("found", |bench| bench.fault().is_some());
        assert_fault(&bench, FaultKind::EncoderFrozen, Some(1));
        assert_at_rest(&mut bench);
        let [x, y, theta] = bench.rig.front.stage.plant.pose();
        assert!(
            x.hypot(y) < 1.1e-5 && theta.abs() < 5.8e-5,
            "{line}: {x} {y} {theta}"
        );
        let mut twin = Bench::ready();
        assert_eq!(twin.error_after(line), "0");
        twin.run(10_000);
        assert_eq!(twin.fault(), None);
    }
}

#[test]
fn an_encoder_that_jumps() {
    let jump = |counts: i32| {
        let mut bench = Bench::ready();
        bench.rig.front.stage.encoders[2].set_fault(EncoderFault::Jump { counts });
        bench.run(1_000);
        bench
    };
    assert_fault(&jump(40_000), FaultKind::EncoderJump, Some(2));
    // Under what acceleration could do in a tick, 1,330 counts.
    assert_eq!(jump(1_300).fault(), None);
}

#[test]
fn a_pivot_that_runs_away() {
    let limits = [
        (FOLLOWING_ERROR, 0.05),
        (LARGEST_RATE, 5.5),
        (OVERSPEED, 1.05),
    ];
    let pushed = |torque_n_m: f64| {
        let mut bench = Bench::turning(&limits, 300.0);
        bench.push_for(torque_n_m, 100);
        bench.run(100);
        bench
    };
    assert_fault(&pushed(40.0), FaultKind::Overspeed, Some(1));
    assert_eq!(pushed(10.0).fault(), None);
}

#[test]
fn pivots_that_come_too_close() {
    let pushed = |torque_n_m: f64, ticks: u32| {
        let mut bench = Bench::default();
        // A disk whose edge is where two pivots are 60 deg apart.
        bench.set(&[(FOLLOWING_ERROR, 0.05), (0x5450_0203, 60.0)]);
        assert_eq!(bench.error_after("FRF"), "0");
        bench.settle();
        // Away from guide 1, and so between pivots 2 and 3.
        assert_eq!(bench.error_after("MOV X -49.8 Y 28.75 W 0"), "0");
        bench.settle();
        // Slowly on its way: a controlled stop would take its time.
        assert_eq!(bench.error_after("JOG W 0.5"), "0");
        bench.run(1_000);
        bench.push_for(torque_n_m, ticks);
        bench
    };
    let mut bench = pushed(70.0, 400);
    assert_fault(&bench, FaultKind::PivotsTooClose, Some(1));
    assert_eq!(bench.mode(), Mode::Fault);
    assert_at_rest(&mut bench);
    let twin = pushed(12.0, 400);
    assert_eq!(twin.fault(), None);
}

#[test]
fn a_pivot_that_is_held_fast() {
    let jammed = |ticks: u32| {
        // Not to be taken for its encoder, which a jam holds as fast.
        let limits = [(FOLLOWING_ERROR, 0.05), (FROZEN, 0.05), (AT_END, 0.02)];
        let mut bench = Bench::turning(&limits, 60.0);
        bench.jam_for(ticks);
        bench.run(400);
        bench
    };
    let mut bench = jammed(1_000);
    assert_fault(&bench, FaultKind::Stalled, Some(1));
    assert_at_rest(&mut bench);
    // It takes some ticks for the error to ask for all the current there is, and as many to catch up.
    assert_eq!(jammed(100).fault(), None);
}

#[test]
fn a_motor_that_gets_too_hot() {
    let pushed = |torque_n_m: f64| {
        let mut bench = Bench::holding(&[(MOTOR_CURRENT, 1.0), (MOTOR_HEATING, 0.1)]);
        bench.push_for(torque_n_m, 15_000);
        bench
    };
    // The simulated motor gives 2.4 N m/A, and friction holds 0.12 N m of the push.
    assert_eq!(pushed(2.2).fault(), None);
    let mut bench = Bench::holding(&[(MOTOR_CURRENT, 1.0), (MOTOR_HEATING, 0.1)]);
    bench.push(2.9);
    bench.run_until("hot", |bench| bench.fault().is_some());
    bench.push(0.0);
    assert_fault(&bench, FaultKind::MotorHot, Some(1));
    assert_eq!(bench.mode(), Mode::Fault, "nothing was to be stopped");
    // Acknowledged, it is as warm as before: what took 2,700 ticks when it was cold takes a few hundred.
    assert_eq!(bench.error_after(""), "1024");
    bench.say("FLC\nSVO W 1\n");
    bench.push_for(2.9, 800);
    assert_fault(&bench, FaultKind::MotorHot, Some(1));
    bench.run(5_000);
    assert_eq!(bench.error_after(""), "1024");
    assert_eq!(bench.error_after("FLC\nFRF"), "0");
    bench.settle();
    assert_eq!(bench.fault(), None);
}

#[test]
fn a_loop_that_is_late() {
    let late = |ticks: u32| {
        let mut bench = Bench::turning(&[(LATE, 7.0)], 90.0);
        bench.rig.front.late = true;
        bench.run(ticks);
        bench.rig.front.late = false;
        bench.run(1);
        bench
    };
    let mut bench = late(8);
    assert_fault(&bench, FaultKind::LoopLate, None);
    assert_eq!(bench.mode(), Mode::Stopping);
    assert_eq!(bench.error_after("FLC"), "53", "not before it is at rest");
    bench.run(2_000);
    assert_eq!(bench.mode(), Mode::Fault);
    assert_eq!(bench.say("FRF? W\n"), "W=1\n", "nothing is lost");
    assert_eq!(bench.error_after("FLC"), "0");
    let mut twin = late(7);
    for _ in 0..50 {
        twin.run(100);
        twin.rig.front.late = true;
        twin.run(1);
        twin.rig.front.late = false;
    }
    assert_eq!(twin.fault(), None);
}

#[test]
fn a_supply_that_sags() {
    let sagged = |supply_v: f64, ticks: u32| {
        let mut bench = Bench::turning(&[], 90.0);
        bench.rig.front.stage.set_supply_v(supply_v);
        bench.run(ticks);
        bench.rig.front.stage.set_supply_v(48.0);
        bench.run(1);
        bench
    };
    let mut bench = sagged(35.9, 4);
    assert_fault_below(&bench, FaultKind::SupplyLow);
    assert_brakes(&bench);
    assert_at_rest(&mut bench);
    assert_eq!(sagged(35.9, 3).fault(), None);
    assert_eq!(sagged(36.1, 1_000).fault(), None);
}

#[track_caller]
fn assert_fault_below(bench: &Bench, kind: FaultKind) {
    let fault = bench.fault().unwrap_or_else(|| panic!("no {kind:?}"));
    assert_eq!(fault.kind, kind);
    assert!(fault.value < fault.limit, "{fault}");
}

#[test]
fn a_warning_is_told_as_an_event() {
    let mut bench = Bench::ready();
    bench.rig.front.stage.encoders[2].set_fault(EncoderFault::WarningBit);
    bench.run(10);
    bench.rig.front.stage.encoders[2].set_fault(None);
    bench.run(10);
    let events = bench.say("EVT?\n");
    assert!(events.contains("encoder warns, pivot 3 \n"), "{events}");
    assert!(
        events.contains("encoder warns no more, pivot 3\n"),
        "{events}"
    );
    assert_eq!(bench.fault(), None);
}

/// Bad frames that are bridged over and over are told from 12 on, and then every 10 s; a single disturbance is not.
#[test]
fn bursts_of_bad_frames_are_told_as_an_event() {
    let burst = |bench: &mut Bench| {
        bench.rig.front.stage.encoders[2].set_fault(EncoderFault::StuckHigh);
        bench.run(4);
        bench.rig.front.stage.encoders[2].set_fault(None);
        bench.run(40);
    };
    let told = |bench: &mut Bench| {
        let events = bench.say("EVT?\n");
        let lines = events.lines().filter(|line| line.contains("bridged"));
        lines.map(|line| line.trim().to_owned()).collect::<Vec<_>>()
    };
    let mut bench = Bench::ready();
    burst(&mut bench);
    burst(&mut bench);
    assert!(told(&mut bench).is_empty());
    (0..5).for_each(|_| burst(&mut bench));
    let lines = told(&mut bench);
    assert!(
        lines.len() == 1 && lines[0].ends_with("12 bad encoder frames bridged, pivot 3"),
        "{lines:?}"
    );
    bench.run(200_000);
    burst(&mut bench);
    let lines = told(&mut bench);
    assert!(
        lines.len() == 2 && lines[1].ends_with("bad encoder frames bridged, pivot 3"),
        "{lines:?}"
    );
    assert_eq!(bench.fault(), None);
}

/// A reading that steps as no pivot moves is told once, by how much; what a pivot may have moved is not, and no motion is.
#[test]
fn an_encoder_that_slips_is_told() {
    let told_after = |slip_rad: f64, bad_frames: u32| {
        let mut bench = Bench::ready();
        bench.say("MOV X 40 W 180\n");
        bench.run(3_000);
        let encoder = |bench: &mut Bench, fault: Option<EncoderFault>, offset_rad: f64| {
            let encoder = &mut bench.rig.front.stage.encoders[1];
            encoder.set_fault(fault);
            encoder.set_offset(offset_rad);
        };
        if bad_frames > 0 {
            encoder(&mut bench, Some(EncoderFault::StuckHigh), 0.0);
            bench.run(bad_frames);
        }
        encoder(&mut bench, None, slip_rad);
        bench.run(20_000);
        assert_eq!(bench.fault(), None);
        let events = bench.say("EVT?\n");
        let mut lines = events.lines().filter(|line| line.contains("stepped"));
        let (line, more) = (lines.next().map(str::to_owned), lines.next());
        assert_eq!(more, None);
        line
    };
    for (slip_rad, bad_frames) in [
        (12e-6, 0),
        (-12e-6, 0),
        (100e-6, 0),
        (50e-6, 1),
        (150e-6, 4),
        (-1.5e-3, 4),
    ] {
        let line = told_after(slip_rad, bad_frames).expect("an event");
        let told_urad: f64 = (line.split_once("stepped by ").expect("how far").1)
            .split_once(" urad, pivot 2: it slipped, or a blow")
            .and_then(|(number, _)| number.parse().ok())
            .expect("a number");
        // Noise, and what a pivot does meanwhile at 800 rad/s^2.
        let ticks = bad_frames + 1;
        let about_urad = 2.0 + 2.0 * f64::from(ticks * (ticks + 1) / 2);
        let off_urad = told_urad - slip_rad * 1e6;
        assert!(
            off_urad.abs() < about_urad,
            "{slip_rad} {bad_frames}: {line}"
        );
    }
    for (slip_rad, bad_frames) in [(0.0, 0), (0.0, 4), (4e-6, 0), (60e-6, 4)] {
        let line = told_after(slip_rad, bad_frames);
        assert_eq!(line, None, "{slip_rad} {bad_frames}");
    }
}

/// One that slips again by as much is told again, 10 s later.
#[test]
fn an_encoder_that_slips_twice_is_told_twice() {
    const SLIP_RAD: f64 = 30e-6;
    let mut bench = Bench::ready();
    for offset_rad in [SLIP_RAD, 2.0 * SLIP_RAD] {
        bench.rig.front.stage.encoders[1].set_offset(offset_rad);
        bench.run(100);
    }
    bench.run(200_000);
    let events = bench.say("EVT?\n");
    let told_urad: Vec<f64> = (events.lines())
        .filter_map(|line| line.split_once("stepped by "))
        .filter_map(|(_, behind)| behind.split_once(" urad, pivot 2"))
        .filter_map(|(number, _)| number.parse().ok())
        .collect();
    let is_one = |urad: &f64| (urad - SLIP_RAD * 1e6).abs() < 2.0;
    assert!(
        told_urad.len() == 2 && told_urad.iter().all(is_one),
        "{events}"
    );
    assert_eq!(bench.fault(), None);
}

/// The frame behind a slip says the same as the slip's where the encoder is quiet and the stage rests: that is no frozen encoder.
#[test]
fn an_encoder_that_slips_at_rest_is_not_taken_for_a_frozen_one() {
    let mut stage = StageParameters::REFERENCE;
    stage.plant.imperfections.encoder_noise = false;
    for slip_rad in [10e-6, 30e-6, 100e-6] {
        let mut bench = Bench::new(&stage);
        assert_eq!(bench.error_after("FRF"), "0");
        bench.settle();
        bench.forget_errors();
        bench.rig.front.stage.encoders[1].set_offset(slip_rad);
        bench.run(40);
        assert_eq!(bench.fault(), None, "{slip_rad}");
        // A frame that is bridged would go on by the slip once more.
        let slip_counts = (slip_rad / std::f64::consts::TAU * 67_108_864.0) as u64;
        let most = slip_counts + slip_counts / 4 + 4;
        assert!(
            bench.worst_error_counts() < most,
            "{slip_rad}: {}",
            bench.worst_error_counts()
        );
    }
}

/// What is told does not hang on what is believed: as much with the largest acceleration that may be called plausible, and nothing more.
#[test]
fn a_slip_is_told_whatever_is_plausible() {
    const PLAUSIBLE_ACCELERATION: u32 = 0x5450_0503;
    for (slip_rad, is_told) in [(12e-6, true), (4e-6, false)] {
        let mut bench = Bench::default();
        bench.run(10);
        bench.set(&[(PLAUSIBLE_ACCELERATION, 500_000.0)]);
        assert_eq!(bench.error_after("FRF"), "0");
        bench.settle();
        bench.rig.front.stage.encoders[1].set_offset(slip_rad);
        bench.run(40);
        let events = bench.say("EVT?\n");
        assert_eq!(events.contains("stepped"), is_told, "{slip_rad}: {events}");
    }
}

/// Where a parameter wants it, the emergency stop is tried after each start before anything drives.
#[test]
fn nothing_drives_before_the_emergency_stop_was_pressed_where_that_is_asked_for() {
    const STOP_TEST: u32 = 0x5450_0514;
    let mut bench = Bench::default();
    bench.run(10);
    bench.set(&[(STOP_TEST, 1.0)]);
    for line in ["FRF", "SVO X 1", "EXC STEP 1 1 10"] {
        assert_eq!(bench.error_after(line), "4007", "{line}");
    }
    bench.rig.front.emergency_stop = true;
    bench.run(20);
    bench.rig.front.emergency_stop = false;
    bench.run(20);
    assert_eq!(bench.error_after(""), "1024");
    assert_eq!(bench.error_after("FLC"), "0");
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    // Once for each start.
    bench
        .rig
        .reset("the watchdog: the control loop or the command side stood still");
    bench.reconnect();
    bench.run(20);
    bench.set(&[(STOP_TEST, 1.0)]);
    assert_eq!(bench.error_after("FRF"), "4007");
}

/// At the largest rate of a pivot each tick that does not come puts the setpoint 0.5 mrad behind the pivots: that is the loop's lateness,
/// and told as that.
#[test]
fn late_ticks_at_full_speed_are_no_following_error() {
    let mut bench = Bench::turning(
        &[(FOLLOWING_ERROR, 1e-3), (FOLLOWING_ERROR_BY_RATE, 0.0)],
        350.0,
    );
    let mut ticks = 0;
    while bench.fault().is_none() && ticks < 200 {
        if ticks % 2 == 0 {
            bench.rig.front.miss_tick();
        }
        bench.run(1);
        ticks += 1;
    }
    let fault = bench.fault().expect("a fault");
    println!("{fault} after {ticks} ticks");
    assert_eq!(fault.kind, FaultKind::LoopLate);
}

/// The stop stays on the line, and its setpoint is continuous up to the acceleration.
#[test]
fn a_controlled_stop_stays_on_its_path() {
    assert_eq!(FaultKind::LoopLate.reaction(), Reaction::Stop);
    let mut bench = Bench::ready();
    // Referencing has left the stage an LSB or so beside the origin.
    assert_eq!(bench.error_after("MOV X 0 Y 0"), "0");
    bench.settle();
    assert_eq!(bench.error_after("MOV X 60 Y 30"), "0");
    bench.run(3_000);
    let speed_mm_s = 100.0 * f64::from(bench.sample().setpoint.twist.x) / 2.0_f64.sqrt();
    assert!(speed_mm_s > 50.0, "{speed_mm_s}");
    bench.rig.front.late = true;
    bench.run_until("found", |bench| bench.mode() == Mode::Stopping);
    bench.rig.front.late = false;
    let start = bench.sample().setpoint;
    let mut last = start;
    let mut ticks = 0;
    while bench.mode() == Mode::Stopping {
        bench.tick();
        ticks += 1;
        let now = bench.sample().setpoint;
        let [x, y, _] = now.position.map(|units| units as f64 / TURN * 1e5);
        assert!(
            (y - x / 2.0).abs() < 2.6e-5,
            "off the line by {} um",
            y - x / 2.0
        );
        let moved = (now.position[0] - last.position[0]) as f64 / TURN * 20_000.0;
        let between = f64::from(now.twist.x + last.twist.x) / 2.0;
        // Two units of a position.
        assert!((moved - between).abs() < 9.4e-6, "{moved} {between}");
        let jerk = f64::from(now.acceleration.x - last.acceleration.x).abs() * 20_000.0;
        assert!(jerk < 3_280.0, "{jerk} track radii/s^3");
        last = now;
    }
    assert_eq!((bench.mode(), ticks), (Mode::Fault, 1_201));
    assert!(bench.worst_error_counts() < 313);
    assert_at_rest(&mut bench);
    let way_mm = (last.position[0] - start.position[0]) as f64 / TURN * 100.0;
    assert!((1.0..8.0).contains(&way_mm), "{way_mm} mm");
}

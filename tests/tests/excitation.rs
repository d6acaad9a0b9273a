//! Excitations (`EXC`): what they do to the machine, how they end, what they refuse; and connectors that belong to other pivots.

use firmware::fault::FaultKind;
use firmware::mode::Mode;
use firmware::parameters::Parameters;
use hal_sim::machine::devices::{StageParameters, WiringParameters};
use hal_sim::rig::run::{RunOptions, stage_parameters};
use tests::Bench;

/// A machine that nobody has commissioned, told to a connection of level 1.
fn uncommissioned(stage: &StageParameters) -> Bench {
    let mut bench = Bench::told(stage, &Parameters::REFERENCE.uncommissioned());
    bench.run(20);
    assert_eq!(bench.error_after("CCL 1 ADVANCED"), "0");
    bench
}

fn reference() -> StageParameters {
    stage_parameters(&RunOptions::default())
}

/// A value of `EXC?`.
fn told(bench: &mut Bench, name: &str) -> String {
    let answer = bench.say("EXC?\n");
    let line = (answer.lines()).find_map(|line| line.trim().strip_prefix(&format!("{name}=")));
    line.unwrap_or_else(|| panic!("no {name} in {answer}"))
        .to_owned()
}

/// Angles of the pivots, rad.
fn pivots(bench: &Bench) -> [f64; 3] {
    bench
        .sample()
        .pivots
        .map(|angle| angle.units() as f64 / 2f64.powi(32) * std::f64::consts::TAU)
}

/// Largest voltage of each motor while it lasts, and how far the pivots go.
fn run_to_the_end(bench: &mut Bench) -> ([i16; 3], [f64; 3]) {
    let (start, mut most) = (pivots(bench), [0_i16; 3]);
    bench.run_until("it begins", |bench| bench.mode() == Mode::Exciting);
    while bench.mode() == Mode::Exciting {
        let duty = bench.sample().duty.map(|duty| duty.0);
        for (most, duty) in most.iter_mut().zip(duty) {
            if duty.abs() > most.abs() {
                *most = duty;
            }
        }
        bench.tick();
    }
    bench.run(2_000);
    let end = pivots(bench);
    (most, [0, 1, 2].map(|i| end[i] - start[i]))
}

#[test]
fn a_step_drives_one_motor_for_its_time_and_needs_no_commissioned_machine() {
    let mut bench = uncommissioned(&reference());
    assert_eq!(bench.error_after("FRF"), "4005");
    assert_eq!(bench.error_after("EXC STEP 2 1.5 10"), "0");
    assert_eq!(told(&mut bench, "RUNS"), "1");
    let (duty, ways) = run_to_the_end(&mut bench);
    println!("{duty:?} {ways:?}");
    // 1.5 V of 48, in 4,200 counts.
    assert!((120..142).contains(&duty[1]) && duty[0] == 0 && duty[2] == 0);
    assert!(ways[1].abs() > 1e-4 && ways[1].abs() < 20e-3);
    assert_eq!((bench.mode(), bench.outputs.awake), (Mode::Off, false));
    assert_eq!(
        (told(&mut bench, "END"), told(&mut bench, "TICKS")),
        ("time".into(), "200".into())
    );
}

#[test]
fn a_ramp_ends_at_the_way_or_the_current_that_it_is_told() {
    let mut bench = uncommissioned(&reference());
    assert_eq!(bench.error_after("EXC RAMP 1 -1.6 300 1"), "0");
    let (_, ways) = run_to_the_end(&mut bench);
    println!("{ways:?}");
    assert_eq!(
        (told(&mut bench, "END"), told(&mut bench, "PIVOT")),
        ("way".into(), "1".into())
    );
    // Braked from there on.
    assert!((1e-3..2.5e-3).contains(&ways[0].abs()) && ways[0] < 0.0);
    let value: f64 = told(&mut bench, "VALUE").parse().expect("a number");
    assert!((1e-3..1.1e-3).contains(&value), "{value}");
    assert_eq!(bench.error_after("EXC STEP 3 2 20 15 0.3"), "0");
    run_to_the_end(&mut bench);
    assert_eq!(
        (told(&mut bench, "END"), told(&mut bench, "PIVOT")),
        ("current".into(), "3".into())
    );
    let value: f64 = told(&mut bench, "VALUE").parse().expect("a number");
    assert!((0.29..0.5).contains(&value), "{value}");
    assert_eq!(bench.fault(), None);
}

#[test]
fn a_ring_is_moved_by_its_servo_and_the_others_hold() {
    let mut bench = uncommissioned(&reference());
    // The second encoder of this machine counts down, and nobody has said so yet.
    bench.say("SPA 1 0x54500611 1\n");
    bench.run(20);
    assert_eq!(bench.error_after("EXC RING 2 1 50 400"), "0");
    bench.run_until("it begins", |bench| bench.mode() == Mode::Exciting);
    let start = pivots(&bench);
    bench.run(7_900);
    assert_eq!(bench.mode(), Mode::Exciting);
    let ways = [0, 1, 2].map(|i| pivots(&bench)[i] - start[i]);
    println!("{ways:?}");
    assert!((ways[1] - 1e-3).abs() < 2e-5 && ways[0].abs() < 2e-5 && ways[2].abs() < 2e-5);
}

/// Turned against what its encoder says, a servo runs away: as far as the guard lets it, at what the voltage lets it.
#[test]
fn a_servo_that_runs_away_is_a_fault_within_the_guard() {
    let mut stage = reference();
    stage.wiring.leads_exchanged = [true, false, false];
    let mut bench = uncommissioned(&stage);
    bench.say("SPA 1 0x54500611 1\n");
    bench.run(20);
    assert_eq!(bench.error_after("EXC RING 1 1 50 1000"), "0");
    let start = pivots(&bench);
    bench.run_until("it is found", |bench| bench.mode() == Mode::Fault);
    let fault = bench.fault().expect("a fault");
    println!("{fault:?}");
    assert_eq!(
        (fault.kind, fault.pivot),
        (FaultKind::ExcitationWay, Some(0))
    );
    assert!(fault.value > fault.limit);
    bench.run(4_000);
    let way = (pivots(&bench)[0] - start[0]).abs();
    assert!((0.012..0.02).contains(&way), "{way}");
    assert_eq!(told(&mut bench, "END"), "fault");
    assert_eq!(bench.error_after("FLC"), "0");
    // It is over: the next one may come.
    assert_eq!(told(&mut bench, "RUNS"), "0");
    assert_eq!(bench.error_after("EXC STEP 2 1 10"), "0");
}

/// Whatever ends it with the servo on, a fault or the servo off: it is over then.
#[test]
fn what_ends_the_servo_ends_it_too() {
    for ends in ["SVO X 0", "emergency stop"] {
        let mut bench = Bench::new(&reference());
        assert_eq!(bench.error_after("FRF"), "0");
        bench.settle();
        assert_eq!(bench.error_after("CCL 1 ADVANCED"), "0");
        assert_eq!(bench.error_after("EXC SINES 2 1.5 5000 20 400 12"), "0");
        bench.run(100);
        if ends == "emergency stop" {
            bench.rig.front.emergency_stop = true;
            bench.run(10);
            bench.rig.front.emergency_stop = false;
            bench.run(1_000);
            assert_eq!(told(&mut bench, "END"), "fault");
            assert_eq!(bench.error_after("FLC"), "0");
        } else {
            assert_eq!(bench.error_after(ends), "0");
            bench.run(2_000);
            assert_eq!(told(&mut bench, "END"), "stopped");
        }
        assert_eq!(told(&mut bench, "RUNS"), "0", "{ends}");
        assert_eq!(bench.mode(), Mode::Off, "{ends}");
        assert_eq!(bench.error_after("EXC STEP 2 1 10"), "0", "{ends}");
    }
}

#[test]
fn a_pivot_that_becomes_too_fast_is_a_fault() {
    let mut bench = uncommissioned(&reference());
    bench.say("SPA 1 0x54500D00 6 1 0x54500D01 1\n");
    bench.run(20);
    assert_eq!(bench.error_after("EXC STEP 1 6 200"), "0");
    bench.run_until("it is found", |bench| bench.mode() == Mode::Fault);
    let fault = bench.fault().expect("a fault");
    assert_eq!(fault.kind, FaultKind::Overspeed);
    assert!(
        (0.7..0.8).contains(&fault.value) && (fault.limit - 0.7).abs() < 1e-3,
        "{fault:?}"
    );
}

#[test]
fn a_stop_ends_it_and_so_does_the_servo_off() {
    for stop in ["STP", "HLT", "\x18", "SVO X 0"] {
        let mut bench = uncommissioned(&reference());
        assert_eq!(bench.error_after("EXC RAMP 1 0.05 5000"), "0");
        bench.run(500);
        assert_eq!(bench.mode(), Mode::Exciting);
        bench.say(&format!("{stop}\n"));
        bench.run(4);
        assert_eq!(bench.outputs.duty.map(|duty| duty.0), [0; 3]);
        // It brakes, then it lets go.
        assert_eq!(
            (bench.mode(), bench.outputs.awake),
            (Mode::Exciting, true),
            "{stop:?}"
        );
        bench.run(500);
        assert_eq!(
            (bench.mode(), bench.outputs.awake),
            (Mode::Off, false),
            "{stop:?}"
        );
        assert_eq!(told(&mut bench, "END"), "stopped");
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let mut bench = uncommissioned(&reference());
    for (line, error) in [
        ("EXC STEP 4 1 10", "17"),
        ("EXC STEP 1 2.1 10", "17"),
        ("EXC STEP 1 1 20001", "17"),
        ("EXC STEP 1 1 -1", "17"),
        ("EXC STEP 1 1 10 0", "17"),
        ("EXC STEP 1 1", "24"),
        ("EXC SINES 1 1 100 7 3 4", "17"),
        ("EXC SINES 1 1 100 7 9 17", "17"),
        ("EXC RING 1 1 800 100", "17"),
        ("EXC RING 1 4000 50 100", "17"),
        ("EXC JUMP 1 1 10", "1003"),
        ("SPA 1 0x54500620 113", "17"),
        ("SPA 1 0x54500630 124", "17"),
    ] {
        assert_eq!(bench.error_after(line), error, "{line}");
        assert_eq!(bench.mode(), Mode::Off);
    }
    assert_eq!(bench.error_after("EXC STEP 1 1 1000 10"), "0");
    assert_eq!(bench.error_after("EXC STEP 1 1 10"), "53");
    assert_eq!(bench.error_after("SPA 1 0x54500D00 1"), "53");
    assert_eq!(bench.error_after("STP"), "10");
    bench.run(1_000);
    assert_eq!(bench.error_after("CCL 0"), "0");
    assert_eq!(bench.error_after("EXC STEP 1 1 10"), "60");
}

/// With the servo on it is added to what the servo asks for, which goes on.
#[test]
fn with_the_servo_on_it_is_added_to_the_servos_voltage() {
    let mut bench = Bench::new(&reference());
    assert_eq!(bench.error_after("FRF"), "0");
    bench.settle();
    assert_eq!(bench.error_after("CCL 1 ADVANCED"), "0");
    assert_eq!(bench.error_after("EXC RING 1 1 50 100"), "89");
    // Ways and currents are watched with the servo off alone.
    assert_eq!(bench.error_after("EXC STEP 1 1 10 1"), "89");
    assert_eq!(bench.error_after("EXC RAMP 1 1 10 1 1"), "89");
    let rest = bench.rms_error(4_000);
    assert_eq!(bench.error_after("EXC SINES 2 1.5 409.6 20 400 12"), "0");
    bench.run(400);
    let excited = bench.rms_error(4_000);
    println!("{rest:.2} and {excited:.2} counts");
    assert!(excited > 20.0 * rest && bench.mode() == Mode::Holding);
    assert_eq!(told(&mut bench, "RUNS"), "1");
    bench.run(8_000);
    assert_eq!(
        (told(&mut bench, "RUNS"), told(&mut bench, "END")),
        ("0".into(), "time".into())
    );
    assert_eq!(told(&mut bench, "TICKS"), "8192");
    bench.settle();
    // Also in motion, and a stop ends it with the motion.
    assert_eq!(bench.error_after("JOG W 20"), "0");
    bench.run(2_000);
    assert_eq!(bench.error_after("EXC SINES 1 1 5000 20 400 12"), "0");
    bench.run(2_000);
    assert_eq!((bench.mode(), bench.fault()), (Mode::Moving, None));
    assert_eq!(bench.error_after("STP"), "10");
    bench.settle();
    assert_eq!(told(&mut bench, "END"), "stopped");
}

/// Whatever connectors the plugs are in: told of it, the controller's machine is the one that it is with straight wires.
#[test]
fn a_machine_that_is_wired_otherwise_is_the_same_once_told() {
    let straight = {
        let mut bench = Bench::new(&reference());
        bench.run(20);
        assert_eq!(bench.error_after("FRF"), "0");
        bench.say("MOV X 20 Y -10 W 45\nWAC ONT? W = 1\n");
        (
            bench.sample().pivots,
            bench.sample().duty,
            bench.sample().current_counts,
        )
    };
    let mut stage = reference();
    stage.wiring = WiringParameters {
        bridge_of_ring: [2, 0, 1],
        leads_exchanged: [true, false, true],
        port_of_ring: [1, 0, 2],
    };
    let mut told = Parameters::REFERENCE;
    told.wiring.bridge_order = 312;
    told.wiring.encoder_order = 213;
    told.wiring.motors_reversed = [true, false, true];
    let mut bench = Bench::told(&stage, &told);
    bench.run(20);
    assert_eq!(bench.error_after("FRF"), "0");
    bench.say("MOV X 20 Y -10 W 45\nWAC ONT? W = 1\n");
    let now = (
        bench.sample().pivots,
        bench.sample().duty,
        bench.sample().current_counts,
    );
    // To the bit it is not: other ports' encoders latch a tenth of a microsecond sooner or later.
    for pivot in 0..3 {
        let off = (now.0[pivot] - straight.0[pivot]).units();
        assert!(off.abs() <= 2 * 64, "{now:?}, {straight:?}");
        assert!(
            now.1[pivot].0.abs_diff(straight.1[pivot].0) < 100,
            "{now:?}, {straight:?}"
        );
    }
    // A bridge's fault is the pivot's that it drives.
    bench.rig.front.bridges[2].set_fault(true);
    bench.run(4);
    let fault = bench.fault().expect("a fault");
    assert_eq!((fault.kind, fault.pivot), (FaultKind::BridgeFault, Some(0)));
}

//! Every fault of the loop on the simulated machine: it fires, its twin just under the threshold does not, the motors go to
//! the safe state, and nothing moves until it is acknowledged.

use firmware::drivers::bridge::Duty;
use firmware::fault::FaultKind;
use firmware::mode::Mode;
use firmware::parameters::Parameters;
use hal_sim::machine::devices::{EncoderFault, StageParameters};
use hal_sim::machine::plant::External;
use hal_sim::rig::run::{RunOptions, stage_parameters};
use tests::Bench;

/// Bad frames in a row that are bridged.
const BRIDGED: u32 = Parameters::REFERENCE.supervision.bridged_frames as u32;

/// A flipped bit of the position.
const BAD_CRC: EncoderFault = EncoderFault::BadFrame { flip: 1 << 40 };

/// Ways for an encoder to be bad, and what they are called.
const BAD_FRAMES: [(EncoderFault, FaultKind); 5] = [
    (EncoderFault::StuckHigh, FaultKind::EncoderSilent),
    (EncoderFault::StuckLow, FaultKind::EncoderSilent),
    (BAD_CRC, FaultKind::EncoderCrc),
    (EncoderFault::ErrorBit, FaultKind::EncoderError),
    (
        EncoderFault::Jump { counts: 1_000_000 },
        FaultKind::EncoderJump,
    ),
];

/// So many bad frames in a row from one encoder; the loop has seen all of them afterwards, and no good one since.
fn bad_frames(bench: &mut Bench, encoder: usize, fault: EncoderFault, frames: u32) {
    for _ in 0..frames {
        bench.rig.front.stage.encoders[encoder].set_fault(fault);
        bench.tick();
    }
    bench.rig.front.stage.encoders[encoder].set_fault(None);
    bench.tick();
}

/// A stage in the middle of a move at full speed.
fn moving() -> Bench {
    let mut bench = Bench::ready();
    assert_eq!(bench.error_after("MOV X 60 Y 20 W 120"), "0");
    bench.run(3_000);
    assert_eq!(bench.mode(), Mode::Moving);
    bench.forget_errors();
    bench
}

/// Latched and safe: no duty, braking or coasting; refused until acknowledged, and then as good as new.
fn assert_safe_until_acknowledged(mut bench: Bench, kind: FaultKind, awake: bool) {
    assert_eq!(
        (bench.mode(), bench.fault_kind()),
        (Mode::Fault, Some(kind))
    );
    let told = if kind == FaultKind::FollowingError {
        "504"
    } else {
        "1024"
    };
    assert_eq!(
        bench.error_after(""),
        told,
        "{kind:?}: every connection is told"
    );
    for line in ["SVO X 1", "FRF", "MOV X 1", "MVR W 1"] {
        assert_eq!(bench.error_after(line), "1024", "{kind:?}: {line}");
    }
    for _ in 0..2_000 {
        bench.tick();
        assert_eq!(
            (bench.outputs.duty, bench.outputs.awake),
            ([Duty(0); 3], awake),
            "{kind:?}"
        );
        for bridge in &bench.rig.front.bridges {
            assert_eq!((bridge.state().pulse, bridge.state().awake), (0.0, awake));
        }
    }
    assert_eq!(bench.error_after("STP"), "0", "stopping always works");
    assert_eq!(bench.say("SVO? X\n"), "X=0\n");
    assert_eq!(bench.fault_kind(), Some(kind), "still latched");

    assert_eq!(bench.error_after("FLC"), "0");
    bench.tick();
    assert_eq!((bench.mode(), bench.fault()), (Mode::Off, None));
    assert!(!bench.outputs.awake, "off coasts");
    // Wherever it has coasted to or was pushed to, it can be moved back, from out of its reach by a recovery.
    if bench.error_after("FRF") == "4003" {
        assert_eq!(bench.error_after("RCV 1"), "0", "{kind:?}");
    }
    bench.run_until("held", |bench| bench.mode() == Mode::Holding);
    bench.settle();
    assert_eq!(bench.error_after("FRF"), "0", "{kind:?}");
    assert_eq!(bench.error_after("MOV X 0 Y 0 W 0"), "0");
    bench.settle();
    let off = bench.value("POS? X").abs();
    // An encoder LSB.
    assert!(off < 1.03e-5, "{kind:?}: {off}");
    assert_eq!(bench.fault(), None, "{kind:?}");
}

/// Runs on until the stage has come to rest.
fn coast(bench: &mut Bench) {
    bench.run(10_000);
}

/// What the board finds while it runs; and it stays, as what is found at the start.
#[test]
fn a_program_that_changes_lets_go_until_a_restart() {
    let mut bench = moving();
    bench.tick();
    assert_eq!(bench.fault(), None);
    bench.rig.front.program_damaged = true;
    bench.run(2);
    assert_eq!(bench.fault_kind(), Some(FaultKind::ImageDamaged));
    assert!(!bench.outputs.awake, "coasts");
    bench.rig.front.program_damaged = false;
    coast(&mut bench);
    for line in ["FLC", "FRF", "SVO X 1", "MOV X 1"] {
        bench.say(&format!("{line}\n"));
        bench.run(10);
        assert_eq!(bench.mode(), Mode::Fault, "{line}");
    }
    assert_eq!(bench.fault_kind(), Some(FaultKind::ImageDamaged));
}

#[test]
fn bad_frames_beyond_the_bridged_are_a_fault() {
    for (encoder, (fault, kind)) in BAD_FRAMES.into_iter().enumerate() {
        let encoder = encoder % 3;
        let mut bench = moving();
        bad_frames(&mut bench, encoder, fault, BRIDGED + 1);
        let latched = bench.fault().expect("a fault");
        assert_eq!((latched.kind, latched.pivot), (kind, Some(encoder as u8)));
        assert_eq!(bench.mode(), Mode::Stopping, "on its path");
        coast(&mut bench);
        assert_safe_until_acknowledged(bench, kind, true);
    }
}

#[test]
fn bridged_frames_in_a_move_are_no_fault_and_hardly_felt() {
    for (fault, kind) in BAD_FRAMES {
        let mut bench = moving();
        for encoder in 0..3 {
            bad_frames(&mut bench, encoder, fault, BRIDGED);
            bench.run(100);
        }
        bench.settle();
        assert_eq!(bench.fault(), None, "{kind:?}");
        assert!((bench.value("POS? X") - 60.0).abs() < 7.3e-6);
        assert!(
            bench.worst_error_counts() < 557,
            "{kind:?}: {} counts",
            bench.worst_error_counts()
        );
    }
}

#[test]
fn a_line_that_loses_every_other_frame_keeps_moving() {
    let mut bench = moving();
    for _ in 0..5_000 {
        bad_frames(&mut bench, 1, BAD_CRC, 1);
    }
    bench.settle();
    assert_eq!(bench.fault(), None);
    assert!(
        bench.worst_error_counts() < 557,
        "{} counts",
        bench.worst_error_counts()
    );
}

#[test]
fn a_bridge_that_pulls_its_fault_pin() {
    for axis in 0..3 {
        let mut bench = moving();
        bench.rig.front.bridges[axis].set_fault(true);
        bench.tick();
        assert_eq!(bench.fault(), None, "one tick is none");
        bench.tick();
        let fault = bench.fault().expect("a fault");
        assert_eq!(
            (fault.kind, fault.pivot),
            (FaultKind::BridgeFault, Some(axis as u8))
        );
        assert!(!bench.outputs.awake, "in the same tick");
        bench.rig.front.bridges[axis].set_fault(false);
        // All bridges let go: the stage coasts into friction or its end stops.
        bench.run(60_000);
        if axis == 0 {
            assert_safe_until_acknowledged(bench, FaultKind::BridgeFault, false);
        }
    }
}

/// Clients wait for the end of a motion by `#5`: it is told as long as the stage slides, and no longer.
#[test]
fn a_stage_that_slides_after_a_fault_is_told_as_moving() {
    let mut bench = moving();
    bench.rig.front.bridges[0].set_fault(true);
    bench.run(2);
    bench.rig.front.bridges[0].set_fault(false);
    let speed = |bench: &Bench| {
        let rates = bench.rig.front.stage.plant.pivot_rates_rad_s();
        rates
            .into_iter()
            .fold(0.0, |most: f64, rate| most.max(rate.abs()))
    };
    let begun = bench.sample().tick;
    let mut slid = 0;
    let mut at_rest = 0;
    while at_rest < 6_000 {
        assert!(bench.sample().tick < begun + 200_000, "it never rests");
        bench.run(100);
        let slides = speed(&bench) > 0.02;
        slid += u32::from(slides);
        at_rest = if slides { 0 } else { at_rest + 100 };
        assert!(
            !slides || bench.say("\x05") != "0\n",
            "{} rad/s",
            speed(&bench)
        );
    }
    // For longer than every fault is told as motion.
    assert!(slid > 30, "{slid}");
    assert_eq!(bench.say("\x05"), "0\n");
}

#[test]
fn a_bridge_fault_matters_only_while_driving() {
    let mut bench = Bench::default();
    bench.run(100);
    bench.rig.front.bridges[1].set_fault(true);
    bench.run(100);
    assert_eq!((bench.mode(), bench.fault()), (Mode::Off, None));
}

#[test]
fn the_emergency_stop() {
    let mut bench = moving();
    bench.rig.front.emergency_stop = true;
    bench.tick();
    assert_eq!(bench.fault_kind(), Some(FaultKind::EmergencyStop));
    assert_eq!(
        (bench.outputs.duty, bench.outputs.awake),
        ([Duty(0); 3], true),
        "brakes in the same tick"
    );
    coast(&mut bench);
    // Acknowledged while it is pressed, it is a fault again.
    assert_eq!(bench.error_after("FLC"), "1024");
    bench.run(10);
    assert_eq!(bench.mode(), Mode::Fault);
    bench.rig.front.emergency_stop = false;
    bench.run(1_000);
    assert_eq!(bench.error_after(""), "0");
    // Latched, pressed or not.
    assert_eq!(bench.fault_kind(), Some(FaultKind::EmergencyStop));
    assert_eq!(bench.error_after("MOV X 1"), "1024");
    assert_eq!(bench.error_after("FLC\nFRF"), "0");
    bench.settle();
    assert_eq!(bench.mode(), Mode::Holding);
}

#[test]
fn the_emergency_stop_holds_before_referencing_too() {
    let mut bench = Bench::default();
    bench.rig.front.emergency_stop = true;
    bench.run(10);
    assert_eq!(bench.fault_kind(), Some(FaultKind::EmergencyStop));
    assert_eq!(bench.error_after("FRF"), "1024");
}

/// A stage with another supply.
fn with_supply(supply_v: f64) -> Bench {
    let stage = stage_parameters(&RunOptions::default());
    let mut plant = stage.plant;
    plant.supply_v = supply_v;
    Bench::new(&StageParameters { plant, ..stage })
}

#[test]
fn a_low_supply() {
    let mut bench = with_supply(35.9);
    bench.say("FRF\n");
    bench.run(10);
    let fault = bench.fault().expect("a fault");
    assert_eq!(fault.kind, FaultKind::SupplyLow);
    assert!(
        (fault.value - 35.9).abs() < 0.018 && (fault.limit - 36.0).abs() < 0.0033,
        "{fault}"
    );
    assert!(bench.outputs.awake && bench.outputs.duty == [Duty(0); 3]);
    for line in ["FRF", "SVO X 1"] {
        assert_eq!(bench.error_after(line), "1024");
    }

    // The brake resistor is tested at servo on, and draws it down by 0.22 V.
    let mut twin = with_supply(36.3);
    assert_eq!(twin.error_after("FRF"), "0");
    twin.settle();
    assert_eq!(twin.error_after("MOV X 5"), "0");
    twin.settle();
    assert_eq!(twin.fault(), None);
}

#[test]
fn a_push_that_the_motors_cannot_hold() {
    let push = |torque_n_m: f64| {
        let mut bench = Bench::ready();
        bench.forget_errors();
        bench.rig.front.stage.plant.set_external(External {
            ring_torque_n_m: [0.0, torque_n_m, 0.0],
            ..External::default()
        });
        bench.run(4_000);
        bench
            .rig
            .front
            .stage
            .plant
            .set_external(External::default());
        bench
    };
    // 6 A at 2.4 N m/A (20 % under its model) are 14.4 N m.
    let twin = push(12.0);
    assert_eq!(twin.fault(), None, "{} counts", twin.worst_error_counts());
    assert_eq!(twin.mode(), Mode::Holding);

    let mut bench = push(65.0);
    let fault = bench.fault().expect("a fault");
    assert_eq!(fault.kind, FaultKind::FollowingError);
    assert!(
        fault.value.abs() > 2e-3 && (fault.limit - 2e-3).abs() < 1.1e-9,
        "{fault}"
    );
    coast(&mut bench);
    assert_safe_until_acknowledged(bench, FaultKind::FollowingError, true);
}

#[test]
fn silent_encoders_cannot_be_referenced() {
    for encoders in [&[0, 1, 2][..], &[1]] {
        let mut bench = Bench::default();
        for &i in encoders {
            bench.rig.front.stage.encoders[i].set_fault(EncoderFault::StuckHigh);
        }
        bench.run(100);
        assert_eq!(bench.error_after("FRF"), "45");
        assert_eq!(bench.error_after("MOV X 1"), "5");
        for _ in 0..1_000 {
            bench.tick();
            assert_eq!((bench.mode(), bench.fault()), (Mode::Off, None));
            assert_eq!(
                (bench.outputs.duty, bench.outputs.awake),
                ([Duty(0); 3], false)
            );
        }
        assert_eq!(bench.say("FRF? X\n"), "X=0\n");
        // The twin: the same stage with its encoders back.
        for &i in encoders {
            bench.rig.front.stage.encoders[i].set_fault(None);
        }
        bench.run(10);
        assert_eq!(bench.error_after("FRF"), "0");
        bench.settle();
        assert_eq!(bench.mode(), Mode::Holding);
    }
}

#[test]
fn a_warning_is_no_fault() {
    let mut bench = moving();
    for encoder in &mut bench.rig.front.stage.encoders {
        encoder.set_fault(EncoderFault::WarningBit);
    }
    bench.settle();
    assert_eq!(bench.fault(), None);
}

/// An encoder that was lost knows no turns afterwards: also when the fault that is latched is another one.
#[test]
fn an_encoder_lost_during_a_fault_takes_the_reference_and_one_that_is_bridged_does_not() {
    for (frames, referenced) in [(BRIDGED, "1"), (BRIDGED + 1, "0")] {
        let mut bench = Bench::ready();
        // Past where a single turn of the encoders would put it.
        assert_eq!(bench.error_after("MOV W 400"), "0");
        bench.settle();
        bench.rig.front.emergency_stop = true;
        bench.tick();
        bench.rig.front.emergency_stop = false;
        assert_eq!(bench.fault_kind(), Some(FaultKind::EmergencyStop));
        bad_frames(&mut bench, 0, BAD_CRC, frames);
        bench.run(10);
        bench.say("FLC\nERR?\n");
        assert_eq!(bench.say("FRF? W\n"), format!("W={referenced}\n"));
        assert_eq!(bench.error_after("FRF"), "0");
        bench.run(2_000);
        assert_eq!(bench.fault(), None);
    }
}

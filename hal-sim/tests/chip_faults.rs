//! Every fault of the loop that the emulated chip's surroundings can produce, made through its pins, lines and inputs under the
//! unmodified image in the middle of a move: it is latched and told over the serial line, and the bridges do what its kind
//! asks for. Its twin, just under the threshold, is no fault, and the stage drives on.
//!
//! What the bench does not model, and what therefore is not here: flash (its contents do not change, so nothing can be damaged
//! in it), a dip of the chip's own supply (brown-out), a broken crystal, single bits that flip in memory, bus errors of the
//! peripherals, and a program that runs wild. The emergency stop within a PWM period, silent encoders at start, a halted loop
//! and the restart by the watchdog are in `chip.rs`.
//!
//! Needs `cargo stage` first, then `cargo chip-test`.
#![cfg(feature = "chip")]

use firmware::parameters::Parameters;
use hal_sim::chip::{Action, Bench, Outcome, Period, image};
use hal_sim::devices::{BridgeState, EncoderFault, Stage, StageParameters};
use hal_sim::plant::External;
use std::num::NonZeroU64;
use std::ops::ControlFlow::{self, Break, Continue};
use std::sync::mpsc;

/// Bad frames in a row that are bridged.
const BRIDGED: u64 = Parameters::REFERENCE.supervision.bridged_frames as u64;
/// A flipped bit of the position.
const BAD_CRC: EncoderFault = EncoderFault::BadFrame { flip: 1 << 40 };
const FAR: EncoderFault = EncoderFault::Jump { counts: 1_000_000 };
/// For as long as the run goes on.
const STAYS: u64 = u64::MAX;
/// The pivot in trouble, counted from 0.
const PIVOT: usize = 1;

/// What goes wrong.
#[derive(Clone, Copy, Debug)]
enum Trouble {
    /// An encoder, for so many frames.
    Encoder(EncoderFault, u64),
    /// A bridge pulls its fault pin.
    Bridge,
    /// The emergency stop is pressed.
    EmergencyStop,
    /// The supply has so many volts.
    Supply(f64),
    /// Somebody pushes a pivot's ring with so many N m.
    Push(f64),
    /// Nothing.
    Nothing,
}

use Trouble::{Bridge, EmergencyStop, Encoder, Nothing, Push, Supply};

/// What goes wrong, what does not quite, what is told, and whether the motors brake (or else coast).
const FAULTS: [(Trouble, Trouble, &str, bool); 12] = [
    (
        Encoder(EncoderFault::StuckHigh, BRIDGED + 1),
        Encoder(EncoderFault::StuckHigh, BRIDGED),
        "encoder does not answer, pivot 2",
        true,
    ),
    (
        Encoder(EncoderFault::StuckLow, BRIDGED + 1),
        Encoder(EncoderFault::StuckLow, BRIDGED),
        "encoder does not answer, pivot 2",
        true,
    ),
    (
        Encoder(BAD_CRC, BRIDGED + 1),
        Encoder(BAD_CRC, BRIDGED),
        "encoder frames fail the CRC, pivot 2",
        true,
    ),
    (
        Encoder(EncoderFault::ErrorBit, BRIDGED + 1),
        Encoder(EncoderFault::ErrorBit, BRIDGED),
        "encoder reports an error, pivot 2",
        true,
    ),
    (
        Encoder(FAR, BRIDGED + 1),
        Encoder(FAR, BRIDGED),
        "encoder jumps impossibly, pivot 2",
        true,
    ),
    // What a pivot can have moved meanwhile grows with every bad frame: the fifth may be 33,000 counts off.
    (
        Encoder(EncoderFault::Jump { counts: 40_000 }, STAYS),
        Encoder(EncoderFault::Jump { counts: 10_000 }, STAYS),
        "encoder jumps impossibly, pivot 2",
        true,
    ),
    (
        Encoder(EncoderFault::Frozen, STAYS),
        Encoder(EncoderFault::Frozen, 3),
        "following error too large, pivot 2",
        true,
    ),
    (
        Push(65.0),
        Push(20.0),
        "following error too large, pivot 2",
        true,
    ),
    (
        Supply(35.9),
        Supply(36.1),
        "supply voltage too low: 3.5",
        false,
    ),
    (Bridge, Nothing, "bridge reports a fault, pivot 2", false),
    (EmergencyStop, Nothing, "emergency stop pressed", true),
    // Reported, but no fault: nothing is told, and nothing stops.
    (Nothing, Encoder(EncoderFault::WarningBit, STAYS), "", true),
];

/// When what happens, in ticks.
const REFERENCED: u64 = 20;
const MOVING: u64 = 200;
const TROUBLE: u64 = 1_200;
const ASKED: u64 = 1_700;
const END: u64 = 1_800;

impl Trouble {
    /// In the period so many after the trouble began.
    fn make(self, period: &mut Period<'_>, since: u64) {
        match self {
            Encoder(fault, frames) => {
                let fault = (since < frames).then_some(fault);
                period.stage.encoders[PIVOT].set_fault(fault);
            }
            Bridge => period.bridge_faults[PIVOT] = true,
            EmergencyStop if since == 0 => {
                period.at(period.at_ns() + 1, Action::EmergencyStop(true));
            }
            Supply(volts) => period.stage.set_supply_v(volts),
            Push(torque_n_m) => {
                let mut external = External::default();
                external.ring_torque_n_m[PIVOT] = torque_n_m;
                period.stage.plant.set_external(external);
            }
            EmergencyStop | Nothing => {}
        }
    }
}

fn run<F>(instructions_per_second: u64, on_period: F) -> Outcome
where
    F: FnMut(&mut Period<'_>) -> ControlFlow<()> + Send + 'static,
{
    let path = image::find().expect("the image: build it with `cargo stage`");
    let stage = Stage::new(&StageParameters::REFERENCE);
    let bench = Bench::load(&path, stage).expect("an image with its symbols");
    let rate = NonZeroU64::new(instructions_per_second).expect("some");
    let outcome = bench.at_rate(rate).run(on_period).expect("a run");
    assert_eq!(outcome.gaps, Vec::<String>::new());
    outcome
}

/// One instruction a cycle.
const FULL_SPEED: u64 = 168_000_000;

/// What the chip says and does at the end of a move in which there was trouble.
struct End {
    told: String,
    pins: [BridgeState; 3],
    /// Since the trouble began there was a pulse in one of the last periods.
    driven: bool,
}

fn move_with(trouble: Trouble) -> End {
    let (send, receive) = mpsc::channel();
    let mut driven = false;
    run(FULL_SPEED, move |period| {
        match period.tick {
            REFERENCED => period.send(b"FRF X\n"),
            MOVING => period.send(b"MOV X 60 Y 20 W 120\n"),
            ASKED => {
                drop(period.received());
                period.send(b"FLT?\n");
            }
            _ => {}
        }
        if let Some(since) = period.tick.checked_sub(TROUBLE) {
            trouble.make(period, since);
        }
        if period.tick > ASKED {
            let drives = |bridge: &BridgeState| bridge.awake && bridge.pulse > 0.0;
            driven |= period.pins.iter().any(drives);
        }
        if period.tick < END {
            return Continue(());
        }
        let told = String::from_utf8_lossy(&period.received()).into_owned();
        let end = End {
            told,
            pins: period.pins,
            driven,
        };
        send.send(end).expect("the test waits");
        Break(())
    });
    receive.recv().expect("the last period")
}

#[test]
fn every_fault_is_told_and_stops_the_motors_as_its_kind_asks_for() {
    for (trouble, _, said, brakes) in FAULTS {
        let end = move_with(trouble);
        if matches!(trouble, Nothing) {
            assert!(end.driven && end.told == "0 no fault\n", "{}", end.told);
            continue;
        }
        assert!(end.told.contains(said), "{trouble:?}: {}", end.told);
        assert!(!end.driven, "{trouble:?}: {:?}", end.pins);
        for bridge in end.pins {
            assert_eq!(bridge.awake, brakes, "{trouble:?}: {bridge:?}");
        }
    }
}

#[test]
fn what_stays_under_a_threshold_is_no_fault_and_the_stage_drives_on() {
    for (_, twin, ..) in FAULTS {
        let end = move_with(twin);
        assert_eq!(end.told, "0 no fault\n", "{twin:?}");
        assert!(end.driven, "{twin:?}: {:?}", end.pins);
    }
}

/// What a chip that is slower than it should be says of its loop, of the fault, and how often it was reset meanwhile.
fn slow(instructions_per_second: u64) -> (String, usize) {
    let (send, receive) = mpsc::channel();
    let outcome = run(instructions_per_second, move |period| {
        match period.tick {
            REFERENCED => period.send(b"FRF X\n"),
            MOVING => period.send(b"MOV X 60 Y 20 W 120\n"),
            ASKED => period.send(b"LST?\nFLT?\n"),
            // Long enough for an answer at any speed.
            3_000 => {
                let told = String::from_utf8_lossy(&period.received()).into_owned();
                send.send(told).expect("the test waits");
                return Break(());
            }
            _ => {}
        }
        Continue(())
    });
    (
        receive.recv().expect("the last period"),
        outcome.resets.len(),
    )
}

#[test]
fn a_tick_that_ends_late_is_counted_and_one_in_time_is_not() {
    for (rate, is_late) in [(80_000_000, true), (140_000_000, false)] {
        let (told, resets) = slow(rate);
        println!("{rate}: {resets} resets, {told}");
        assert!(told.contains("no fault") && resets == 0, "{rate}: {told}");
        assert_eq!(!told.contains("LATE=0"), is_late, "{rate}: {told}");
    }
}

/// Ticks that take longer than the period itself leave no time for the latch: the encoders' frames are missing, which is a
/// fault, and the short tick of a loop that drives nothing leaves time again for telling it.
#[test]
fn a_tick_longer_than_its_period_ends_in_a_fault_that_is_told() {
    let (told, resets) = slow(40_000_000);
    println!("{resets} resets, {told}");
    assert!(told.contains("encoder does not answer"), "{told}");
    assert!(!told.contains("LATE=0"), "{told}");
    assert_eq!(resets, 0);
}

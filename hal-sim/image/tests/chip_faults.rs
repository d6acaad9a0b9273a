//! Every fault of the loop that the emulated chip's surroundings can produce, made through its pins, lines and inputs under the
//! unmodified image in the middle of a move: it is latched and told over the serial line, and the bridges do what its kind
//! asks for. Its twin, just under the threshold, is no fault, and the stage drives on.
//!
//! What the bench does not model, and what therefore is not here: flash (its contents do not change, so nothing can be damaged
//! in it), a dip of the chip's own supply (brown-out), a crystal that stops, single bits that flip in memory, bus errors of the
//! peripherals, and a program that runs wild. What nothing at the chip's pins can bring about is tested on the host, where the
//! same code runs: setpoints out of the disk or of a guide (the planner gives none), numbers that are none (frames and ADC
//! counts are whole numbers, and a parameter that would make one is out of its range), pivots too close (a following error
//! comes first), a full command queue (the tick empties it as fast as a serial line fills it). The emergency stop within a PWM
//! period, silent encoders at start, a halted loop and the restart by the watchdog are in `chip.rs`.
//!
//! Needs `cargo stage` first, then `cargo chip-test`.

use firmware::parameters::Parameters;
use hal_sim::machine::devices::{BridgeState, EncoderFault, Stage, StageParameters};
use hal_sim::machine::plant::External;
use image::chip::{Action, Bench, Outcome, Period, elf_file};
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
    /// Somebody pushes a pivot's ring with so many N m, for so many ticks.
    Push(f64, u64),
    /// Something hard gets in a pivot's way, for so many ticks.
    Jam(u64),
    /// Nothing.
    Nothing,
}

use Trouble::{Bridge, EmergencyStop, Encoder, Jam, Nothing, Push, Supply};

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
        "encoder repeats one reading, pivot 2",
        true,
    ),
    (
        Push(150.0, 80),
        // 6 A are 18 N m.
        Push(12.0, STAYS),
        "following error too large, pivot 2",
        true,
    ),
    (
        Supply(35.9),
        Supply(36.1),
        "supply voltage too low: 3.59",
        true,
    ),
    (
        // Of which the brake resistor, which is on then, takes 0.36 V.
        Supply(58.7),
        Supply(57.9),
        "supply voltage too high: 5.8",
        true,
    ),
    (Bridge, Nothing, "bridge reports a fault, pivot 2", false),
    // Reported, but no fault.
    (
        EmergencyStop,
        Encoder(EncoderFault::WarningBit, STAYS),
        "emergency stop pressed",
        true,
    ),
];

/// Every trouble has so many ticks of one run, and in these happens what.
const SLOT: u64 = 2_300;
const READY: u64 = 20;
const MOVING: u64 = 80;
const TROUBLE: u64 = 330;
/// A controlled stop takes 1,200 ticks.
const ASKED: u64 = TROUBLE + 1_500;
const MENDED: u64 = ASKED + 100;

const TARGETS: [&[u8]; 2] = [b"MOV X 40 Y 20 W 90\n", b"MOV X -40 Y -10 W -30\n"];

impl Trouble {
    /// In the period so many after the trouble began.
    fn make(self, period: &mut Period<'_>, since: u64) {
        match self {
            Encoder(fault, frames) => {
                let fault = (since < frames).then_some(fault);
                period.stage.encoders[PIVOT].set_fault(fault);
            }
            Bridge => period.bridge_faults[PIVOT] = true,
            EmergencyStop if since == 0 => press(period, true),
            Supply(volts) => period.stage.set_supply_v(volts),
            Push(torque_n_m, ticks) => push(period, if since < ticks { torque_n_m } else { 0.0 }),
            Jam(_) if since == 0 => jam(period),
            Jam(ticks) if since == ticks => push(period, 0.0),
            EmergencyStop | Jam(_) | Nothing => {}
        }
    }
}

/// Everything as it should be.
fn mend(period: &mut Period<'_>) {
    period.stage.encoders[PIVOT].set_fault(None);
    period
        .stage
        .set_supply_v(StageParameters::REFERENCE.plant.supply_v);
    *period.bridge_faults = [false; 3];
    press(period, false);
    push(period, 0.0);
}

fn press(period: &mut Period<'_>, pressed: bool) {
    period.at(period.at_ns() + 1, Action::EmergencyStop(pressed));
}

fn push(period: &mut Period<'_>, torque_n_m: f64) {
    let mut external = External::default();
    external.ring_torque_n_m[PIVOT] = torque_n_m;
    period.stage.plant.set_external(external);
}

fn jam(period: &mut Period<'_>) {
    let mut external = External::default();
    external.jammed_at_rad[PIVOT] = Some(period.stage.plant.pivots_rad()[PIVOT]);
    period.stage.plant.set_external(external);
}

fn run<F>(instructions_per_second: u64, on_period: F) -> Outcome
where
    F: FnMut(&mut Period<'_>) -> ControlFlow<()> + Send + 'static,
{
    let path = elf_file::find().expect("the image: build it with `cargo stage`");
    let stage = Stage::new(&StageParameters::REFERENCE);
    let bench = Bench::load(&path, stage).expect("an image with its symbols");
    let rate = NonZeroU64::new(instructions_per_second).expect("some");
    let outcome = bench.at_rate(rate).run(on_period).expect("a run");
    assert_eq!(outcome.gaps, Vec::<String>::new());
    outcome
}

/// One instruction a cycle.
const FULL_SPEED: u64 = 168_000_000;

/// What the chip says and does some time after trouble in a move.
#[derive(Default)]
struct End {
    told: String,
    pins: Vec<BridgeState>,
    /// Of late there was a pulse.
    driven: bool,
}

/// One trouble after the other, each in the middle of a move.
fn moves_with(troubles: Vec<Trouble>) -> Vec<End> {
    let (send, receive) = mpsc::channel();
    let mut driven = false;
    run(FULL_SPEED, move |period| {
        let (slot, tick) = (period.tick / SLOT, period.tick % SLOT);
        let Some(trouble) = troubles.get(slot as usize) else {
            return Break(());
        };
        match tick {
            READY => period.send(b"FLC\nFRF X\n"),
            MOVING => period.send(TARGETS[slot as usize % 2]),
            ASKED => {
                drop(period.received());
                period.send(b"FLT?\n");
                driven = false;
            }
            MENDED => {
                let told = String::from_utf8_lossy(&period.received()).into_owned();
                let pins = period.pins.to_vec();
                let end = End { told, pins, driven };
                send.send(end).expect("the test waits");
                mend(period);
            }
            _ => {}
        }
        if (TROUBLE..MENDED).contains(&tick) {
            trouble.make(period, tick - TROUBLE);
        }
        let drives = |bridge: &BridgeState| bridge.awake && bridge.pulse > 0.0;
        driven |= period.pins.iter().any(drives);
        Continue(())
    });
    receive.iter().collect()
}

#[test]
fn every_fault_is_told_and_stops_the_motors_as_its_kind_asks_for() {
    let ends = moves_with(FAULTS.iter().map(|(fires, ..)| *fires).collect());
    assert_eq!(ends.len(), FAULTS.len());
    for ((trouble, _, said, brakes), end) in FAULTS.iter().zip(ends) {
        println!("{trouble:?}: {}", end.told.trim());
        assert!(end.told.contains(said), "{trouble:?}: {}", end.told);
        assert!(!end.driven, "{trouble:?}: {:?}", end.pins);
        for bridge in end.pins {
            assert_eq!(bridge.awake, *brakes, "{trouble:?}: {bridge:?}");
        }
    }
}

#[test]
fn what_stays_under_a_threshold_is_no_fault_and_the_stage_drives_on() {
    let ends = moves_with(FAULTS.iter().map(|(_, twin, ..)| *twin).collect());
    assert_eq!(ends.len(), FAULTS.len());
    for ((_, twin, ..), end) in FAULTS.iter().zip(ends) {
        assert_eq!(
            end.told.lines().next(),
            Some("0 no fault"),
            "{twin:?}: {}",
            end.told
        );
        assert!(end.driven, "{twin:?}: {:?}", end.pins);
    }
}

/// What a stage has to be set up for: lines before its motion, the motion, trouble and twin, and what is told. With the parameters
/// as they are a following error comes first, or it takes too many seconds.
const SETUPS: [(&str, &str, Trouble, Trouble, &str); 3] = [
    (
        "SPA 1 0x54500500 0.05 1 0x54500106 5.5 1 0x54500505 1.05",
        "JOG W 300",
        Push(40.0, 100),
        Push(10.0, 100),
        "pivot too fast, pivot 2",
    ),
    (
        "SPA 1 0x54500500 0.05 1 0x54500506 0.05 1 0x54500507 36 1 0x54500508 0.02",
        "JOG W 60",
        Jam(1_000),
        Jam(200),
        "drive at its end for too long, pivot 2",
    ),
    // 3 N m ask for 1 A.
    (
        "SPA 1 0x54500509 1 1 0x5450050A 0.1",
        "",
        Push(3.7, 4_500),
        Push(2.7, 4_500),
        "motor too hot, pivot 2",
    ),
];

/// What the chip says and does after trouble on a stage that is set up for it.
fn set_up_with(setup: &'static str, motion: &'static str, trouble: Trouble) -> End {
    const MOTION: u64 = 400;
    const TROUBLE: u64 = 2_500;
    const ASKED: u64 = TROUBLE + 4_500;
    let (send, receive) = mpsc::channel();
    let mut driven = false;
    run(FULL_SPEED, move |period| {
        match period.tick {
            READY => period.send(format!("CCL 1 ADVANCED\n{setup}\nFRF X\n").as_bytes()),
            MOTION => period.send(format!("{motion}\nERR?\n").as_bytes()),
            TROUBLE => {
                let answer = period.received();
                assert_eq!(String::from_utf8_lossy(&answer), "0\n", "{setup}, {motion}");
            }
            ASKED => {
                driven = false;
                period.send(b"FLT?\n");
            }
            _ => {}
        }
        if period.tick == ASKED + 100 {
            let told = String::from_utf8_lossy(&period.received()).into_owned();
            let pins = period.pins.to_vec();
            send.send(End { told, pins, driven })
                .expect("the test waits");
            return Break(());
        }
        if period.tick >= TROUBLE {
            trouble.make(period, period.tick - TROUBLE);
        }
        let drives = |bridge: &BridgeState| bridge.awake && bridge.pulse > 0.0;
        driven |= period.pins.iter().any(drives);
        Continue(())
    });
    receive.recv().expect("the last period")
}

#[test]
fn what_a_stage_has_to_be_set_up_for_is_told_and_brakes_and_its_twin_is_not() {
    for (setup, motion, fires, twin, said) in SETUPS {
        let end = set_up_with(setup, motion, fires);
        println!("{fires:?}: {}", end.told.trim());
        assert!(end.told.contains(said), "{fires:?}: {}", end.told);
        assert!(
            !end.driven && end.pins.iter().all(|bridge| bridge.awake),
            "{fires:?}"
        );
        let end = set_up_with(setup, motion, twin);
        // What is looser than the reference is told behind it.
        let said = end.told.lines().next().map(str::trim_end);
        assert_eq!(said, Some("0 no fault"), "{twin:?}");
        assert!(end.driven, "{twin:?}: {:?}", end.pins);
    }
}

/// No fault: the stage is stopped and held. The twin is heard just in time.
#[test]
fn a_host_that_falls_silent_has_the_stage_stopped() {
    // 50 ms are 1,000 ticks; a byte may be heard some ticks after it was sent.
    for (every, is_silent) in [(1_100, true), (900, false)] {
        let (send, receive) = mpsc::channel();
        run(FULL_SPEED, move |period| {
            match period.tick {
                READY => period.send(b"FRF X\n"),
                400 => period.send(b"HBT 50\nJOG W 60\n"),
                4_600 => period.send(b"EVT?\nFLT?\nERR?\nJOG? W\n"),
                5_000 => {
                    let told = String::from_utf8_lossy(&period.received()).into_owned();
                    send.send(told).expect("the test waits");
                    return Break(());
                }
                tick if tick > 400 && (tick - 400).is_multiple_of(every) => period.send(b"\n"),
                _ => {}
            }
            Continue(())
        });
        let told = receive.recv().expect("the last period");
        println!("every {every} ticks: {told}");
        assert_eq!(
            told.contains("no host heard for 50 ms"),
            is_silent,
            "{told}"
        );
        assert!(told.contains("0 no fault"), "{told}");
        let ends = if is_silent { "10\nW=0" } else { "0\nW=60" };
        let lines: Vec<_> = told.lines().collect();
        let last = lines[lines.len() - 2..].join("\n");
        assert_eq!(last, ends, "{told}");
    }
}

/// Counts of the latch's timer in 8 us: the bytes of a late frame are still under way when its tick comes, and when the next
/// latch does in time.
const LATE_LATCH: i32 = 8 * 84;

/// One latch comes late, as after a tick that took too long. Its frames are missing; the next ones are good again: twelve bad frames of
/// an encoder would be told, so that each of the four costs less than three.
#[test]
fn a_late_latch_costs_its_own_frames_and_no_more() {
    let (send, receive) = mpsc::channel();
    run(FULL_SPEED, move |period| {
        match period.tick {
            READY => period.send(b"FRF X\n"),
            // In the first half of a period, well before its latch; back in time for the next.
            400 | 500 | 600 | 700 => {
                let before = period.tick_at_ns() - 40_000;
                period.at(before + 50_000, Action::DelayLatch(LATE_LATCH));
                period.at(before + 100_000, Action::DelayLatch(-LATE_LATCH));
            }
            800 => period.send(b"FLT?\nSVO?\nEVT?\n"),
            1_100 => {
                let told = String::from_utf8_lossy(&period.received()).into_owned();
                send.send(told).expect("the test waits");
                return Break(());
            }
            _ => {}
        }
        Continue(())
    });
    let told = receive.recv().expect("the last period");
    println!("{told}");
    assert!(
        told.contains("0 no fault") && told.contains("X=1"),
        "{told}"
    );
    assert!(!told.contains("bad encoder frames"), "{told}");
}

/// What a chip that is slower than it should be says of its loop and of the fault, and how often it was reset meanwhile.
fn slow(instructions_per_second: u64) -> (String, usize) {
    let (send, receive) = mpsc::channel();
    let outcome = run(instructions_per_second, move |period| {
        match period.tick {
            READY => period.send(b"FRF X\n"),
            200 => period.send(TARGETS[0]),
            1_700 => period.send(b"LST?\nFLT?\n"),
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
    let told = receive.recv().expect("the last period");
    (told, outcome.resets.len())
}

/// At the lower rate duties are in time, but ticks and recorders leave next to nothing for the command side.
#[test]
fn a_tick_that_ends_late_too_often_is_a_fault_and_one_in_time_is_not_even_counted() {
    let late = ["control loop late too often"];
    for (rate, told_is) in [(68_000_000, &late[..]), (78_000_000, &["0 no fault"])] {
        let (told, resets) = slow(rate);
        println!("{rate}: {resets} resets, {told}");
        let is_told = told_is.iter().any(|is| told.contains(is));
        assert!(is_told && resets == 0, "{rate}: {told}");
        let in_time = told.lines().any(|line| line.trim() == "LATE=0");
        assert_eq!(in_time, told_is == ["0 no fault"], "{rate}: {told}");
    }
}

/// Ticks that take longer than the period itself come late and leave no time for the latch. Either is a fault, and the shorter
/// tick of a loop that drives nothing leaves time again for telling it: the watchdog has no cause to bite.
#[test]
fn a_tick_longer_than_its_period_ends_in_a_fault_that_is_told() {
    let (told, resets) = slow(46_000_000);
    println!("{resets} resets, {told}");
    let said = ["encoder ", "control loop late too often"];
    assert!(said.iter().any(|said| told.contains(said)), "{told}");
    assert_eq!(resets, 0);
}

//! What the unmodified image tells of its chip by `TST?`, against what the emulator shows of it. Needs `cargo stage` first, then
//! `cargo chip-test`.

mod asked;

use asked::{answers, bench};
use image::chip::{Action, Bench, Period};
use std::sync::mpsc;

fn told(
    bench: Bench,
    lines: &'static [u8],
    before_tick: impl FnMut(&mut Period<'_>) + Send + 'static,
) -> String {
    answers(bench, lines, [800, 1_400], before_tick)
}

/// A reading of `TST?`, and how it was judged.
fn reading<'a>(told: &'a str, name: &str) -> (f64, &'a str) {
    let mut lines = told.lines().map(str::trim);
    let line = lines.find_map(|line| line.strip_prefix(name)?.strip_prefix('='));
    let line = line.unwrap_or_else(|| panic!("no {name} in {told}"));
    let value = line.split([' ', ',']).next().unwrap_or_default();
    let judged = line.rsplit(", ").next().unwrap_or_default();
    (value.parse().expect("a number"), judged)
}

/// All but what this emulator does not have: option bytes as they should be, and a way from the oscillator to a timer.
#[test]
fn a_sound_chip_is_good_in_every_reading() {
    let told = told(bench(), b"TST?\n", |_| {});
    println!("{told}");
    let bad: Vec<&str> = told.lines().filter(|line| line.contains("BAD")).collect();
    assert_eq!(bad.len(), 3, "{bad:?}");
    assert!(bad[0].starts_with("BROWN_OUT_LEVEL=") && bad[1].starts_with("LSI=0 "));
    assert_eq!(bad[2].trim(), "BAD=2");
    assert_eq!(reading(&told, "VECTORS"), (1.0, "ok"));
    let (supply_v, _) = reading(&told, "CHIP_SUPPLY");
    assert!((supply_v - 3.3).abs() < 1e-9, "{supply_v}");
    for name in ["FRAME_START1", "FRAME_START2", "FRAME_START3"] {
        // Idle and acknowledge of the simulated encoders.
        assert_eq!(reading(&told, name), (10.0, "ok"));
    }
    let (worst, _) = reading(&told, "WORST_TICK");
    assert!((1.0..5_376.0).contains(&worst), "{worst}");
}

/// A converter supplied with more counts less of everything: without its reference 48 V looked like 46.
#[test]
fn the_converters_supply_is_measured_and_taken_into_account() {
    let supply = |share: f64| {
        let told = told(bench().with_converter_supply(share), b"TST?\n", |_| {});
        ["CHIP_SUPPLY", "SUPPLY"].map(|name| reading(&told, name).0)
    };
    let ([chip_v, bridges_v], [chip_high_v, bridges_high_v]) = (supply(1.0), supply(1.04));
    println!("{chip_v} {bridges_v} {chip_high_v} {bridges_high_v}");
    assert!((chip_high_v / chip_v - 1.04).abs() < 1e-3);
    // The emulated pins are in counts, which the greater supply makes worth more.
    assert!((bridges_high_v / bridges_v - 1.04).abs() < 1e-3);
}

/// Cycles of the core.
const CYCLE_NS: f64 = 1e3 / 168.0;

/// The three encoders' clocks begin within ten cycles, and what is told of the time left to the tick is what the lines show.
#[test]
fn the_encoders_clocks_begin_together_and_their_margin_is_told_as_it_is() {
    let (send, receive) = mpsc::channel();
    let mut due_ns = None;
    let seen = told(bench(), b"TST?\n", move |period| {
        // Of the tick before this one.
        if let (Some(due_ns), 300..800) = (due_ns, period.tick) {
            let _ = send.send((due_ns, period.frames_ns()));
        }
        due_ns = Some(period.tick_at_ns());
    });
    let (mut widest_ns, mut least_ns) = (0, u64::MAX);
    for (due_ns, frames) in receive {
        let first = frames.map(|[first, _]| first);
        let last = frames.map(|[_, last]| last);
        let spread_ns = first.iter().max().expect("three") - first.iter().min().expect("three");
        widest_ns = widest_ns.max(spread_ns);
        least_ns = least_ns.min(due_ns - last.iter().max().expect("three"));
    }
    let (told, judged) = reading(&seen, "FRAME_MARGIN");
    println!("{widest_ns} ns apart, {least_ns} ns left at least, told: {told} counts, {seen}");
    assert!(widest_ns as f64 <= 10.0 * CYCLE_NS, "{widest_ns}");
    assert_eq!(judged, "ok");
    // The line is through a little before what is told, which is taken when all three have been let go: never the other way.
    let told_ns = told * 1e3 / 84.0;
    assert!(
        (0.0..200.0).contains(&(least_ns as f64 - told_ns)),
        "{least_ns} {told_ns}"
    );
}

/// Moves the latch's timer, in counts of 84 MHz: from 2 us after a latch so far that the next comes 5 us later, and back.
const NEARLY_DUE: i32 = 168 - (4_200 - 420);
const BACK: i32 = 168 - 756;

/// A second latch comes before the tick of the first: of two ticks there is one. The cycle counter would not show it, least of all where
/// it stands while the core sleeps.
#[test]
fn a_lost_tick_is_counted() {
    let told = told(bench(), b"LST?\nFLT?\n", |period| {
        if period.tick == 400 {
            let due = period.tick_at_ns();
            period.at(due - 13_000, Action::DelayLatch(NEARLY_DUE));
            period.at(due - 6_000, Action::DelayLatch(BACK));
        }
    });
    println!("{told}");
    assert!(told.lines().any(|line| line.trim() == "LATE=1"), "{told}");
    assert!(told.contains("0 no fault"), "{told}");
}

/// `FLASH_CR`, and its bit that lets words be programmed.
const FLASH_CR: u64 = 0x4002_3C10;
const PROGRAM: u32 = 1;

/// Under 2.9 V nothing is written.
#[test]
fn a_chip_supply_that_is_too_low_keeps_the_flash_from_being_written() {
    for (millivolts, programs) in [(3_300, true), (2_800, false)] {
        let (send, receive) = mpsc::channel();
        let told = told(
            bench(),
            b"TST?\nSPA 1 0x54500103 1\nWPA 100\nERR?\n",
            move |period| {
                if period.tick == 100 {
                    period.set_chip_supply(millivolts);
                }
                let control = period.register(FLASH_CR).unwrap_or_default();
                let _ = send.send(control & PROGRAM != 0);
            },
        );
        let programmed = receive.into_iter().any(|is| is);
        println!("{millivolts} mV: {programmed}, {told}");
        assert_eq!(programmed, programs, "{told}");
        let low = f64::from(u8::from(!programs));
        let judged = if programs { "ok" } else { "BAD" };
        assert_eq!(reading(&told, "FLASH_SUPPLY_LOW"), (low, judged));
    }
}

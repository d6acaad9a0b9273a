//! What the unmodified image does about its option bytes, and about a watchdog's oscillator as slow or as fast as the data sheet allows.
//! Needs `cargo stage` first, then `cargo chip-test`.

mod asked;

use asked::{answers, bench};
use image::chip::{Action, Bench, Outcome, Period, ResetCause};
use std::ops::ControlFlow::{self, Break, Continue};
use std::sync::mpsc;

/// Option bytes as BRINGUP has them: brown-out level 3, bank 1, watchdogs by software, no protection.
const GOOD_OPTIONS: u32 = 0x0FFF_AAE0;
/// Brown-out reset off, as the factory delivers.
const BROWN_OUT_OFF: u32 = 0b11 << 2;
const BOOT_BANK_2: u32 = 1 << 4;

fn run<F>(bench: Bench, on_period: F) -> Outcome
where
    F: FnMut(&mut Period<'_>) -> ControlFlow<()> + Send + 'static,
{
    let outcome = bench.run(on_period).expect("a run");
    assert_eq!(outcome.gaps, Vec::<String>::new());
    outcome
}

/// What `EVT?` tells of a chip with these option bytes.
fn events_with(options: u32) -> String {
    let bench = bench().with_options(options);
    answers(bench, b"EVT?\nTST?\n", [20, 800], |_| {})
}

#[test]
fn option_bytes_are_told_where_they_are_wrong_and_only_there() {
    const BROWN_OUT: &str = "brown-out reset not at level 3";
    const BOOT: &str = "BFB2 is set";
    for (options, brown_out, boot) in [
        (GOOD_OPTIONS, false, false),
        (GOOD_OPTIONS | BROWN_OUT_OFF, true, false),
        (GOOD_OPTIONS | BOOT_BANK_2, false, true),
    ] {
        let told = events_with(options);
        assert_eq!(told.contains(BROWN_OUT), brown_out, "{options:#x} {told}");
        assert_eq!(told.contains(BOOT), boot, "{options:#x} {told}");
        let level = if brown_out { "0" } else { "3" };
        assert!(
            told.contains(&format!("BROWN_OUT_LEVEL={level},")),
            "{told}"
        );
    }
}

/// From the loop's standstill to the reset, ns, with a watchdog's oscillator of so many Hz.
fn reset_after_ns(watchdog_hz: u64) -> u64 {
    let (send, receive) = mpsc::channel();
    let mut halted_at = 0;
    let outcome = run(bench().with_watchdog_hz(watchdog_hz), move |period| {
        match (period.resets.len(), period.tick) {
            (0, 1_000) => {
                halted_at = period.tick_at_ns();
                period.at(halted_at, Action::HaltLoop);
            }
            (1.., 1) => {
                send.send(halted_at).expect("the test waits");
                return Break(());
            }
            _ => {}
        }
        Continue(())
    });
    let reset = outcome.resets.first().expect("a reset");
    assert_eq!(reset.cause, ResetCause::Model("IWDG"));
    reset.at_ns - receive.recv().expect("the halt")
}

#[test]
fn the_independent_watchdog_bites_within_its_bounds_at_both_ends_of_its_oscillators_spread() {
    // Five counts of 128, of which the one under way when it was fed last may be over at once.
    for (hz, most_ms) in [(17_000, 37.7), (32_000, 20.1), (47_000, 13.7)] {
        let counts_ms = 128.0 / hz as f64 * 1e3;
        let after_ms = reset_after_ns(hz) as f64 / 1e6;
        println!("{hz} Hz: {after_ms:.2} ms");
        assert!(
            after_ms < most_ms && after_ms > 4.0 * counts_ms - 0.2,
            "{hz} Hz: {after_ms} ms"
        );
    }
}

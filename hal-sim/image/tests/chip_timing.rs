//! The unmodified image on chips that execute few instructions a second: what is due is done, and nothing is reset. Needs `cargo stage`
//! first, then `cargo chip-test`.

use image::chip::{BUSY_CHIPS, busy};

/// Plans that come too late for the tick are made again: 9 of them at 88 million instructions a second, and a tenth more.
const MOST_REFUSED: u64 = 10;

/// Of `WPA`: the emulated flash keeps nothing.
const NOT_KEPT: &str = "4001";

/// Rates that the cycles' model has for this image, and streams such as each can follow: everything is taken.
#[test]
fn a_slow_chip_streams_records_moves_and_stores_at_once() {
    for options in &BUSY_CHIPS[..3] {
        let seen = busy(options).expect("a run");
        println!("{options:?}: {seen:?}");
        assert_eq!(seen.stream_errors, <[Vec<String>; 2]>::default());
        assert_eq!(seen.errors, [NOT_KEPT]);
        assert_eq!((seen.late, seen.resets), (0, 0));
        assert_eq!(seen.fault, "0 no fault");
        assert!(seen.refused <= MOST_REFUSED, "{seen:?}");
    }
}

/// A stream that is too fast for what ticks leave: it ends, is told, and nothing else suffers.
#[test]
fn a_stream_too_fast_for_a_slow_chip_ends_and_the_loop_goes_on() {
    for options in &BUSY_CHIPS[3..] {
        let seen = busy(options).expect("a run");
        println!("{options:?}: {seen:?}");
        let ended = seen.stream_errors.iter().flatten().collect::<Vec<_>>();
        assert!(!ended.is_empty(), "{seen:?}");
        assert_eq!((seen.late, seen.resets), (0, 0));
        assert_eq!(seen.fault, "0 no fault");
    }
}

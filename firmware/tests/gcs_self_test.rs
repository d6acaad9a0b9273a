//! `TST?`: what a board reads about itself, judged, and nothing of it with the bridges awake.

mod gcs_bench;

use firmware::self_test::{Board, Reading};
use gcs_bench::{Bench, reference_panel};

struct Fake(f64);

impl Board for Fake {
    fn name(&self) -> &'static str {
        "a board of this test"
    }

    fn deadline_cycles(&self) -> Option<u32> {
        Some(5_376)
    }

    fn readings(&self, tell: &mut dyn FnMut(&Reading)) {
        tell(&Reading {
            name: "CORE",
            value: self.0,
            unit: "Hz",
            good: 168e6..=168e6,
        });
    }
}

fn answer(board: &'static Fake) -> String {
    let mut panel = reference_panel();
    panel.set_board(board);
    let mut bench = Bench::with(panel);
    bench.run(2);
    bench.say("TST?\n")
}

#[test]
fn a_sound_board_is_good_in_every_reading() {
    let answer = answer(&Fake(168e6));
    let lines: Vec<&str> = answer.lines().map(str::trim_end).collect();
    assert_eq!(
        lines,
        [
            "BOARD=a board of this test",
            "CORE=168000000 Hz, 168000000 to 168000000, ok",
            "ENCODER1=1, 1 to 1, ok",
            "ENCODER2=1, 1 to 1, ok",
            "ENCODER3=1, 1 to 1, ok",
            "NOISE1=0 counts, 0 to 6, ok",
            "NOISE2=0 counts, 0 to 6, ok",
            "NOISE3=0 counts, 0 to 6, ok",
            "LATE=0 ticks, 0 to 0, ok",
            "WORST_TICK=0 cycles, 0 to 5376, ok",
            "BAD=0",
        ]
    );
}

#[test]
fn what_is_not_as_it_has_to_be_is_told_and_counted() {
    let answer = answer(&Fake(16e6));
    assert!(
        answer.contains("CORE=16000000 Hz, 168000000 to 168000000, BAD"),
        "{answer}"
    );
    assert!(answer.ends_with("BAD=1\n"), "{answer}");
}

#[test]
fn it_is_refused_with_the_servo_on() {
    let mut bench = Bench::ready();
    assert_eq!(bench.error_after("TST?"), "89");
    assert_eq!(bench.error_after("SVO X 0"), "0");
    assert!(bench.say("TST?\n").starts_with("BOARD=unknown"));
}

/// A board with a debugger attached.
struct Debugged;

impl Board for Debugged {
    fn name(&self) -> &'static str {
        "debugged"
    }

    fn readings(&self, _tell: &mut dyn FnMut(&Reading)) {}

    fn has_debugger(&self) -> bool {
        true
    }
}

#[test]
fn nothing_drives_with_a_debugger_attached_unless_that_is_allowed() {
    let mut bench = Bench::new();
    bench.panel_mut().set_board(&Debugged);
    bench.run(2);
    for line in ["FRF", "SVO X 1", "MOV X 1", "RCV 1"] {
        assert_eq!(bench.say(&format!("{line}\nERR?\n")), "4006\n", "{line}");
    }
    assert!(bench.tick.log.is_empty(), "{:?}", bench.tick.log);
    // What drives nothing is no matter, and who may loosen the supervision may allow this.
    let lines = "SVO X 0\nSTP\nVLS 20\nSPA 1 0x54500512 1\nERR?\n";
    assert_eq!(bench.say(lines), "60\n");
    bench.say("CCL 1 ADVANCED\nSPA 1 0x54500512 1\n");
    bench.run(2);
    assert_eq!(bench.say("ERR?\n"), "0\n");
    bench.reference();
    let events = bench.say("EVT?\n");
    assert!(events.contains("54500512"), "{events}");
}

//! What happens when, on the emulated chip: the encoders' clocks, frames and their tick, duties and the PWM period in which they take
//! over, and that deadlines are kept with all that a tick is used for. Needs `cargo stage` first, then `cargo chip-test`.

use hal_sim::machine::devices::{BridgeState, Stage, StageParameters};
use image::chip::{Action, Bench, Period, busy, elf_file, follow};
use image::cycles::Bus;
use std::num::NonZeroU64;
use std::ops::ControlFlow::{self, Break, Continue};
use std::sync::mpsc;

const CYCLES_PER_US: u64 = 168;
/// A byte on an encoder's line, ns.
const BYTE_NS: u64 = 8 * 1_000_000_000 / 5_250_000;

fn run<F>(on_period: F)
where
    F: FnMut(&mut Period<'_>) -> ControlFlow<()> + Send + 'static,
{
    let path = elf_file::find().expect("the image: build it with `cargo stage`");
    let stage = Stage::new(&StageParameters::REFERENCE);
    let bench = Bench::load(&path, stage).expect("an image with its symbols");
    let outcome = bench.run(on_period).expect("a run");
    assert_eq!(outcome.gaps, Vec::<String>::new());
}

/// The value that an answer has behind a name.
fn told(answers: &str, name: &str) -> u64 {
    let mut lines = answers.lines();
    let value = lines.find_map(|line| line.trim().strip_prefix(name)?.parse().ok());
    value.unwrap_or_else(|| panic!("{name} in {answers}"))
}

/// Nothing stands between the three stores that let the ports go: here, where a store takes one cycle, the clocks start as many cycles
/// apart. And the chip's own account of when frames are whole is what the encoders see.
#[test]
fn encoders_latch_within_ten_cycles_and_the_chip_knows_when_their_frames_are_whole() {
    let (send, receive) = mpsc::channel();
    let mut least_ns = u64::MAX;
    run(move |period| {
        // Of the tick before.
        let tick_at_ns = period.tick_at_ns() - 50_000;
        match period.tick {
            20 => period.send(b"FRF X\n"),
            100 => period.send(b"MOV X 20 Y -30 W 90\n"),
            2_000 => period.send(b"LST?\n"),
            2_100 => {
                let answers = String::from_utf8_lossy(&period.received()).into_owned();
                send.send((answers, least_ns)).expect("the test waits");
                return Break(());
            }
            _ => {}
        }
        if period.tick > 1 {
            let clocked = period.frames_clocked_at_ns().expect("frames");
            let starts = clocked.map(|(first, _)| first);
            let spread = starts.iter().max().unwrap() - starts.iter().min().unwrap();
            assert!(
                spread * CYCLES_PER_US <= 10 * 1_000,
                "tick {}: {starts:?}",
                period.tick
            );
            let last = clocked.map(|(_, last)| last).into_iter().max().unwrap();
            if period.tick <= 2_000 {
                least_ns = least_ns.min(tick_at_ns - last);
            }
        }
        Continue(())
    });
    let (answers, least_ns) = receive.recv().expect("the last period");
    let told_ns = told(&answers, "FRAME_MARGIN=") * 1_000 / CYCLES_PER_US;
    println!("{told_ns} ns told, the last byte {least_ns} ns before its tick");
    // The emulator asks the encoder for a byte where it ends, or where it begins.
    let whole_ns = [least_ns, least_ns.saturating_sub(BYTE_NS)];
    assert!(
        whole_ns.iter().any(|whole| whole.abs_diff(told_ns) < 400),
        "{told_ns} told, {least_ns}"
    );
}

/// Duties are held back while they are written: all of a tick's take over with the same PWM period, however late it is.
#[test]
fn no_pwm_period_begins_with_the_duties_of_two_ticks() {
    const CONTROL: u32 = 0x4001_0000;
    const DUTIES: [u32; 3] = [0x4001_0034, 0x4001_0038, 0x4001_003C];
    let (_, steps) = follow(600).expect("a tick");
    let stores: Vec<u32> = (steps.iter())
        .filter_map(|step| match step.bus {
            Bus::Write(at) if at == CONTROL || DUTIES.contains(&at) => Some(at),
            _ => None,
        })
        .collect();
    let [first, second, third] = DUTIES;
    assert_eq!(stores, [CONTROL, first, second, third, CONTROL]);
}

/// The emergency stop pressed for a moment, released again before the tick that is told of it: the outputs stay cut until the duties
/// of before have left the timer. The twin is not pressed.
#[test]
fn a_break_that_is_over_does_not_let_the_old_duty_act_again() {
    for pressed in [true, false] {
        let (send, receive) = mpsc::channel();
        run(move |period| {
            match period.tick {
                20 => period.send(b"FRF X\n"),
                100 => period.send(b"MOV X 60\n"),
                1_000 => {
                    let tick_at = period.tick_at_ns();
                    if pressed {
                        period.at(tick_at - 5_000, Action::EmergencyStop(true));
                        period.at(tick_at - 3_000, Action::EmergencyStop(false));
                    }
                    // Before the tick; and behind it, while the old duty is still in the timer, in both PWM periods.
                    for after in [4_000, 17_000, 20_000, 30_000] {
                        period.at(tick_at + after, Action::Probe);
                    }
                }
                1_100 => {
                    send.send(period.probes.to_vec()).expect("the test waits");
                    return Break(());
                }
                _ => {}
            }
            Continue(())
        });
        let probes = receive.recv().expect("the last period");
        let drives = |bridges: &[BridgeState; 3]| bridges.iter().any(|bridge| bridge.pulse > 0.0);
        let driven: Vec<bool> = probes.iter().map(|(_, bridges)| drives(bridges)).collect();
        assert_eq!(driven, [!pressed; 4], "{probes:?}");
    }
}

/// A tick that does not come, its interrupt lost, is counted; the twin's come.
#[test]
fn a_tick_that_does_not_come_is_counted() {
    for lost in [0, 3] {
        let (send, receive) = mpsc::channel();
        run(move |period| {
            match period.tick {
                20 => period.send(b"LST\n"),
                100 => period.send(b"LST?\n"),
                200 => {
                    let answers = String::from_utf8_lossy(&period.received()).into_owned();
                    send.send(answers).expect("the test waits");
                    return Break(());
                }
                tick if tick > 40 && tick <= 40 + 10 * lost && tick.is_multiple_of(10) => {
                    // Armed by the latch, 15 us before the tick.
                    period.at(period.tick_at_ns() - 5_000, Action::LoseTick);
                }
                _ => {}
            }
            Continue(())
        });
        let answers = receive.recv().expect("the last period");
        assert_eq!(told(&answers, "LATE="), lost, "{answers}");
    }
}

/// Ticks of so many instructions as there are, on a chip that takes 1.8 and 1.9 cycles for one: no duty is late, no tick is lost, nothing
/// is refused.
#[test]
fn deadlines_are_kept_with_all_that_a_tick_is_used_for() {
    for rate in [93_000_000, 88_000_000] {
        let rate = NonZeroU64::new(rate).expect("some");
        let busy = busy(rate).expect("a run");
        println!("{rate}: {busy:?}");
        assert_eq!(busy.told.late, 0, "{busy:?}");
        assert_eq!(busy.told.refused, 0, "{busy:?}");
        assert_eq!(busy.told.errors, [0, 0, 0], "{busy:?}");
        assert_eq!(busy.told.fault, "0 no fault", "{busy:?}");
        assert!(busy.told.points > 2_000, "{busy:?}");
        // The stream's targets, and the moves.
        assert!(busy.commands > 80, "{busy:?}");
        assert!(busy.cost.latest_end_ns < 32_000, "{busy:?}");
    }
}

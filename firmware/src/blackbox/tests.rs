use super::entry::Entries;
use super::*;
use crate::link::Mode;
use crate::motion::Motion;
use crate::recorder::{Record, Sample};

fn sample(tick: u64, mode: Mode) -> Sample {
    let setpoint = Motion::default().setpoint(&crate::motion::Scale::new(20_000.0));
    Sample {
        tick,
        mode,
        fault: None,
        setpoint,
        point: setpoint,
        pivot_setpoints: Default::default(),
        pivot_rates: [0.0; 3],
        pivots: Default::default(),
        duty: Default::default(),
        current_counts: [1, 2, 4000],
        supply_counts: 2978,
        tick_cycles: 0,
        commands: 0,
    }
}

fn run(history: &mut History<'_>, ticks: core::ops::Range<u64>, mode: Mode) {
    for tick in ticks {
        history.record(&sample(tick, mode));
    }
}

fn ticks(memory: &BlackBox) -> Vec<u32> {
    let Some(span) = memory.record() else {
        return Vec::new();
    };
    let mut cursor = span.begin();
    let rows: Vec<u32> = core::iter::from_fn(|| memory.next(&span, &mut cursor))
        .map(|row| row.tick)
        .collect();
    assert_eq!(rows.len(), span.rows as usize);
    rows
}

#[test]
fn a_fault_freezes_the_ticks_around_it() {
    let memory = BlackBox::new();
    let mut history = memory.begin();
    run(&mut history, 1..1_000, Mode::Moving);
    assert_eq!(ticks(&memory), [], "it is being written");
    run(&mut history, 1_000..5_000, Mode::Fault);
    let expected: Vec<u32> = (1_000 + AFTER - ROWS as u32..1_000 + AFTER).collect();
    assert_eq!(ticks(&memory), expected);
    // Acknowledged, and still there until the servo is on.
    run(&mut history, 5_000..5_100, Mode::Off);
    assert_eq!(ticks(&memory), expected);
    run(&mut history, 5_100..5_101, Mode::Holding);
    assert_eq!(ticks(&memory), []);
}

#[test]
fn a_reset_freezes_what_was_written_and_a_torn_row_is_left_out() {
    let memory = BlackBox::new();
    run(&mut memory.begin(), 1..1_000, Mode::Moving);
    // The row of tick 744, in the middle of which the reset came.
    memory.rows.write(744, &[7; row::WORDS]);
    run(&mut memory.begin(), 1..100, Mode::Off);
    let expected: Vec<u32> = (745..1_000).collect();
    assert_eq!(ticks(&memory), expected);
}

#[test]
fn rows_of_an_earlier_start_do_not_mix_with_later_ones() {
    let memory = BlackBox::new();
    run(&mut memory.begin(), 1..300, Mode::Moving);
    let mut history = memory.begin();
    run(&mut history, 1..50, Mode::Holding);
    run(&mut history, 50..200, Mode::Fault);
    let expected: Vec<u32> = (1..50 + AFTER).collect();
    assert_eq!(ticks(&memory), expected);
}

#[test]
fn any_content_is_a_valid_one() {
    // As after a power-up: the mark by chance, and everything else too.
    let memory = BlackBox::new();
    memory.mark.store(MARK, Ordering::Relaxed);
    let mut word = 1u32;
    for _ in 0..200 {
        for number in 0..ROWS as u32 {
            let words = core::array::from_fn(|_| {
                word = word.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                word
            });
            memory.rows.write(number, &words);
        }
        let _ = memory.begin();
        assert!(ticks(&memory).len() <= ROWS);
    }
}

#[test]
fn a_flipped_bit_is_no_entry() {
    let entries: Entries<2, 4> = Entries::new();
    assert_eq!(entries.read(0), None, "never written");
    entries.write(1, &[1, 2, 3, 0]);
    let good = entries.read(1).unwrap();
    assert_eq!(good[..3], [1, 2, 3]);
    for at in 0..4 {
        for bit in 0..32 {
            entries.flip(1, at, bit);
            assert_eq!(entries.read(1), None, "bit {bit} of word {at}");
            entries.flip(1, at, bit);
        }
    }
    assert_eq!(entries.read(1), Some(good));
}

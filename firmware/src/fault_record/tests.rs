use super::checked_words::CheckedEntries;
use super::memory::LAYOUT_MAGIC;
use super::*;
use crate::mode::Mode;
use crate::motion::PlanFollower;
use crate::recorder::{Sample, TickObserver};
use core::sync::atomic::Ordering;

fn sample(tick: u64, mode: Mode) -> Sample {
    let setpoint = PlanFollower::default().setpoint(&crate::motion::SetpointScale::new(20_000.0));
    Sample {
        tick,
        mode,
        fault: None,
        setpoint,
        reference_point: setpoint,
        pivot_setpoints: Default::default(),
        pivot_rates: [0.0; 3],
        pivots: Default::default(),
        duty: Default::default(),
        current_counts: [1, 2, 4000],
        supply_counts: 2978,
        tick_cycles: 0,
        commands: 0,
        servo: None,
    }
}

fn run(history: &mut FaultRecordWriter<'_>, ticks: core::ops::Range<u64>, mode: Mode) {
    for tick in ticks {
        history.observe(&sample(tick, mode));
    }
}

fn ticks(memory: &RetainedMemory) -> Vec<u32> {
    let Some(span) = memory.fault_record() else {
        return Vec::new();
    };
    let mut cursor = span.first_row();
    let rows: Vec<u32> = core::iter::from_fn(|| memory.next(&span, &mut cursor))
        .map(|row| row.tick)
        .collect();
    assert_eq!(rows.len(), span.rows as usize);
    rows
}

#[test]
fn a_fault_freezes_the_ticks_around_it() {
    let memory = RetainedMemory::new();
    let mut history = memory.begin();
    run(&mut history, 1..1_000, Mode::Moving);
    assert_eq!(ticks(&memory), [], "it is being written");
    run(&mut history, 1_000..5_000, Mode::Fault);
    let expected: Vec<u32> =
        (1_000 + ROWS_AFTER_FAULT - FAULT_RECORD_ROWS as u32..1_000 + ROWS_AFTER_FAULT).collect();
    assert_eq!(ticks(&memory), expected);
    // Acknowledged, and still there until the servo is on.
    run(&mut history, 5_000..5_100, Mode::Off);
    assert_eq!(ticks(&memory), expected);
    run(&mut history, 5_100..5_101, Mode::Holding);
    assert_eq!(ticks(&memory), []);
}

#[test]
fn a_reset_freezes_what_was_written_and_a_torn_row_is_left_out() {
    let memory = RetainedMemory::new();
    run(&mut memory.begin(), 1..1_000, Mode::Moving);
    // The row of tick 744, in the middle of which the reset came.
    memory.rows.write(744, &[7; row::WORDS]);
    run(&mut memory.begin(), 1..100, Mode::Off);
    let expected: Vec<u32> = (745..1_000).collect();
    assert_eq!(ticks(&memory), expected);
}

#[test]
fn rows_of_an_earlier_start_do_not_mix_with_later_ones() {
    let memory = RetainedMemory::new();
    run(&mut memory.begin(), 1..300, Mode::Moving);
    let mut history = memory.begin();
    run(&mut history, 1..50, Mode::Holding);
    run(&mut history, 50..200, Mode::Fault);
    let expected: Vec<u32> = (1..50 + ROWS_AFTER_FAULT).collect();
    assert_eq!(ticks(&memory), expected);
}

#[test]
fn any_content_is_a_valid_one() {
    // As after a power-up: the mark by chance, and everything else too.
    let memory = RetainedMemory::new();
    memory.layout.store(LAYOUT_MAGIC, Ordering::Relaxed);
    let mut word = 1u32;
    for _ in 0..200 {
        for number in 0..FAULT_RECORD_ROWS as u32 {
            let words = core::array::from_fn(|_| {
                word = word.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                word
            });
            memory.rows.write(number, &words);
        }
        let _ = memory.begin();
        assert!(ticks(&memory).len() <= FAULT_RECORD_ROWS);
    }
}

#[test]
fn a_flipped_bit_is_no_entry() {
    let entries: CheckedEntries<2, 4> = CheckedEntries::new();
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

#[test]
fn words_that_have_changed_places_are_no_entry() {
    let entries: CheckedEntries<2, 4> = CheckedEntries::new();
    entries.write(1, &[1, 2, 3, 0]);
    // The same words in another order, with the check of the first.
    for bit in 0..2 {
        entries.flip(1, 0, bit);
        entries.flip(1, 1, bit);
    }
    assert_eq!(entries.read(1), None);
}

#[test]
fn memory_that_is_marked_otherwise_is_empty() {
    let memory = RetainedMemory::new();
    run(&mut memory.begin(), 1..1_000, Mode::Moving);
    memory.layout.store(LAYOUT_MAGIC ^ 1, Ordering::Relaxed);
    memory.begin();
    assert_eq!(ticks(&memory), []);
    assert_eq!(memory.start.load(Ordering::Relaxed), 1);
}

/// A row whose writing failed leaves an older one in its place.
#[test]
fn a_row_of_another_tick_or_start_is_left_out() {
    for (tick, start) in [(900 - FAULT_RECORD_ROWS as u64, 1), (900, 0)] {
        let memory = RetainedMemory::new();
        run(&mut memory.begin(), 1..1_000, Mode::Moving);
        let words = row::words(&sample(tick, Mode::Moving), start);
        memory.rows.write(900, &words);
        memory.begin();
        let expected: Vec<u32> = (744..1_000).filter(|&tick| tick != 900).collect();
        assert_eq!(ticks(&memory), expected, "tick {tick} of start {start}");
    }
}

#[test]
fn a_row_is_what_the_tick_was() {
    let mut sample = sample(7, Mode::Stopping);
    sample.fault = Some(crate::fault::FaultKind::EncoderSilent);
    let angle = |units| kinematics::Angle::from_units(units);
    sample.pivots = [10, 2_000, -30].map(angle);
    sample.pivot_setpoints = [11, 2_200, -33].map(angle);
    sample.duty = [-100, 200, -300].map(crate::drivers::bridge::Duty);
    sample.current_counts = [4, -800, 1_200];
    sample.tick_cycles = 70_000;
    let row = row::row(&row::words(&sample, 1));
    assert_eq!(
        (row.tick, row.mode, row.fault),
        (7, Mode::Stopping as u8, 1)
    );
    assert_eq!(row.pivots, [10, 2_000, 30_u32.wrapping_neg()]);
    assert_eq!(row.errors, [-1, -200, 3]);
    assert_eq!(row.duty, [-100, 200, -300]);
    assert_eq!(row.current_counts, [4, -800, 1_200]);
    assert_eq!((row.supply_counts, row.tick_cycles), (2_978, 0xFFFF));
}

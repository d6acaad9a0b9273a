//! The recorder between its two ends: rows, decimation, each trigger and its twin that does not fire, rows before the trigger.

use firmware::drivers::bridge::Duty;
use firmware::fault::FaultKind;
use firmware::mode::Mode;
use firmware::motion::Setpoint;
use firmware::recorder::{
    LevelTrigger, Progress, RawSignal, RecordSetup, Recorder, RecorderReader, RecorderWriter,
    Sample,
};
use kinematics::Angle;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed, TestRunner};

const WORDS: usize = 64;

/// Units of a recorded angle in a turn.
const TURN: i64 = 1 << 28;

/// A recorder whose tick is fed by hand.
struct Bench {
    tick: RecorderWriter<'static>,
    panel: RecorderReader<'static>,
    now: u64,
}

/// A tick in which everything is a function of its number.
fn sample(now: u64) -> Sample {
    Sample {
        tick: now,
        mode: Mode::Holding,
        fault: None,
        setpoint: Setpoint::default(),
        reference_point: Setpoint::default(),
        pivot_setpoints: [Angle::ZERO; 3],
        pivot_rates: [now as f32 - 50.0, 0.0, 0.0],
        pivots: [Angle::ZERO; 3],
        duty: [Duty(now as i16), Duty(0), Duty(0)],
        current_counts: [0; 3],
        supply_counts: 0,
        tick_cycles: 0,
        commands: 0,
        servo: None,
    }
}

impl Bench {
    fn new() -> Self {
        let (tick, panel) = Box::leak(Box::new(Recorder::<WORDS>::new())).split();
        Self {
            tick,
            panel,
            now: 0,
        }
    }

    fn feed(&mut self, sample: &Sample) {
        if self.tick.is_active() {
            self.tick.observe(sample);
        }
    }

    /// Ticks up to number `end`.
    fn run_to(&mut self, end: u64) {
        while self.now < end {
            self.now += 1;
            self.feed(&sample(self.now));
        }
    }

    fn progress(&self) -> Progress {
        self.panel.progress(1)
    }

    /// The first word of every row.
    fn rows(&self, setup: &RecordSetup) -> Vec<i64> {
        let mut cursor = self.panel.seek(setup, 0);
        (0..self.progress().rows)
            .map(|_| self.panel.next(setup, &mut cursor)[0])
            .collect()
    }
}

fn setup(rows: u32) -> RecordSetup {
    let mut setup = RecordSetup {
        number: 1,
        every: 1,
        rows,
        ..RecordSetup::default()
    };
    setup.signals.push(RawSignal::Duty(0)).unwrap();
    setup
}

#[test]
fn at_once() {
    let mut bench = Bench::new();
    bench.run_to(10);
    let setup = RecordSetup {
        now: true,
        ..setup(5)
    };
    bench.panel.start(&setup).unwrap();
    assert_eq!(bench.progress().rows, 0);
    bench.run_to(13);
    // What is complete can be read while the rest is being written.
    assert_eq!(bench.rows(&setup), [11, 12, 13]);
    bench.run_to(30);
    assert_eq!(bench.rows(&setup), [11, 12, 13, 14, 15]);
    assert!(!bench.tick.is_active());
}

#[test]
fn nothing_is_recorded_without_a_trigger() {
    let mut bench = Bench::new();
    bench.panel.start(&setup(5)).unwrap();
    bench.run_to(100);
    assert_eq!(bench.progress().rows, 0);
    assert!(bench.tick.is_active());
    bench.panel.stop().unwrap();
    bench.run_to(101);
    assert!(!bench.tick.is_active());
}

#[test]
fn every_third_tick() {
    let mut bench = Bench::new();
    let setup = RecordSetup {
        every: 3,
        now: true,
        ..setup(4)
    };
    bench.panel.start(&setup).unwrap();
    bench.run_to(100);
    assert_eq!(bench.rows(&setup), [1, 4, 7, 10]);
}

#[test]
fn a_command_that_is_expected() {
    for expected in [true, false] {
        let mut bench = Bench::new();
        let setup = setup(3);
        bench.panel.start(&setup).unwrap();
        bench.run_to(10);
        bench.panel.trigger_at(Some(7)).unwrap();
        if !expected {
            bench.panel.trigger_at(None).unwrap();
        }
        bench.run_to(20);
        assert_eq!(bench.progress().rows, 0);
        for now in 21..=24 {
            bench.feed(&Sample {
                commands: 7,
                ..sample(now)
            });
        }
        let rows: &[i64] = if expected { &[21, 22, 23] } else { &[] };
        assert_eq!(bench.rows(&setup), rows);
    }
}

/// The first rows of a record that watches a word for a value.
fn crossing(word: RawSignal, value: f64, rising: bool) -> Vec<i64> {
    let mut bench = Bench::new();
    let mut setup = setup(2);
    let watch = LevelTrigger::new(word, value, rising);
    setup.level_triggers.push(watch).unwrap();
    bench.panel.start(&setup).unwrap();
    bench.run_to(100);
    bench.rows(&setup)
}

#[test]
fn a_value_that_is_crossed() {
    // Integers.
    assert_eq!(crossing(RawSignal::Duty(0), 40.0, true), [40, 41]);
    assert_eq!(crossing(RawSignal::Duty(0), 39.5, true), [40, 41]);
    // The other way, out of reach, or already there: nothing is crossed.
    assert_eq!(crossing(RawSignal::Duty(0), 40.0, false), []);
    assert_eq!(crossing(RawSignal::Duty(0), 101.0, true), []);
    assert_eq!(crossing(RawSignal::Duty(0), 1.0, true), []);
    // Floats, negative ones too.
    assert_eq!(crossing(RawSignal::PivotRate(0), -20.0, true), [30, 31]);
    assert_eq!(crossing(RawSignal::PivotRate(0), 0.0, true), [50, 51]);
    assert_eq!(crossing(RawSignal::PivotRate(0), -20.0, false), []);
}

#[test]
fn a_value_that_is_crossed_downwards() {
    for (start, rows) in [(50, &[51_i64, 52][..]), (20, &[])] {
        let mut bench = Bench::new();
        let mut setup = setup(2);
        let watch = LevelTrigger::new(RawSignal::Current(0), 30.0, false);
        setup.level_triggers.push(watch).unwrap();
        bench.panel.start(&setup).unwrap();
        for now in 1..=70_u64 {
            let counts = (80 - now).min(start) as i16;
            bench.feed(&Sample {
                current_counts: [counts; 3],
                ..sample(now)
            });
        }
        assert_eq!(bench.rows(&setup), rows);
    }
}

#[test]
fn a_fault() {
    // One that comes, none, and one that was there before.
    for (from, rows) in [(21, &[21_i64, 22, 23][..]), (99, &[]), (1, &[])] {
        let mut bench = Bench::new();
        let mut setup = RecordSetup {
            fault: true,
            ..setup(3)
        };
        setup.signals.push(RawSignal::Fault).unwrap();
        bench.panel.start(&setup).unwrap();
        for now in 1..60 {
            let faulted = now >= from;
            bench.feed(&Sample {
                mode: if faulted { Mode::Fault } else { Mode::Off },
                fault: faulted.then_some(FaultKind::EncoderCrc),
                ..sample(now)
            });
        }
        assert_eq!(bench.rows(&setup), rows, "{from}");
        if !rows.is_empty() {
            let mut cursor = bench.panel.seek(&setup, 0);
            let fault = bench.panel.next(&setup, &mut cursor)[1];
            assert_eq!(fault, FaultKind::EncoderCrc as i64 + 1);
        }
    }
}

#[test]
fn rows_before_the_trigger() {
    for (at, before, rows) in [
        (30, 4, [26_i64, 27, 28, 29, 30, 31]),
        // Fewer are there: the record is as long, and begins later.
        (3, 2, [1, 2, 3, 4, 5, 6]),
    ] {
        let mut bench = Bench::new();
        let mut setup = RecordSetup {
            before: 4,
            ..setup(6)
        };
        let watch = LevelTrigger::new(RawSignal::Duty(0), at as f64, true);
        setup.level_triggers.push(watch).unwrap();
        bench.panel.start(&setup).unwrap();
        bench.run_to(at - 1);
        assert_eq!(bench.progress().rows, 0);
        bench.run_to(at);
        let progress = Progress {
            rows: before + 1,
            before,
        };
        assert_eq!(bench.progress(), progress);
        bench.run_to(100);
        assert_eq!(bench.rows(&setup), rows);
    }
}

#[test]
fn rows_before_the_trigger_at_a_lower_rate() {
    let mut bench = Bench::new();
    let mut setup = RecordSetup {
        before: 3,
        every: 10,
        ..setup(6)
    };
    let watch = LevelTrigger::new(RawSignal::Duty(0), 75.0, true);
    setup.level_triggers.push(watch).unwrap();
    bench.panel.start(&setup).unwrap();
    bench.run_to(200);
    // Equally far apart; the trigger's row is the first one after it.
    assert_eq!(bench.rows(&setup), [51, 61, 71, 81, 91, 101]);
    assert_eq!(bench.progress().before, 3);
}

#[test]
fn a_record_that_waits_leaves_the_last_one_alone() {
    let mut bench = Bench::new();
    let first = RecordSetup {
        now: true,
        ..setup(3)
    };
    bench.panel.start(&first).unwrap();
    bench.run_to(10);
    let second = RecordSetup {
        number: 2,
        commands: Some(1),
        ..setup(3)
    };
    bench.panel.start(&second).unwrap();
    bench.run_to(20);
    assert_eq!(bench.rows(&first), [1, 2, 3]);
    assert_eq!(bench.panel.progress(2), Progress::default());
    bench.feed(&Sample {
        commands: 1,
        ..sample(21)
    });
    assert_eq!(bench.progress(), Progress::default());
    assert_eq!(bench.panel.progress(2).rows, 1);
}

#[test]
fn a_full_queue_is_told_and_nothing_is_lost() {
    let mut bench = Bench::new();
    let setup = setup(3);
    bench.panel.start(&setup).unwrap();
    bench.panel.trigger_at(None).unwrap();
    bench.panel.trigger_at(Some(0)).unwrap();
    assert!(bench.panel.stop().is_err());
    bench.run_to(1);
    assert_eq!(bench.rows(&setup), [1]);
    assert!(bench.panel.stop().is_ok());
}

#[test]
fn a_record_that_is_too_long_leaves_rows_out_and_does_no_harm() {
    let mut bench = Bench::new();
    let mut setup = RecordSetup {
        now: true,
        ..setup(40)
    };
    setup.signals.push(RawSignal::Mode).unwrap();
    bench.panel.start(&setup).unwrap();
    bench.run_to(100);
    let rows = bench.rows(&setup);
    assert_eq!(rows[..32], (1..=32).collect::<Vec<_>>());
    assert_eq!(rows[32..], [0; 8]);
}

/// Turns are put back whatever the start, the way of the ring and the speed up to nearly eight turns a row.
#[test]
fn turns_are_put_back() {
    let mut runner = TestRunner::new(Config {
        cases: 500,
        rng_seed: RngSeed::Fixed(20_261_121),
        failure_persistence: None,
        ..Config::default()
    });
    let turns = 1_000_000_000 * TURN;
    let step = -7 * TURN..7 * TURN;
    let cases = (
        -turns..turns,
        step,
        0..30_u32,
        1..60_u64,
        0..WORDS as u32 / 2,
    );
    runner
        .run(&cases, |(start, step, before, trigger, from)| {
            let mut bench = Bench::new();
            let mut setup = RecordSetup {
                before,
                commands: Some(1),
                ..setup(WORDS as u32 / 2)
            };
            setup.signals.clear();
            setup.signals.push(RawSignal::Pivot(1)).unwrap();
            setup.signals.push(RawSignal::Theta).unwrap();
            bench.panel.start(&setup).unwrap();
            let at = |row: u64| start + row as i64 * step;
            for row in 0..trigger + 64 {
                let mut setpoint = Setpoint::default();
                setpoint.position[2] = -at(row) << 4;
                bench.feed(&Sample {
                    pivots: [Angle::from_units(at(row) << 4); 3],
                    setpoint,
                    commands: u32::from(row >= trigger),
                    ..sample(row)
                });
            }
            let progress = bench.progress();
            prop_assert_eq!(progress.rows, setup.rows);
            prop_assert_eq!(u64::from(progress.before), trigger.min(before.into()));
            let first = trigger - u64::from(progress.before);
            let mut cursor = bench.panel.seek(&setup, from);
            for row in from..progress.rows {
                let values = bench.panel.next(&setup, &mut cursor);
                let expected = at(first + u64::from(row));
                prop_assert_eq!(&values[..2], &[expected, -expected][..]);
            }
            Ok(())
        })
        .unwrap();
}

//! Iterative learning against independent computations in double precision, by what it is said to do: a table's voltage is linear between
//! its points; what a trial would have needed is `u + v - P^-1 e`; that, smoothed by a quarter of each neighbour, is the next table.
//!
//! A trial is driven as the tick drives it, with signals that are known beforehand. Twice: with any signals, against sums and
//! differences of whole arrays; and with a sine of each frequency, against transfer functions.

mod proptest_settings;

use firmware::iterative_learning::{
    InversePlant, Repeated, ServoStep, TableName, Tables, Trial, TrialControl, TrialMemory,
    TrialTable,
};
use proptest::prelude::*;
use proptest_settings::settings;
use std::f64::consts::TAU;

const TICK_HZ: f64 = 20_000.0;
/// Volts of a table's unit, and 2^-32 turns in a count.
const UNIT_V: f64 = 2e-3;
const UNITS_PER_COUNT: f64 = 64.0;
/// A correction is cut off to whole units, and so is the smoothed one; its half is rounded.
const LEARNT_WITHIN_V: f64 = 2.5 * UNIT_V;

/// What a pivot does in a trial, tick by tick.
#[derive(Clone, Default)]
struct Signals {
    error: Vec<f64>,
    feedback_v: Vec<f64>,
    /// What of the feedback is the integral when the trial starts.
    offset_v: f64,
}

/// What came of a trial.
struct Followed {
    /// Volts of each pivot, tick by tick.
    volts: [Vec<f64>; 3],
    /// What they were when it ended.
    left: [f64; 3],
}

/// Points of a table and ticks from one to the next.
#[derive(Clone, Copy)]
struct Size {
    points: usize,
    spacing: usize,
}

/// A trial of the plan of this number with these signals, as the tick has it: what the servos did, then a tick further.
fn follow(
    table: TrialTable<'_>,
    plan: u32,
    inverse: &[InversePlant; 3],
    signals: &[Signals; 3],
) -> Followed {
    let mut trial = Trial::default();
    assert_eq!(trial.advance(table, TICK_HZ as f32, Some((plan, 2))), None);
    assert!(trial.is_under_way());
    let mut volts: [Vec<f64>; 3] = Default::default();
    for tick in 0..signals[0].error.len() {
        for (i, volts) in volts.iter_mut().enumerate() {
            volts.push(trial.volts(i).into());
        }
        let steps = [0, 1, 2].map(|i: usize| ServoStep {
            error: signals[i].error[tick] as i32,
            feedback: signals[i].feedback_v[tick] as f32,
            integral: signals[i].offset_v as f32,
        });
        trial.record(table, inverse, &steps);
        let motion = Some((plan, tick as u64 + 3));
        if let Some(left) = trial.advance(table, TICK_HZ as f32, motion) {
            let left = left.map(f64::from);
            return Followed { volts, left };
        }
    }
    panic!("the trial has not ended");
}

/// A table's voltage at a tick: from nothing, through its points, each in the middle of its ticks, and a tick later from pivot to
/// pivot. The last one stays.
fn between(points: &[f64], spacing: usize, pivot: usize, tick: usize) -> f64 {
    let middle = (spacing / 2 + pivot) as f64;
    let tick = tick as f64;
    if tick <= middle {
        return points[0] * tick / middle;
    }
    let place = (tick - middle) / spacing as f64;
    let before = (place.floor() as usize).min(points.len() - 1);
    let after = (before + 1).min(points.len() - 1);
    points[before] + (points[after] - points[before]) * (place - before as f64).min(1.0)
}

/// Means over the ticks of each point, a tick later from pivot to pivot; the first one has those by which it is later as well, in the sum.
fn means(signal: &[f64], size: Size, pivot: usize) -> Vec<f64> {
    (0..size.points)
        .map(|point| {
            let end = (point + 1) * size.spacing + pivot;
            let begin = if point == 0 { 0 } else { end - size.spacing };
            signal[begin..end].iter().sum::<f64>() / size.spacing as f64
        })
        .collect()
}

/// `v - P^-1 e` at each point but the last two, at which nothing is known, V.
fn needed(signals: &Signals, size: Size, pivot: usize, inverse: &InversePlant) -> Vec<f64> {
    let step_s = size.spacing as f64 / TICK_HZ;
    // What holds the stage at rest is none of the motion's.
    let beyond: Vec<f64> = (signals.feedback_v.iter())
        .map(|volts| volts - signals.offset_v)
        .collect();
    let feedback = means(&beyond, size, pivot);
    let error = means(&signals.error, size, pivot);
    // Before the first tick it was what it was then.
    let at = |point: usize, by: isize| match point.checked_add_signed(by) {
        Some(point) => error[point],
        None => signals.error[0],
    };
    let [a, b] = [inverse.volt_s2, inverse.volt_s].map(f64::from);
    let undone = |point| {
        let first = (at(point, 1) - at(point, -1)) / (2.0 * step_s);
        let second = (at(point, 1) - 2.0 * at(point, 0) + at(point, -1)) / (step_s * step_s);
        a * second + b * first
    };
    // So much later, which is less than a point.
    let later = (f64::from(inverse.lead_ticks) / size.spacing as f64).min(1.0);
    (0..size.points - 2)
        .map(|point| {
            let undone = (1.0 - later) * undone(point) + later * undone(point + 1);
            feedback[point] - undone
        })
        .collect()
}

/// A quarter of each neighbour and a half of itself; beyond the last that is known it is as there.
fn smoothed(needed: &[f64], points: usize) -> Vec<f64> {
    let at = |point: usize| needed[point.min(needed.len() - 1)];
    (0..points)
        .map(|point| 0.25 * at(point.saturating_sub(1)) + 0.5 * at(point) + 0.25 * at(point + 1))
        .collect()
}

/// Root mean square over pivots and points, counts.
fn error_counts(signals: &[Signals; 3], size: Size) -> f64 {
    let squares = (0..3).map(|i| {
        let square: Vec<f64> = (signals[i].error.iter())
            .map(|error| (error / UNITS_PER_COUNT).powi(2))
            .collect();
        means(&square, size, i).iter().sum::<f64>()
    });
    (squares.sum::<f64>() / (3 * size.points) as f64).sqrt()
}

/// A memory in which a table learns, of a motion of so many ticks.
struct Learner {
    tables: Tables,
    motion: Repeated,
    plan: u32,
}

impl Learner {
    fn new(ticks: u64) -> Self {
        let mut tables = Tables::new();
        let name = TableName::try_from("A").expect("it is short");
        tables.learn(name).expect("there is room");
        let motion = Repeated { key: 7, ticks };
        Self {
            tables,
            motion,
            plan: 0,
        }
    }

    /// The next trial's table is open.
    fn open(&mut self, control: &mut TrialControl<'_>) -> (u32, Size) {
        self.plan += 1;
        self.tables.prepare(self.plan, &self.motion, control);
        let report = self.tables.reports().next().expect("there is one");
        let size = Size {
            points: report.points,
            spacing: report.spacing_ticks as usize,
        };
        (self.plan, size)
    }

    /// It has learnt; what is told of the last trial, counts.
    fn learn(&mut self, control: &mut TrialControl<'_>) -> f64 {
        assert!(control.is_done());
        self.tables.take_result(control);
        let report = self.tables.reports().next().expect("there is one");
        report.error_counts[2].into()
    }
}

/// Size, frequency in Hz and phase.
type Sine = (f64, f64, f64);

/// What the signals of a pivot are made of: some sines, and a step of the feedback by 2 V.
#[derive(Clone, Debug)]
struct Waves {
    errors: [Sine; 3],
    feedbacks: [Sine; 3],
    offset_v: f64,
    step_at: usize,
}

impl Waves {
    /// With an error of this share.
    fn signals(&self, share: f64) -> Signals {
        let sum = |sines: &[Sine; 3], tick: usize| {
            let time_s = tick as f64 / TICK_HZ;
            (sines.iter())
                .map(|(size, hz, phase)| size * (TAU * hz * time_s + phase).sin())
                .sum::<f64>()
        };
        Signals {
            error: (0..20_000)
                .map(|tick| (share * 3_000.0 * sum(&self.errors, tick)).round())
                .collect(),
            feedback_v: (0..20_000)
                .map(|tick| {
                    let step = if tick < self.step_at { 0.0 } else { 2.0 };
                    self.offset_v + 3.0 * sum(&self.feedbacks, tick) + step
                })
                .collect(),
            offset_v: self.offset_v,
        }
    }
}

fn any_waves() -> impl Strategy<Value = Waves> {
    let sine = || (0.1..1.0_f64, 10.0..400.0_f64, 0.0..TAU);
    let pivot = (
        [sine(), sine(), sine()],
        [sine(), sine(), sine()],
        -10.0..10.0_f64,
        0_usize..2_000,
    );
    pivot.prop_map(|(errors, feedbacks, offset_v, step_at)| Waves {
        errors,
        feedbacks,
        offset_v,
        step_at,
    })
}

fn any_inverse() -> impl Strategy<Value = InversePlant> {
    // The reference drive has 3.4e-11, 4.4e-9 and 8.1.
    (1e-12..1e-10_f32, 1e-10..2e-8_f32, 0.0..25.0_f32).prop_map(|(volt_s2, volt_s, lead_ticks)| {
        InversePlant {
            volt_s2,
            volt_s,
            lead_ticks,
        }
    })
}

proptest! {
    #![proptest_config(settings(60))]

    /// Three trials, each half as bad as the one before: a quarter is learnt of the first, and since a step gains more than it
    /// should, a half and all of those to come.
    #[test]
    fn a_table_becomes_what_the_trials_would_have_needed(
        ticks in 60_u64..18_000,
        waves in [any_waves(), any_waves(), any_waves()],
        inverse in [any_inverse(), any_inverse(), any_inverse()],
    ) {
        let mut memory = Box::new(TrialMemory::new());
        let (mut control, table) = memory.split();
        let mut learner = Learner::new(ticks);
        let mut exact: [Vec<f64>; 3] = Default::default();
        for (trial, (share, step)) in [(1.0, 0.25), (0.5, 0.5), (0.25, 1.0)].into_iter().enumerate() {
            let signals = waves.each_ref().map(|waves| waves.signals(share));
            let (plan, size) = learner.open(&mut control);
            prop_assert!(size.points * size.spacing >= ticks as usize);
            let followed = follow(table, plan, &inverse, &signals);
            for (i, exact) in exact.iter_mut().enumerate() {
                exact.resize(size.points, 0.0);
                // What every trial has brought may be off by so much.
                let within = LEARNT_WITHIN_V * trial as f64 + 2e-5;
                for (tick, volts) in followed.volts[i].iter().enumerate() {
                    let expected = between(exact, size.spacing, i, tick);
                    prop_assert!(
                        (volts - expected).abs() < within,
                        "trial {trial}, pivot {i}, tick {tick}: {volts} V for {expected}"
                    );
                }
                let expected = exact[size.points - 1];
                prop_assert!((followed.left[i] - expected).abs() < within);
                let needed = needed(&signals[i], size, i, &inverse[i]);
                for (point, expected) in needed.iter().enumerate() {
                    let volts = f64::from(control.correction(point)[i]) * UNIT_V;
                    prop_assert!(
                        (volts - expected).abs() < 1.01 * UNIT_V,
                        "trial {trial}, pivot {i}, point {point}: {volts} V for {expected}"
                    );
                }
                for (exact, more) in exact.iter_mut().zip(smoothed(&needed, size.points)) {
                    *exact += step * more;
                }
            }
            let told = learner.learn(&mut control);
            let expected = error_counts(&signals, size);
            prop_assert!((told - expected).abs() < 1e-4 * expected, "{told} counts for {expected}");
        }
    }

    /// From a sine of a frequency in error and in feedback to the table, by transfer functions: the mean over a point's ticks, the
    /// differences in place of derivatives, the time by which a voltage is later, the smoothing.
    #[test]
    fn a_table_has_its_transfer_function(
        ticks in 2_000_u64..18_000,
        hz in 5.0..450.0_f64,
        error in (0.0..8_000.0_f64, 0.0..TAU),
        feedback in (0.0..8.0_f64, 0.0..TAU),
        inverse in any_inverse(),
    ) {
        let mut memory = Box::new(TrialMemory::new());
        let (mut control, table) = memory.split();
        let mut learner = Learner::new(ticks);
        let phase = |tick: usize| TAU * hz * tick as f64 / TICK_HZ;
        let signals = Signals {
            error: (0..20_000).map(|tick| (error.0 * (phase(tick) + error.1).sin()).round()).collect(),
            feedback_v: (0..20_000).map(|tick| feedback.0 * (phase(tick) + feedback.1).sin()).collect(),
            offset_v: 0.0,
        };
        let signals = [signals.clone(), signals.clone(), signals];
        let (plan, size) = learner.open(&mut control);
        follow(table, plan, &[inverse; 3], &signals);
        learner.learn(&mut control);
        let (plan, _) = learner.open(&mut control);
        let followed = follow(table, plan, &[inverse; 3], &signals);

        let step_s = size.spacing as f64 / TICK_HZ;
        let turn = TAU * hz * step_s;
        let mean = (0.5 * turn).sin() / (size.spacing as f64 * (0.5 * turn / size.spacing as f64).sin());
        let smoothing = 0.5 + 0.5 * turn.cos();
        let [a, b] = [inverse.volt_s2, inverse.volt_s].map(f64::from);
        // Of the second and the first derivative.
        let [re, im] = [
            -a * (2.0 - 2.0 * turn.cos()) / (step_s * step_s),
            b * turn.sin() / step_s,
        ];
        let later = (f64::from(inverse.lead_ticks) / size.spacing as f64).min(1.0);
        let [later_re, later_im] = [1.0 - later + later * turn.cos(), later * turn.sin()];
        let [undone_re, undone_im] = [re * later_re - im * later_im, re * later_im + im * later_re];
        // Away from both ends, where the signals begin and nothing is known.
        for i in 0..3 {
            for point in 4..size.points.saturating_sub(5) {
                let begin = point * size.spacing + i;
                let middle = begin as f64 + 0.5 * (size.spacing as f64 - 1.0);
                let phase = TAU * hz * middle / TICK_HZ;
                let (e_sin, e_cos) = (phase + error.1).sin_cos();
                let needed = feedback.0 * (phase + feedback.1).sin()
                    - error.0 * (undone_re * e_sin + undone_im * e_cos);
                // The first step.
                let expected = 0.25 * smoothing * mean * needed;
                let tick = size.spacing / 2 + i + point * size.spacing;
                let volts = followed.volts[i][tick];
                // Whole numbers of the error are half a unit off at most, which second differences raise.
                let rounded = 0.5 * (a / (step_s * step_s) + b / step_s) / (size.spacing as f64).sqrt();
                prop_assert!(
                    (volts - expected).abs() < LEARNT_WITHIN_V + rounded,
                    "pivot {i}, point {point} of {}: {volts} V for {expected}", size.points
                );
            }
        }
    }
}

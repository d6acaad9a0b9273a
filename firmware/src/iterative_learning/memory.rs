//! The memory of a trial, and its two ends.
//!
//! The command side fills the table and opens it for a plan; the tick follows it when that plan starts, leaves what the feedback had to
//! add in its place, and closes it. Each writes only while it is its turn, which `state` says.

use core::ops::Range;
use core::sync::atomic::{AtomicBool, AtomicI16, AtomicU8, AtomicU32, Ordering};

/// Points of a trial.
pub const TRIAL_POINTS: usize = 800;

/// Volts of a table's unit: a fifth of a PWM count.
pub(super) const VOLTS_PER_UNIT: f32 = 2e-3;

/// A table: a point of each pivot.
pub(super) type Points = [[AtomicI16; 3]; TRIAL_POINTS];

/// Nothing to be followed: the command side's turn.
const CLOSED: u8 = 0;
/// To be followed by the plan whose number stands beside it, or being followed: the tick's turn.
const OPEN: u8 = 1;
/// It was followed, and what it brought lies there: the command side's turn.
const DONE: u8 = 2;

/// Points of all tables together: each has two of them for a point of its motion, the best one and the one that is tried next.
pub const POOL_POINTS: usize = 2 * TRIAL_POINTS;

/// A point: volts in the memory's unit, of each pivot.
pub type Point = [i16; 3];

/// The memory of iterative learning. All zero at first: as a static it costs no flash. What is kept of the tables stands here too:
/// among the rest of the command side it would stand on the stack when that is made.
pub struct TrialMemory {
    trial: SharedTrial,
    pool: [Point; POOL_POINTS],
}

/// The memory of a trial.
struct SharedTrial {
    state: AtomicU8,
    /// There are tables: what they hold is what the model lacks as it is now, so the servos learn nothing of it meanwhile.
    holds_model: AtomicBool,
    /// Number of the plan that starts it.
    plan: AtomicU32,
    /// Points of the table, and ticks from one to the next.
    points: AtomicU32,
    spacing_ticks: AtomicU32,
    /// What the plan ahead is given besides, and what the feedback had to add to it, less what it did not hold.
    volts: Points,
    corrections: Points,
    /// Points that the tick has left.
    recorded: AtomicU32,
    /// Sum of the pivots' mean squares over them, encoder counts, as the bits of a float.
    square_sum: AtomicU32,
}

/// The end outside of the tick, and the points of the tables, which are its own.
pub struct TrialControl<'a> {
    trial: &'a SharedTrial,
    pub(super) pool: &'a mut [Point; POOL_POINTS],
}

/// The end in the tick.
#[derive(Clone, Copy)]
pub struct TrialTable<'a>(&'a SharedTrial);

/// What a trial left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrialResult {
    /// Points that were followed, from the first.
    pub points: usize,
    /// Root mean square of the pivots' following errors over them, encoder counts.
    pub error_counts: f32,
}

impl TrialMemory {
    /// Empty.
    #[allow(clippy::new_without_default)] // A default of 20 KB is nothing to be made in passing.
    pub const fn new() -> Self {
        Self {
            trial: SharedTrial::new(),
            pool: [[0; 3]; POOL_POINTS],
        }
    }

    /// The end outside of the tick, and the one in it.
    pub fn split(&mut self) -> (TrialControl<'_>, TrialTable<'_>) {
        let Self { trial, pool } = self;
        (TrialControl { trial, pool }, TrialTable(trial))
    }
}

impl SharedTrial {
    const fn new() -> Self {
        Self {
            state: AtomicU8::new(CLOSED),
            holds_model: AtomicBool::new(false),
            plan: AtomicU32::new(0),
            points: AtomicU32::new(0),
            spacing_ticks: AtomicU32::new(0),
            volts: [const { [const { AtomicI16::new(0) }; 3] }; TRIAL_POINTS],
            corrections: [const { [const { AtomicI16::new(0) }; 3] }; TRIAL_POINTS],
            recorded: AtomicU32::new(0),
            square_sum: AtomicU32::new(0),
        }
    }
}

impl TrialControl<'_> {
    /// Opens these points of the pool as a table for the plan of this number. What was open before is no more.
    pub(super) fn open(&mut self, plan: u32, spacing_ticks: u32, table: Range<usize>) {
        let memory = self.trial;
        memory.state.store(CLOSED, Ordering::Release);
        let mut points = 0;
        for (point, volts) in memory.volts.iter().zip(&self.pool[table]) {
            for (point, volts) in point.iter().zip(volts) {
                point.store(*volts, Ordering::Relaxed);
            }
            points += 1;
        }
        memory.recorded.store(0, Ordering::Relaxed);
        memory.plan.store(plan, Ordering::Relaxed);
        memory.points.store(points, Ordering::Relaxed);
        memory.spacing_ticks.store(spacing_ticks, Ordering::Relaxed);
        memory.state.store(OPEN, Ordering::Release);
    }

    /// The motion will not be what the table is for, or there will be none: the tick lets go of it without a step.
    pub fn cancel(&mut self) {
        self.trial.state.store(CLOSED, Ordering::Release);
    }

    /// Whether the tick is through with a table.
    pub fn is_done(&self) -> bool {
        self.trial.state.load(Ordering::Acquire) == DONE
    }

    /// What a trial has left so far. It is over, whether the tick is through with it or not.
    pub fn finish(&mut self) -> Option<TrialResult> {
        let memory = self.trial;
        if memory.state.swap(CLOSED, Ordering::AcqRel) == CLOSED {
            return None;
        }
        let points = memory.recorded.load(Ordering::Acquire) as usize;
        let sum = f32::from_bits(memory.square_sum.load(Ordering::Relaxed));
        (points > 0).then(|| TrialResult {
            points,
            error_counts: libm::sqrtf(sum / (3 * points) as f32),
        })
    }

    /// Whether the servos are to learn nothing of their own.
    pub fn hold_model(&mut self, holds: bool) {
        self.trial.holds_model.store(holds, Ordering::Relaxed);
    }

    /// A point of what the feedback had to add in the last trial.
    pub fn correction(&self, point: usize) -> [i16; 3] {
        (self.trial.corrections.get(point)).map_or([0; 3], |point| {
            [0, 1, 2].map(|i| point[i].load(Ordering::Relaxed))
        })
    }
}

impl TrialTable<'_> {
    /// Whether a table is open, and for the plan of which number.
    #[inline]
    pub(super) fn open_for(&self) -> Option<u32> {
        (self.0.state.load(Ordering::Acquire) == OPEN).then(|| self.0.plan.load(Ordering::Relaxed))
    }

    /// Whether the servos are to learn nothing of their own.
    #[inline]
    pub fn holds_model(&self) -> bool {
        self.0.holds_model.load(Ordering::Relaxed)
    }

    /// Points, and ticks from one to the next.
    pub(super) fn size(&self) -> (u32, u32) {
        let memory = self.0;
        (
            memory.points.load(Ordering::Relaxed),
            memory.spacing_ticks.load(Ordering::Relaxed),
        )
    }

    /// Volts of a point; 0 behind the last.
    #[inline]
    pub(super) fn volts(&self, point: u32, pivot: usize) -> f32 {
        let at = |points: &Points| {
            Some(
                points
                    .get(point as usize)?
                    .get(pivot)?
                    .load(Ordering::Relaxed),
            )
        };
        at(&self.0.volts).map_or(0.0, |units| f32::from(units) * VOLTS_PER_UNIT)
    }

    /// Leaves a correction, V.
    #[inline]
    pub(super) fn set_correction(&self, point: u32, pivot: usize, volts: f32) {
        if let Some(place) =
            (self.0.corrections.get(point as usize)).and_then(|point| point.get(pivot))
        {
            // What does not fit is as much as fits.
            place.store((volts * (1.0 / VOLTS_PER_UNIT)) as i16, Ordering::Relaxed);
        }
    }

    /// Points that have been followed, and the sum of the errors' squares over them.
    #[inline]
    pub(super) fn set_recorded(&self, points: u32, square_sum: f32) {
        self.0
            .square_sum
            .store(square_sum.to_bits(), Ordering::Relaxed);
        self.0.recorded.store(points, Ordering::Release);
    }

    /// It is over: the command side's turn.
    pub(super) fn close(&self) {
        self.0.state.store(DONE, Ordering::Release);
    }
}

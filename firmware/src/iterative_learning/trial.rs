//! The tick's part: follows a table and keeps what the feedback had to add.

use super::memory::TrialTable;

/// 2^-32 turns of an encoder count.
const COUNTS_PER_UNIT: f32 = 1.0 / 64.0;

/// Ticks of its plan after which a trial starts: not in the one that takes the plan, which is the longest as it is.
const STARTS_AFTER: u64 = 2;

/// The voltage behind a pivot's motion: `volt_s2 e'' + volt_s e'`, e in 2^-32 turns, so many ticks later.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InversePlant {
    /// Of the second derivative, V s^2.
    pub volt_s2: f32,
    /// Of the first, V s.
    pub volt_s: f32,
    /// Ticks until a voltage moves something.
    pub lead_ticks: f32,
}

/// What the servo of a pivot has done in a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ServoStep {
    /// Following error, 2^-32 turns.
    pub error: i32,
    /// Volts that the feedback asked for.
    pub feedback: f32,
    /// What of them is the integral.
    pub integral: f32,
}

/// A trial, as the tick follows it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trial {
    /// The plan that is followed.
    plan: Option<u32>,
    holds_model: bool,
    points: u32,
    /// Ticks from a point to where the next one begins, and half of them.
    spacing_ticks: u32,
    /// Points a tick, and a second.
    per_tick: f32,
    point_hz: f32,
    square_sum: f32,
    pivots: [PivotTrial; 3],
}

/// Of one pivot. What is due at a point is due a tick later for each pivot, so that no tick has to do with two of them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct PivotTrial {
    volts: f32,
    slope: f32,
    point: u32,
    /// Ticks until the middle of the point, where its volts are reached, and until its end.
    to_middle: u32,
    to_end: u32,
    feedback_sum: f32,
    error_sum: f32,
    square_sum: f32,
    /// The integral when the trial started.
    offset: Option<f32>,
    /// Means of the last points, the latest first.
    feedbacks: [f32; 3],
    errors: [f32; 4],
}

impl Trial {
    /// Whether one is under way.
    #[inline]
    pub fn is_under_way(&self) -> bool {
        self.plan.is_some()
    }

    /// Whether the servos are to learn nothing of their own.
    #[inline]
    pub fn holds_model(&self) -> bool {
        self.holds_model
    }

    /// Volts for a pivot in this tick.
    #[inline]
    pub fn volts(&self, pivot: usize) -> f32 {
        (self.pivots.get(pivot)).map_or(0.0, |pivot| pivot.volts)
    }

    /// Goes a tick on with a motion, `done` ticks of whose plan are done; or, without one, ends. What is left over of the voltages when a
    /// trial ends: the integrals' from now on.
    #[inline]
    pub fn advance(
        &mut self,
        table: TrialTable<'_>,
        tick_hz: f32,
        motion: Option<(u32, u64)>,
    ) -> Option<[f32; 3]> {
        let open = table.open_for();
        self.holds_model = table.holds_model();
        if self.plan.is_none() && open.is_none() {
            return None;
        }
        self.advance_open(table, tick_hz, motion, open)
    }

    #[inline(never)]
    fn advance_open(
        &mut self,
        table: TrialTable<'_>,
        tick_hz: f32,
        motion: Option<(u32, u64)>,
        open: Option<u32>,
    ) -> Option<[f32; 3]> {
        let left = self.end_if_over(table, motion, open);
        match (self.plan, motion) {
            (None, Some((plan, STARTS_AFTER))) if open == Some(plan) => {
                self.start(table, tick_hz, plan);
            }
            (None, _) => {}
            (Some(_), _) => self.step(table),
        }
        left
    }

    /// Ends at the end of the table, with the servo, and when the command side has closed it or opened another one: that knows which plans
    /// belong to a motion.
    fn end_if_over(
        &mut self,
        table: TrialTable<'_>,
        motion: Option<(u32, u64)>,
        open: Option<u32>,
    ) -> Option<[f32; 3]> {
        self.plan?;
        let is_open = open == self.plan;
        let is_over = self.pivots.iter().all(|pivot| pivot.point >= self.points);
        if is_open && !is_over && motion.is_some() {
            return None;
        }
        if is_open {
            table.close();
        }
        let left = [0, 1, 2].map(|i| self.volts(i));
        *self = Self::default();
        Some(left)
    }

    fn step(&mut self, table: TrialTable<'_>) {
        let (spacing, per_tick) = (self.spacing_ticks, self.per_tick);
        for (i, pivot) in self.pivots.iter_mut().enumerate() {
            pivot.volts += pivot.slope;
            pivot.to_middle -= 1;
            if pivot.to_middle == 0 {
                pivot.to_middle = spacing;
                let [now, next] = [0, 1].map(|ahead| table.volts(pivot.point + ahead, i));
                pivot.volts = now;
                // The last one stays.
                pivot.slope = if pivot.point + 1 < self.points {
                    (next - now) * per_tick
                } else {
                    0.0
                };
            }
        }
    }

    fn start(&mut self, table: TrialTable<'_>, tick_hz: f32, plan: u32) {
        let (points, spacing_ticks) = table.size();
        if points == 0 || spacing_ticks < 2 {
            return;
        }
        let per_tick = 1.0 / spacing_ticks as f32;
        // The pivots are as the last trial's end has left them.
        self.plan = Some(plan);
        self.points = points;
        self.spacing_ticks = spacing_ticks;
        self.per_tick = per_tick;
        self.point_hz = tick_hz * per_tick;
        for (i, pivot) in self.pivots.iter_mut().enumerate() {
            pivot.to_middle = spacing_ticks / 2 + i as u32;
            pivot.to_end = spacing_ticks + i as u32;
            pivot.slope = table.volts(0, i) / pivot.to_middle as f32;
        }
    }

    /// Takes what the servos have done in this tick.
    #[inline(never)]
    pub fn record(
        &mut self,
        table: TrialTable<'_>,
        inverse: &[InversePlant; 3],
        steps: &[ServoStep; 3],
    ) {
        for (i, (pivot, step)) in self.pivots.iter_mut().zip(steps).enumerate() {
            if pivot.offset.is_none() {
                pivot.offset = Some(step.integral);
                pivot.errors = [step.error as f32; 4];
            }
            // Beyond the integral at the start: what holds the stage at rest is none of the motion's.
            pivot.feedback_sum += step.feedback - pivot.offset.unwrap_or(step.integral);
            let error = step.error as f32;
            pivot.error_sum += error;
            pivot.square_sum += error * error;
            pivot.to_end -= 1;
            if pivot.to_end > 0 {
                continue;
            }
            pivot.to_end = self.spacing_ticks;
            // The first point has the ticks by which a pivot is later, too; the setpoint hardly moves in them.
            let sums = [pivot.feedback_sum, pivot.error_sum, pivot.square_sum];
            let [feedback, error, square] = sums.map(|sum| sum * self.per_tick);
            (pivot.feedback_sum, pivot.error_sum, pivot.square_sum) = (0.0, 0.0, 0.0);
            let [f0, f1, _] = pivot.feedbacks;
            let [e0, e1, e2, _] = pivot.errors;
            pivot.feedbacks = [feedback, f0, f1];
            pivot.errors = [error, e0, e1, e2];
            if pivot.point < self.points {
                // Of the ticks, not of their mean: what oscillates faster than the points are apart grows too.
                self.square_sum += square * (COUNTS_PER_UNIT * COUNTS_PER_UNIT);
            }
            let correction = pivot.correction(&inverse[i], self.per_tick, self.point_hz);
            // Two points later, since it looks as far ahead. The last two look at nothing.
            if let Some(point) = pivot.point.checked_sub(2) {
                table.set_correction(point, i, correction);
            }
            pivot.point += 1;
            if i == 2 {
                table.set_recorded(pivot.point, self.square_sum);
            }
        }
    }
}

impl PivotTrial {
    /// What had to be added at the point before the last: by feedback, less what it did not hold.
    #[inline]
    fn correction(&self, inverse: &InversePlant, per_tick: f32, point_hz: f32) -> f32 {
        let [e0, e1, e2, e3] = self.errors;
        let later = inverse.lead_ticks * per_tick;
        let later = if later > 1.0 { 1.0 } else { later };
        let between = |now: f32, next: f32| now + later * (next - now);
        let first = between(0.5 * (e1 - e3), 0.5 * (e0 - e2));
        let second = between(e1 - 2.0 * e2 + e3, e0 - 2.0 * e1 + e2);
        let missing = point_hz * (inverse.volt_s * first + point_hz * (inverse.volt_s2 * second));
        self.feedbacks[2] - missing
    }
}

//! Following a plan tick by tick, and taking the next one.

use super::axis_state::{AxisState, TickIncrement};
use super::fault_stop::{FaultStop, TimeScaling};
use super::setpoint::{ACCELERATION_CUT, RotationCentre, Setpoint, SetpointScale, VELOCITY_CUT};
use super::slots::{FIRST_KEPT, PlanHandle, PlanReceiver};
use super::{PlanStart, Position, same};

/// The motion of the setpoint: at rest, or following a plan.
///
/// A plan is 1,100 bytes: it stays in the [slot](super::slots) where it was written, and each piece is read when its time comes.
#[derive(Clone, Debug)]
pub struct PlanFollower {
    axes: [AxisState; 3],
    /// The point that is moved.
    centre: RotationCentre,
    /// The plan under way, or the last one, and the other: the next, or the one before.
    plans: [KeptPlan; 2],
    /// Which of them is under way, or was last.
    current: usize,
    moving: bool,
    /// Tick of the plan under way at which the plan in the other slot takes over, if there is one.
    splice: Option<u64>,
    piece: usize,
    /// Ticks of the piece that are left, and what drives the axes in it.
    left: u64,
    increments: [TickIncrement; 3],
    done: u64,
    time_scaling: TimeScaling,
}

/// What is kept of a plan whose pieces lie in a slot.
#[derive(Clone, Copy, Debug, Default)]
struct KeptPlan {
    id: u32,
    nudge: [i64; 3],
    end: Position,
    pieces: u8,
    slot: u8,
}

/// A plan does not start where the motion is (any more); nothing has changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stale;

impl Default for PlanFollower {
    /// At rest at the origin.
    fn default() -> Self {
        let plans = FIRST_KEPT.map(|slot| KeptPlan {
            slot,
            ..KeptPlan::default()
        });
        Self {
            axes: Default::default(),
            centre: RotationCentre::default(),
            plans,
            current: 0,
            moving: false,
            splice: None,
            piece: 0,
            left: 0,
            increments: Default::default(),
            done: 0,
            time_scaling: TimeScaling::default(),
        }
    }
}

impl PlanFollower {
    /// Sets the setpoint to `position`, at rest. Only for a stage that is not held: the setpoint may jump.
    pub fn rest_at(&mut self, position: Position) {
        self.axes = position.map(AxisState::at_rest);
        self.moving = false;
        self.splice = None;
        self.done = 0;
    }

    /// The point of the platform that is moved.
    #[inline]
    pub fn centre(&self) -> RotationCentre {
        self.centre
    }

    /// Moves another point of the platform from now on. Only at rest: the setpoint is then where that point is, and the
    /// platform stays where it is to the unit.
    pub fn set_centre(&mut self, centre: RotationCentre) -> Result<(), Stale> {
        if self.moving {
            return Err(Stale);
        }
        let platform = self.centre.to_platform(&self.position());
        self.centre = centre;
        self.rest_at(centre.from_platform(&platform));
        Ok(())
    }

    /// Whether a plan is under way.
    #[inline]
    pub fn is_moving(&self) -> bool {
        self.moving
    }

    /// Identity of the plan under way or last ended, and its ticks done.
    #[inline]
    pub fn progress(&self) -> (u32, u64) {
        (self.plans[self.current & 1].id, self.done)
    }

    /// Takes a plan: from rest it starts with the next [`advance`](Self::advance), a splice when its tick comes.
    /// The slot that it displaces goes back. Of a plan that is refused its own has to, which is the caller's to do.
    pub fn accept(&mut self, plan: &PlanHandle, plans: PlanReceiver<'_>) -> Result<(), Stale> {
        match plan.start {
            PlanStart::Rest(from) if !self.moving && same(&from, &self.position()) => {
                self.keep(plan, plans);
                self.begin(plans);
            }
            PlanStart::Splice { plan: id, tick }
                if self.moving && self.progress().0 == id && tick >= self.done =>
            {
                self.keep(plan, plans);
                self.splice = Some(tick);
            }
            _ => return Err(Stale),
        }
        Ok(())
    }

    /// One tick on. Bounded: at most one change of piece or plan.
    #[inline]
    pub fn advance(&mut self, plans: PlanReceiver<'_>) {
        if !self.moving {
            return;
        }
        if self.splice == Some(self.done) {
            self.begin(plans);
        }
        // None are left where a plan has no pieces.
        if self.left > 0 {
            for (axis, increment) in self.axes.iter_mut().zip(&self.increments) {
                axis.advance(increment);
            }
            self.done += 1;
            self.left -= 1;
        }
        if self.left == 0 {
            self.piece += 1;
            self.enter(plans);
            if self.left == 0 {
                self.finish();
            }
        }
    }

    /// Enters a piece, if there is one.
    fn enter(&mut self, plans: PlanReceiver<'_>) {
        let plan = &self.plans[self.current & 1];
        let is_over = self.piece >= usize::from(plan.pieces);
        let Some(piece) = plans.piece(plan.slot, self.piece).filter(|_| !is_over) else {
            return;
        };
        self.left = piece.ticks;
        self.increments = each!(i => TickIncrement::new(piece.jerk[i], plan.nudge[i]));
    }

    /// The setpoint now.
    #[inline]
    pub fn setpoint(&self, scale: &SetpointScale) -> Setpoint {
        let axes = &self.axes;
        let velocity =
            each!(i => (axes[i].velocity >> VELOCITY_CUT) as i32 as f32 * scale.velocity[i / 2]);
        let acceleration = each!(i => (axes[i].acceleration >> ACCELERATION_CUT) as i32 as f32 * scale.acceleration[i / 2]);
        Setpoint::new(self.position(), velocity, acceleration)
    }

    /// A fault's stop begins at the setpoint of this tick.
    pub fn begin_fault_stop(&mut self) {
        self.time_scaling = TimeScaling::begun();
    }

    /// One tick on, in a fault's stop. Bounded as [`advance`](Self::advance) is, which it calls at most once.
    pub fn advance_fault_stop(&mut self, fault_stop: &FaultStop, plans: PlanReceiver<'_>) {
        if !self.moving {
            return;
        }
        match self.time_scaling.advance(fault_stop) {
            Some(true) => self.advance(plans),
            Some(false) => {}
            None => self.rest_at(self.time_scaling.position(&self.axes)),
        }
    }

    /// The setpoint now, in a fault's stop.
    pub fn fault_stop_setpoint(&self, scale: &SetpointScale) -> Setpoint {
        let plan = self.setpoint(scale);
        if !self.moving {
            return plan;
        }
        self.time_scaling.setpoint(&plan, &self.axes, scale.rate_hz)
    }

    /// The pose now.
    #[inline]
    pub fn position(&self) -> Position {
        each!(i => self.axes[i].rounded())
    }

    /// Keeps a plan in the place of the one that is not under way.
    fn keep(&mut self, plan: &PlanHandle, plans: PlanReceiver<'_>) {
        let other = &mut self.plans[(self.current + 1) & 1];
        plans.give_back(other.slot);
        *other = KeptPlan {
            id: plan.id,
            nudge: plan.nudge,
            end: plan.end,
            pieces: plan.pieces,
            slot: plan.slot,
        };
    }

    /// Starts the plan that is not under way.
    fn begin(&mut self, plans: PlanReceiver<'_>) {
        self.current = (self.current + 1) & 1;
        self.moving = true;
        self.splice = None;
        self.piece = 0;
        self.left = 0;
        self.done = 0;
        self.enter(plans);
    }

    /// What rounding left of velocity, acceleration and sub-units (see [`Plan::nudge`]) is dropped here.
    fn finish(&mut self) {
        self.axes = self.plans[self.current & 1].end.map(AxisState::at_rest);
        self.moving = false;
        self.splice = None;
    }
}

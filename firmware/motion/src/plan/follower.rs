//! Following a plan tick by tick, and taking the next one.

use super::axis_state::{AxisState, TickIncrement};
use super::fault_stop::{FaultStop, TimeScaling};
use super::setpoint::{ACCELERATION_CUT, RotationCentre, Setpoint, SetpointScale, VELOCITY_CUT};
use super::{Pieces, Plan, PlanStart, Position, same};

/// The motion of the setpoint: at rest, or following a plan.
///
/// A plan is 1,100 bytes, so it is copied once, into the slot that is free; to begin it is to change the slot's number.
#[derive(Clone, Debug, Default)]
pub struct PlanFollower {
    axes: [AxisState; 3],
    /// The point that is moved.
    centre: RotationCentre,
    slots: [Plan; 2],
    /// Slot of the plan under way, or of the last one.
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

/// A plan does not start where the motion is (any more); nothing has changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stale;

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
        (self.slots[self.current & 1].id, self.done)
    }

    /// Takes a plan: from rest it starts with the next [`advance`](Self::advance), a splice when its tick comes.
    pub fn accept(&mut self, plan: &Plan) -> Result<(), Stale> {
        match plan.start {
            PlanStart::Rest(from) if !self.moving && same(&from, &self.position()) => {
                self.keep(plan);
                self.begin();
            }
            PlanStart::Splice { plan: id, tick }
                if self.moving && self.progress().0 == id && tick >= self.done =>
            {
                self.keep(plan);
                self.splice = Some(tick);
            }
            _ => return Err(Stale),
        }
        Ok(())
    }

    /// One tick on. Bounded: at most one change of piece or plan.
    #[inline]
    pub fn advance(&mut self) {
        if !self.moving {
            return;
        }
        if self.splice == Some(self.done) {
            self.begin();
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
            self.enter();
            if self.left == 0 {
                self.finish();
            }
        }
    }

    /// Enters a piece, if there is one.
    fn enter(&mut self) {
        let plan = &self.slots[self.current & 1];
        let Some(piece) = plan.pieces.get(self.piece) else {
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
    pub fn advance_fault_stop(&mut self, fault_stop: &FaultStop) {
        if !self.moving {
            return;
        }
        match self.time_scaling.advance(fault_stop) {
            Some(true) => self.advance(),
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

    /// Copies a plan into the free slot.
    fn keep(&mut self, plan: &Plan) {
        let slot = &mut self.slots[(self.current + 1) & 1];
        slot.id = plan.id;
        slot.nudge = plan.nudge;
        slot.end = plan.end;
        copy(&plan.pieces, &mut slot.pieces);
    }

    /// Starts the plan in the other slot.
    fn begin(&mut self) {
        self.current = (self.current + 1) & 1;
        self.moving = true;
        self.splice = None;
        self.piece = 0;
        self.left = 0;
        self.done = 0;
        self.enter();
    }

    /// What rounding left of velocity, acceleration and sub-units (see [`Plan::nudge`]) is dropped here.
    fn finish(&mut self) {
        self.axes = self.slots[self.current & 1].end.map(AxisState::at_rest);
        self.moving = false;
        self.splice = None;
    }
}

/// In a function of its own, which the image's linker finds.
#[inline(never)]
fn copy(pieces: &Pieces, slot: &mut Pieces) {
    slot.clear();
    // As long as it is.
    let _ = slot.extend_from_slice(pieces);
}

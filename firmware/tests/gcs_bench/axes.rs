//! The axes of the setpoint to the bit, with their velocities and accelerations, which the follower does not tell: the
//! same plans are followed a second time beside it.

#![allow(dead_code)] // Each test file uses its part.

use firmware::motion::plan::axis_state::TickIncrement;
use firmware::motion::{AxisState, Plan, PlanFollower, PlanStart};

/// A plan, and the axes at its first tick.
#[derive(Clone, Debug)]
pub struct Course {
    pub plan: Plan,
    pub start: [AxisState; 3],
}

#[derive(Default)]
pub struct Axes {
    now: [AxisState; 3],
    under_way: Option<Course>,
    /// Accepted, to begin at a tick to come.
    next: Option<Course>,
}

impl Axes {
    pub fn now(&self) -> &[AxisState; 3] {
        &self.now
    }

    /// A plan that the follower has accepted.
    pub fn accept(&mut self, plan: Plan) -> &Course {
        let start = match (&plan.start, &self.under_way) {
            (PlanStart::Splice { tick, .. }, Some(left)) => {
                left.plan.state_after(&left.start, *tick)
            }
            _ => self.now,
        };
        self.next.insert(Course { plan, start })
    }

    /// Goes on to where the follower is, a tick further.
    pub fn follow(&mut self, motion: &PlanFollower) {
        let (id, done) = motion.progress();
        if let Some(course) = self.next.take_if(|next| next.plan.id == id) {
            self.now = course.start;
            self.under_way = Some(course);
        }
        if !motion.is_moving() {
            self.now = motion.position().map(AxisState::at_rest);
            self.under_way = None;
            return;
        }
        let course = self.under_way.as_ref().expect("an accepted plan");
        advance(&mut self.now, &course.plan, done - 1);
        assert_eq!(self.now.map(|axis| axis.rounded()), motion.position());
    }
}

/// Takes the axes through a tick of a plan.
fn advance(axes: &mut [AxisState; 3], plan: &Plan, tick: u64) {
    let mut ends = plan.pieces.iter().scan(0, |end, piece| {
        *end += piece.ticks;
        Some((*end, piece))
    });
    let (_, piece) = ends.find(|(end, _)| tick < *end).expect("a piece");
    for (i, axis) in axes.iter_mut().enumerate() {
        axis.advance(&TickIncrement::new(piece.jerk[i], plan.nudge[i]));
    }
}

//! What has been tried of a new target in motion, and what is tried next.

use super::choice::Choice;
use super::heading::Plane;
use super::slower::Slower;
use crate::motion::check::Violation;
use crate::motion::constraints::Constraints;
use crate::motion::plan::Position;
use crate::motion::plan::axis_state::AxisState;
use crate::motion::plan::units::TickLimits;
use crate::motion::refusal::RetargetError;

/// What has been tried of a transition, so that the next try is as much slower as the last one asked for. The next may
/// leave the motion at another tick, or leave what has taken its place: as a rule a stop that has just begun.
#[derive(Clone, Copy, Debug)]
pub struct Tries {
    slower: Slower,
    /// What was chosen first: it serves for what differs little.
    ratio: Option<f32>,
    left: usize,
}

impl Tries {
    /// Nothing yet.
    pub const NONE: Self = Self {
        slower: Slower::NOT,
        ratio: None,
        left: 3,
    };
}

impl Tries {
    /// What is tried next.
    pub(super) fn choice(
        &mut self,
        state: &[AxisState; 3],
        to: &Position,
        limits: &TickLimits,
        constraints: &Constraints,
    ) -> Option<Choice> {
        let plane = Plane::new(state, to);
        let first = self.ratio.is_none();
        let mut choice = Choice::new(state, to, &plane, limits, &self.slower, self.ratio)?;
        if first && self.slower.expect(state, to, &choice, constraints) {
            choice = Choice::new(state, to, &plane, limits, &self.slower, Some(choice.ratio))?;
        }
        self.ratio = Some(choice.ratio);
        choice
            .is_sooner_than_a_stop(state, to, limits, &self.slower)
            .then_some(choice)
    }

    /// After a try that broke something.
    pub(crate) fn after(&mut self, broken: &Violation) -> RetargetError {
        self.slower.by(broken);
        self.left = self.left.saturating_sub(1);
        if self.left > 0 && *broken != Violation::Workspace {
            RetargetError::TooFast
        } else {
            RetargetError::NeedsStop
        }
    }
}

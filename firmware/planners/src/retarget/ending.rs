//! How the motion under way comes to rest.

use super::overlap::{Corner, Corners};
use motion::check::is_over;
use motion::constraints::{Constraints, MotionLimits, Speeds};
use motion::plan::axis_state::AxisState;
use motion::plan::cubic_segment::{CubicSegment, MotionState};
use motion::plan::quantise::write_velocity_pieces;
use motion::plan::{Pieces, Plan, Position, pieces_after, push_piece, state_after_pieces};
use motion::profile::velocity::VelocityProfile;
use number::float::ticks_to_f32;

/// How the motion under way comes to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Ending {
    /// As it is planned.
    Followed,
    /// By a stop with these shares of the limits.
    Stop { acceleration: f32, jerk: f32 },
}

/// What is left, and when.
pub(super) struct Leaving<'a> {
    of: &'a Plan,
    at: u64,
    to: Position,
    /// The axes where it is left.
    pub state: [AxisState; 3],
    pub now: MotionState,
    pub limits: MotionLimits,
    pub hz: f32,
}

/// An ending: its pieces, its corners, and how long it takes.
#[derive(Default)]
pub(super) struct Ended {
    /// What these are of.
    of: Option<Ending>,
    pub pieces: Pieces,
    pub corners: Corners,
    pub ticks: u64,
    /// Where it comes to rest, and the way from there to the target, track radii and rad.
    pub rest: Position,
    pub left: [f32; 3],
}

impl<'a> Leaving<'a> {
    pub fn new(
        of: &'a Plan,
        from: &'a [AxisState; 3],
        at: u64,
        to: Position,
        constraints: &Constraints,
    ) -> Self {
        let state = of.state_after(from, at);
        let hz = constraints.limits.rate_hz as f32;
        Self {
            of,
            at,
            to,
            state,
            now: MotionState::new(&state, hz),
            limits: constraints.motion_limits(),
            hz,
        }
    }

    /// Whether the motion is over the limits: in an urgent stop, or since a limit has been lowered.
    pub fn is_outside(&self) -> bool {
        is_over(Speeds::of(&self.now.a), self.limits.acceleration)
            || is_over(Speeds::of(&self.now.v), self.limits.speed)
    }

    /// Whether an ending is over the limits by itself: a stop at an edge, or the end of a stream.
    pub fn is_over(&self, ended: &Ended) -> bool {
        (ended.corners.iter()).any(|corner| {
            is_over(Speeds::of(&corner.a), self.limits.acceleration)
                || is_over(Speeds::of(&corner.j), self.limits.jerk)
        })
    }

    /// Writes an ending; `None` where there is none.
    #[inline(never)]
    pub fn write(&self, ending: Ending, ended: &mut Ended) -> Option<()> {
        if ended.of == Some(ending) {
            return Some(());
        }
        ended.of = None;
        let (pieces, corners) = (&mut ended.pieces, &mut ended.corners);
        pieces.clear();
        match ending {
            Ending::Followed => pieces_after(&self.of.pieces, self.at)
                .try_for_each(|piece| push_piece(pieces, piece))?,
            Ending::Stop { acceleration, jerk } => {
                let limits = self.limits.scaled(acceleration, jerk);
                let profile = VelocityProfile::new(&self.now, &[0.0; 3], &limits);
                let ticks = profile.ticks(self.hz);
                write_velocity_pieces(pieces, &self.state, &[0; 3], ticks);
            }
        }
        let mut now = Corner {
            v: self.now.v,
            a: self.now.a,
            ..Corner::default()
        };
        corners.clear();
        ended.ticks = 0;
        for piece in &*pieces {
            now.j = CubicSegment::jerk(piece, self.hz);
            // There is room for all.
            let _ = corners.push(now);
            ended.ticks += piece.ticks;
            now = now.at(ticks_to_f32(ended.ticks) / self.hz);
        }
        let _ = corners.push(now);
        ended.rest = match ending {
            // The nudge of the motion that is left is not in the pieces.
            Ending::Followed => each!(i => {
                AxisState::at_rest(self.of.end[i]).rest_position(ended.ticks, -self.of.nudge[i])
            }),
            Ending::Stop { .. } => {
                state_after_pieces(&self.state, pieces, &[0; 3]).map(|axis| axis.rounded())
            }
        };
        // In whole numbers: of a long way a float does not hold a small correction.
        ended.left = each!(i => MotionState::way(i, self.to[i].wrapping_sub(ended.rest[i])));
        ended.of = Some(ending);
        Some(())
    }
}

//! How the motion under way comes to rest.

use super::corner::{Corner, Corners};
use crate::motion::check::is_over;
use crate::motion::constraints::Constraints;
use crate::motion::plan::axis_state::AxisState;
use crate::motion::plan::cubic_segment::{CubicSegment, MotionState};
use crate::motion::plan::quantise::velocity_pieces;
use crate::motion::plan::{Piece, Pieces, Plan, Position, pieces_after, push_piece};
use crate::motion::profile::velocity::{
    AccelerationLimits, VelocityProfile, stop_displacements, stop_peak,
};
use crate::motion::speeds::Speeds;
use crate::number::float::ticks_to_f32;

/// How the motion under way comes to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Ending {
    /// As it is planned.
    Followed,
    /// By a stop with this share of the limits of acceleration, and of jerk.
    Stop(f32, f32),
}

/// What is left, and when.
pub(super) struct Leaving<'a> {
    of: &'a Plan,
    at: u64,
    to: Position,
    /// The axes where it is left.
    pub state: [AxisState; 3],
    pub now: MotionState,
    pub speed: Speeds,
    pub limits: AccelerationLimits,
    pub hz: f32,
}

/// An ending in floats, how long it takes and how far it leads.
#[derive(Default)]
pub(super) struct Ended {
    pub pieces: Pieces<f32>,
    pub corners: Corners,
    pub ticks: u64,
    /// The way from its end to the target, track radii and rad.
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
        let limits = &constraints.limits;
        let hz = limits.rate_hz as f32;
        Self {
            of,
            at,
            to,
            state,
            now: MotionState::new(&state, hz),
            speed: constraints.speeds(limits.speed_mm_s, limits.turn_speed_deg_s),
            limits: AccelerationLimits::new(constraints),
            hz,
        }
    }

    /// Whether the motion is over the limits: in an urgent stop, or since a limit has been lowered.
    pub fn is_outside(&self) -> bool {
        is_over(Speeds::of(&self.now.a), self.limits.acceleration)
            || is_over(Speeds::of(&self.now.v), self.speed)
    }

    /// Whether an ending is over the limits by itself: a stop at an edge, or the end of a stream.
    pub fn is_over(&self, ended: &Ended) -> bool {
        let AccelerationLimits { acceleration, jerk } = self.limits;
        (ended.corners.iter()).any(|corner| {
            is_over(Speeds::of(&corner.a), acceleration) || is_over(Speeds::of(&corner.j), jerk)
        })
    }

    /// Writes an ending; `None` where there is none.
    pub fn write_ended(&self, ending: Ending, ended: &mut Ended) -> Option<()> {
        ended.pieces.clear();
        match ending {
            Ending::Followed => {
                // In whole numbers: of a long way a float does not hold a small correction.
                let rest = self.of.end.map(AxisState::at_rest);
                ended.left = MotionState::between(&rest, &self.to);
                for piece in pieces_after(&self.of.pieces, self.at) {
                    let jerk = CubicSegment::jerk(&piece, self.hz);
                    let ticks = piece.ticks;
                    ended.pieces.push(Piece { ticks, jerk }).ok()?;
                }
            }
            Ending::Stop(acceleration, jerk) => {
                let ticks = self.stop(acceleration, jerk).ticks(self.hz);
                let times = ticks.map(|ticks| ticks_to_f32(ticks) / self.hz);
                let [.., displacement] = stop_displacements(&self.now, times);
                let way = MotionState::between(&self.state, &self.to);
                ended.left = [0, 1, 2].map(|i| way[i] - displacement[i]);
                let peak = stop_peak(&self.now, times);
                let first = [0, 1, 2].map(|i| (peak[i] - self.now.a[i]) / times[0]);
                let last = peak.map(|peak| -peak / times[2]);
                for (ticks, jerk) in ticks.into_iter().zip([first, [0.0; 3], last]) {
                    push_piece(&mut ended.pieces, Piece { ticks, jerk })?;
                }
            }
        }
        let mut now = Corner {
            v: self.now.v,
            a: self.now.a,
            ..Corner::default()
        };
        ended.corners.clear();
        ended.ticks = 0;
        for piece in &ended.pieces {
            now.j = piece.jerk;
            // There is room for all.
            let _ = ended.corners.push(now);
            ended.ticks += piece.ticks;
            now = now.next(ticks_to_f32(ended.ticks) / self.hz);
        }
        let _ = ended.corners.push(now);
        Some(())
    }

    fn stop(&self, acceleration: f32, jerk: f32) -> VelocityProfile {
        let limits = self.limits.scaled(acceleration, jerk);
        VelocityProfile::new(&self.now, &[0.0; 3], &limits)
    }

    /// Writes the pieces of an ending.
    pub fn write(&self, ending: Ending, pieces: &mut Pieces) -> Option<()> {
        pieces.clear();
        match ending {
            Ending::Followed => pieces_after(&self.of.pieces, self.at)
                .try_for_each(|piece| push_piece(pieces, piece)),
            Ending::Stop(acceleration, jerk) => {
                let ticks = self.stop(acceleration, jerk).ticks(self.hz);
                let four: [Piece; 4] = velocity_pieces(&self.state, &[0; 3], ticks);
                four.into_iter()
                    .try_for_each(|piece| push_piece(pieces, piece))
            }
        }
    }
}

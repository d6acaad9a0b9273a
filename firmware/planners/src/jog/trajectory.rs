//! A jog: the way to a velocity, the velocity held, and the way to rest.

use super::request::{InitialState, JogRequest};
use heapless::Vec;
use motion::plan::axis_state::AxisState;
use motion::plan::cubic_segment::MotionState;
use motion::plan::quantise::velocity_pieces;
use motion::plan::{Piece, Pieces, Plan, push_piece, state_after_pieces, write_sum};
use motion::profile::velocity::{AccelerationLimits, VelocityProfile};
use motion::refusal::RetargetError;
use motion::speeds::per_second;

/// A jog from the state on in which its velocity is reached.
pub(super) struct Jog {
    /// 2^-72 units a tick.
    pub(super) wanted: [i64; 3],
    /// Where the velocity is reached.
    pub(super) steady: [AxisState; 3],
    /// Ticks of the change of velocity.
    pub(super) ramp: u64,
    /// Ticks that bring the velocity back to zero.
    pub(super) brake: [u64; 3],
    from_rest: bool,
    pub(super) acceleration_limits: AccelerationLimits,
    pub(super) radius: f32,
}

/// A velocity held, and the three pieces and the tick that end it.
type HoldThenStop = Vec<Piece, 5>;

impl Jog {
    /// Writes the pieces of the way there, too.
    pub(super) fn new(
        state: &[AxisState; 3],
        now: &InitialState,
        wanted: [i64; 3],
        request: &JogRequest,
        pieces: &mut Pieces,
    ) -> Result<Self, RetargetError> {
        let hz = request.hz;
        let target = per_second(&wanted, hz);
        let (radius, limits) = request.limits_towards(now, &target)?;
        let ramp = VelocityProfile::new(&now.motion, &target, &limits).ticks(hz);
        let from_rest = now.motion.is_at_rest();
        pieces.clear();
        for piece in velocity_pieces(state, &wanted, ramp) {
            // Four of many.
            let _ = push_piece(pieces, piece);
        }
        Ok(Self {
            wanted,
            steady: state_after_pieces(state, pieces, &[0; 3]),
            ramp: pieces.iter().map(|piece| piece.ticks).sum(),
            brake: if from_rest {
                ramp
            } else {
                change(&target, &limits).ticks(hz)
            },
            from_rest,
            acceleration_limits: limits,
            radius,
        })
    }

    /// Adds pieces for the velocities held for `hold` ticks and given up, the point's and theta's for themselves.
    pub(super) fn finish(&self, plan: &mut Plan, [point, _, turn]: [u64; 3]) {
        // What rounding leaves of a velocity is not given up: the nudge takes it.
        let moves = self.wanted.map(|velocity| velocity != 0);
        let translating = self.hold_then_stop(&plan.pieces, [moves[0], moves[1], false], point);
        let turning = self.hold_then_stop(&plan.pieces, [false, false, moves[2]], turn);
        let mut way: Vec<Piece, { 4 + 5 }> = Vec::new();
        // Four, and five.
        let _ = way.extend_from_slice(&plan.pieces);
        let _ = way.extend_from_slice(&translating);
        // Twice five, and four.
        let _ = write_sum(&way, &turning, self.ramp, &mut plan.pieces);
        let ticks = plan.ticks();
        for (i, pieces) in [&translating, &translating, &turning]
            .into_iter()
            .enumerate()
        {
            let rest = self.rest(i, pieces, ticks - self.ramp);
            plan.nudge[i] = -rest.velocity;
            plan.end[i] = rest.rest_position(ticks, -rest.velocity);
        }
    }

    /// Where an axis is `ticks` after its velocity is reached: at rest, but for what rounding leaves of the velocity.
    #[inline(never)]
    fn rest(&self, i: usize, pieces: &[Piece], mut ticks: u64) -> AxisState {
        let mut axis = self.steady[i];
        if self.wanted[i] != 0 {
            for piece in pieces {
                axis = axis.after(piece.ticks, piece.jerk[i], 0);
                ticks -= piece.ticks;
            }
        }
        axis.after(ticks, 0, 0)
    }

    /// Of the axes that `are_meant`, after the pieces of the way there.
    fn hold_then_stop(&self, ramp: &[Piece], are_meant: [bool; 3], hold: u64) -> HoldThenStop {
        let mut pieces = HoldThenStop::new();
        if are_meant == [false; 3] {
            return pieces;
        }
        // Five of five.
        let _ = pieces.push(Piece {
            ticks: hold,
            jerk: [0; 3],
        });
        if self.from_rest {
            // The way there takes back just what it gave.
            for piece in ramp {
                let jerk = each!(i => if are_meant[i] { -piece.jerk[i] } else { 0 });
                let _ = pieces.push(Piece { jerk, ..*piece });
            }
        } else {
            let still = AxisState::default();
            let axes = each!(i => if are_meant[i] { self.steady[i] } else { still });
            let _ = pieces.extend_from_slice(&velocity_pieces(&axes, &[0; 3], self.brake));
        }
        pieces
    }
}

/// The change of velocity by `velocity`, to it or back.
pub(super) fn change(velocity: &[f32; 3], limits: &AccelerationLimits) -> VelocityProfile {
    VelocityProfile::new(&MotionState::default(), velocity, limits)
}

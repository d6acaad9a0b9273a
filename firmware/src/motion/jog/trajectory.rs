//! A jog: the way to a velocity, the velocity held, and the way to rest.

use super::hold_then_stop::HoldThenStop;
use super::request::{InitialState, JogRequest};
use crate::motion::brake::velocity_change::{
    AccelerationLimits, VelocityRamp, release_acceleration,
};
use crate::motion::plan::axis_state::AxisState;
use crate::motion::plan::{Piece, Pieces, Plan, state_after_pieces};
use crate::motion::refusal::RetargetError;
use crate::motion::speeds::{Speeds, per_second};

/// A jog from the state on in which its velocity is reached.
pub(super) struct Jog {
    /// 2^-72 units a tick.
    pub(super) wanted: [i64; 3],
    /// Where the velocity is reached.
    pub(super) steady: [AxisState; 3],
    /// Ticks of the change of velocity, release not counted.
    pub(super) ramp: u64,
    /// Brings the velocity back to zero.
    pub(super) brake: VelocityRamp,
    pub(super) acceleration_limits: AccelerationLimits,
    pub(super) radius: f32,
}

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
        let (radius, acceleration_limits) = request.limits_towards(now, &target)?;
        pieces.clear();
        let released = release_acceleration(
            state,
            Speeds::of(&now.acceleration),
            acceleration_limits.jerk,
            hz,
            pieces,
        );
        let change = [0, 1, 2].map(|i| wanted[i] - released[i]);
        let ramp = VelocityRamp::new(
            Speeds::of(&per_second(&change, hz)),
            &acceleration_limits,
            hz,
        );
        for piece in ramp.pieces(change) {
            // Release and ramp are five.
            let _ = pieces.push(piece);
        }
        Ok(Self {
            wanted,
            steady: state_after_pieces(state, pieces, &[0; 3]),
            ramp: ramp.ticks(),
            brake: VelocityRamp::new(Speeds::of(&target), &acceleration_limits, hz),
            acceleration_limits,
            radius,
        })
    }

    /// Adds pieces for the velocities held for `hold` ticks and given up, the point's and theta's for themselves.
    pub(super) fn finish(&self, plan: &mut Plan, [point, _, turn]: [u64; 3]) {
        let begun = plan.pieces.len();
        let change = [0, 1, 2].map(|i| match self.wanted[i] {
            0 => 0,
            _ => -self.steady[i].velocity,
        });
        let brakes = self.brake.pieces(change);
        let mut ends = [
            HoldThenStop::new(change[..2] != [0, 0], point),
            HoldThenStop::new(change[2] != 0, turn),
        ];
        // Whatever begins or ends somewhere begins a piece.
        while let Some(ticks) = ends[0].next_change(&ends[1]) {
            let jerks = [0, 1].map(|i| ends[i].jerk(&brakes));
            if ticks > 0 {
                // Room for the ramp's five and eight for two ends.
                let _ = plan.pieces.push(Piece {
                    ticks,
                    jerk: [jerks[0][0], jerks[0][1], jerks[1][2]],
                });
            }
            for end in &mut ends {
                end.advance(ticks, &brakes);
            }
        }
        let rest = state_after_pieces(&self.steady, &plan.pieces[begun..], &[0; 3]);
        plan.pieces.retain(|piece| piece.ticks > 0);
        // The velocity that rounding leaves an axis is less than one can see, but an axis may stand while another goes
        // on.
        plan.nudge = rest.map(|axis| -axis.velocity);
        let ticks = plan.ticks();
        plan.end = rest.map(|axis| axis.rest_position(ticks, -axis.velocity));
    }
}

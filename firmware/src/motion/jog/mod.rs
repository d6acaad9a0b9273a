//! Jogging: from any state to a constant velocity, held until somebody changes it, or up to the workspace's edge.
//!
//! ```text
//! speed of    ________________________                 The velocity is changed (see `change`), held, and given up in time:
//! the point  /                        \                a plan that ends at rest like any other, exactly where it can stop.
//!          _/                          \______         Theta alone never meets an edge: its plan ends at a thousand million
//! of theta   ______________________________..          turns, 30 years away at a turn a second.
//!          _/
//! ```
//!
//! The edge is that of the disk in which the pivots can follow this velocity at any orientation (see `swing`): the faster
//! the jog, the smaller it may be. Who jogs outwards stops there; who stands outside of it is told that it is too fast.
//! Bounds of the moved point and of theta end a jog in the same way. When the platform turns about a point beside its centre,
//! its centre goes in circles: the point then stays where every orientation is possible, or, where it is not, point and theta
//! stop together before the centre meets the edge.
//!
//! Near an edge there may be no room to reach the velocity and to stop again: from rest a lower one is taken.

mod hold;
mod reach;
mod start;

use self::start::{Setting, State};
use super::axis::Axis;
use super::change::{Force, Pieces, Ramp, release};
use super::envelope::{Envelope, Legs, Looks};
use super::ground::Ground;
use super::plan::{MAX_PIECES, Piece, Plan, Start, after_all};
use super::refusal::Refusal;
use super::swing::{Pace, per_second};
use super::transition::NoTransition;
use super::units::UnitLimits;
use heapless::Vec;

/// Plans the way to `velocity` (mm/s, mm/s and deg/s of x, y and theta), and on with it, from `state`, which is where `start`
/// says. Zero is a velocity as any other: that axis stops smoothly.
///
/// # Errors
/// [`NoTransition::Refused`] when there is no such jog, with the reason; [`NoTransition::NeedsStop`] when there is, but not
/// without a stop before.
#[inline(never)]
pub fn plan_jog(
    id: u32,
    start: Start,
    state: &[Axis; 3],
    velocity: &[f64; 3],
    ground: &Ground,
) -> Result<Plan, NoTransition> {
    let setting = Setting::new(velocity, ground).map_err(NoTransition::Refused)?;
    let now = State::new(state, &setting);
    let from_rest = matches!(start, Start::Rest(_));
    let mut wanted = setting.velocity;
    for _ in 0..ATTEMPTS {
        if from_rest && wanted == [0; 3] && setting.velocity != wanted {
            return Err(NoTransition::Refused(Refusal::NoWay));
        }
        let jog = Jog::new(state, &now, wanted, &setting)?;
        match jog.hold(state, &setting, from_rest) {
            Ok(hold) => {
                // From rest the way there is the first part of the way on, which was looked at for the time that it is held.
                if !from_rest {
                    jog.check(state, ground)?;
                }
                return Ok(jog.finish(id, start, state, hold));
            }
            Err(_) if !from_rest => return Err(NoTransition::NeedsStop),
            Err(short) => wanted = jog.slower(&short, &setting),
        }
    }
    Err(NoTransition::Refused(Refusal::NoWay))
}

/// The point may be too near to an edge, theta to a bound, and once more for what a lower velocity changes.
const ATTEMPTS: usize = 4;

/// A jog up to the state in which its velocity is reached.
struct Jog {
    /// 2^-72 units a tick.
    wanted: [i64; 3],
    pieces: Pieces,
    /// Where the velocity is reached.
    steady: [Axis; 3],
    /// Ticks of the change of velocity, release not counted.
    ramp: u64,
    /// Brings the velocity back to zero.
    brake: Ramp,
    force: Force,
    radius: f32,
}

impl Jog {
    fn new(
        state: &[Axis; 3],
        now: &State,
        wanted: [i64; 3],
        setting: &Setting,
    ) -> Result<Self, NoTransition> {
        let hz = setting.hz;
        let target = per_second(&wanted, hz);
        let (radius, force) = setting.force(now, &target)?;
        let mut pieces = release(state, Pace::of(&now.acceleration), force.jerk, hz);
        let released = after_all(state, &pieces, &[0; 3]);
        let change = [0, 1, 2].map(|i| wanted[i] - released[i].velocity);
        let ramp = Ramp::new(Pace::of(&per_second(&change, hz)), &force, hz);
        for piece in ramp.pieces(change) {
            let _ = pieces.push(piece);
        }
        let steady = after_all(state, &pieces, &[0; 3]);
        Ok(Self {
            wanted,
            steady,
            pieces,
            ramp: ramp.ticks(),
            brake: Ramp::new(Pace::of(&target), &force, hz),
            force,
            radius,
        })
    }

    /// Looks at the way to the velocity as at any other.
    fn check(&self, state: &[Axis; 3], ground: &Ground) -> Result<(), NoTransition> {
        let envelope = Envelope::new(ground, UnitLimits::new(ground), state);
        let mut legs = Legs::new();
        envelope.legs(&self.pieces, state, &mut legs);
        envelope
            .check(&legs, &mut { Looks::ALL })
            .map_err(|_| NoTransition::NeedsStop)
    }

    /// Pieces for the velocities held for `hold` ticks and given up, each axis for itself.
    fn finish(&self, id: u32, start: Start, state: &[Axis; 3], hold: [u64; 3]) -> Plan {
        let mut pieces: Vec<Piece, MAX_PIECES> = self.pieces.iter().copied().collect();
        let brakes = self.brake.pieces(self.steady.map(|axis| -axis.velocity));
        // Theta and the point do the same at different times: whatever begins or ends somewhere begins a piece.
        let mut at = 0;
        while let Some((end, jerk)) = self.next(at, &hold, &brakes) {
            // Room for the ramp's five and eight for two ends.
            let _ = pieces.push(Piece {
                ticks: end - at,
                jerk,
            });
            at = end;
        }
        pieces.retain(|piece| piece.ticks > 0);
        let rest = after_all(state, &pieces, &[0; 3]);
        let ticks = pieces.iter().map(|piece| piece.ticks).sum();
        // The velocity that rounding leaves an axis is less than one can see, but an axis may stand while another goes on.
        let nudge = rest.map(|axis| -axis.velocity);
        Plan {
            id,
            start,
            end: rest.map(|axis| axis.end(ticks, -axis.velocity)),
            pieces,
            nudge,
        }
    }

    /// From `at` on: until when all axes keep their jerks, and these; `None` when all are at rest.
    #[inline(never)]
    fn next(&self, at: u64, hold: &[u64; 3], brakes: &[Piece; 3]) -> Option<(u64, [i64; 3])> {
        let mut jerk = [0; 3];
        let mut until = None;
        for (i, jerk) in jerk.iter_mut().enumerate() {
            if self.wanted[i] == 0 {
                continue;
            }
            let hold = (hold[i], 0);
            let mut end = 0;
            for (ticks, now) in [hold]
                .into_iter()
                .chain(brakes.iter().map(|piece| (piece.ticks, piece.jerk[i])))
            {
                end += ticks;
                if at < end {
                    *jerk = now;
                    until = Some(until.map_or(end, |until: u64| until.min(end)));
                    break;
                }
            }
        }
        until.map(|until| (until, jerk))
    }
}

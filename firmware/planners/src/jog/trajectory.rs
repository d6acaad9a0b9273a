//! A jog: the way to a velocity, the velocity held, and the way to rest; how long it can be held before its axes have to
//! brake, and how much slower it has to be where that is too short.

use super::{InitialState, JogRequest};
use heapless::Vec;
use motion::constraints::MotionLimits;
use motion::plan::axis_state::AxisState;
use motion::plan::cubic_segment::{MotionState, per_second};
use motion::plan::quantise::{velocity_pieces, write_velocity_pieces};
use motion::plan::{Piece, Pieces, Plan, state_after_pieces, write_sum};
use motion::profile::velocity::VelocityProfile;
use motion::refusal::RetargetError;
use number::float::{FloatMinMax, ticks_to_f32, truncate};

/// A jog from the state on in which its velocity is reached.
pub(super) struct Jog {
    /// 2^-72 units a tick.
    wanted: [i64; 3],
    /// Where the velocity is reached.
    steady: [AxisState; 3],
    /// Ticks of the change of velocity.
    ramp: u64,
    /// Ticks that bring the velocity back to zero.
    brake: [u64; 3],
    from_rest: bool,
    limits: MotionLimits,
    radius: f32,
}

/// The four pieces of the way to a velocity, and the five in which it is held and given up.
type JogPieces = Vec<Piece, { 4 + 5 }>;

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
        write_velocity_pieces(pieces, state, &wanted, ramp);
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
            limits,
            radius,
        })
    }

    /// Adds pieces for the velocities held for `hold` ticks and given up, the point's and theta's for themselves.
    pub(super) fn finish(&self, plan: &mut Plan, [point, turn]: [u64; 2]) {
        // What rounding leaves of a velocity is not given up: the nudge takes it.
        let moves = self.wanted.map(|velocity| velocity != 0);
        let (mut way, mut turning) = (JogPieces::new(), JogPieces::new());
        // Four.
        let _ = way.extend_from_slice(&plan.pieces);
        self.hold_then_stop(&plan.pieces, [moves[0], moves[1], false], point, &mut way);
        self.hold_then_stop(&plan.pieces, [false, false, moves[2]], turn, &mut turning);
        let translating = way.get(plan.pieces.len()..).unwrap_or_default();
        // Twice five, and four.
        let _ = write_sum(&way, &turning, self.ramp, &mut plan.pieces);
        let ticks = plan.ticks();
        for (i, pieces) in [translating, translating, &turning].into_iter().enumerate() {
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

    /// Adds the pieces of the axes that `are_meant`, after the pieces of the way there.
    fn hold_then_stop(
        &self,
        ramp: &[Piece],
        are_meant: [bool; 3],
        hold: u64,
        pieces: &mut JogPieces,
    ) {
        if are_meant == [false; 3] {
            return;
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
    }
}

/// The change of velocity by `velocity`, to it or back.
fn change(velocity: &[f32; 3], limits: &MotionLimits) -> VelocityProfile {
    VelocityProfile::new(&MotionState::default(), velocity, limits)
}

/// Some axes would be over after so many seconds at the velocity wanted: too soon to reach it and to stop.
pub(super) struct TooShort {
    seconds: f32,
    point: bool,
    turn: bool,
}

/// Longest that a velocity is held, ticks: two million years.
const LONGEST: f32 = 1_152_921_504_606_846_976.0;

/// A velocity of which less than this share can be reached is none.
const LEAST_SHARE: f32 = 1e-3;

impl Jog {
    /// For how many ticks each axis keeps its velocity before it has to brake.
    pub(super) fn hold(
        &self,
        state: &[AxisState; 3],
        request: &JogRequest,
    ) -> Result<[u64; 2], TooShort> {
        let hz = request.hz;
        let target = per_second(&self.wanted, request.hz);
        // From rest the ramp goes the same way, at half the speed.
        let ramp = ticks_to_f32(self.ramp) / (2.0 * hz);
        let (from, done) = if self.from_rest {
            (state, ramp)
        } else {
            (&self.steady, 0.0)
        };
        let edge = request.steady(from, &target).time_to_edge(self.radius);
        let bounds = request
            .steady(&self.steady, &target)
            .time_to_bounds(&request.constraints.bounds);
        let mut point = (edge.seconds - done).fmin(bounds);
        let mut turn = request.time_to_theta_bound(&self.steady[2], self.wanted[2]);
        if edge.theta_too {
            point = point.fmin(turn);
            turn = point;
        }
        let brake = ticks_to_f32(self.brake.iter().sum()) / (2.0 * hz);
        let is_short = [
            self.wanted[..2] != [0, 0] && point < brake,
            self.wanted[2] != 0 && turn < brake,
        ];
        if is_short != [false; 2] {
            return Err(TooShort {
                seconds: if is_short[0] { point } else { turn } + ramp,
                point: is_short[0],
                turn: is_short[1] && (edge.theta_too || !is_short[0]),
            });
        }
        let ticks = |seconds: f32| truncate(((seconds - brake) * hz).fmin(LONGEST)) as u64;
        Ok([ticks(point), ticks(turn)])
    }

    /// A velocity that can be reached and given up again in what way there is; zero where there is none.
    pub(super) fn slower(&self, short: &TooShort, request: &JogRequest) -> [i64; 3] {
        let slower = |share: f32| {
            let share = (share * 65_536.0) as i64;
            each!(i => {
                let velocity = self.wanted[i];
                let counts = if i < 2 { short.point } else { short.turn };
                if counts {
                    (velocity >> 16) * share
                } else {
                    velocity
                }
            })
        };
        let (mut low, mut high) = (0.0, 1.0);
        // To a thousandth.
        for _ in 0..10 {
            let share = (low + high) / 2.0;
            let velocity = per_second(&slower(share), request.hz);
            let brake = change(&velocity, &self.limits);
            if share * brake.times_s().iter().sum::<f32>() <= short.seconds {
                low = share;
            } else {
                high = share;
            }
        }
        // A little less, for what a slower motion has besides: a larger disk, and in it less acceleration.
        slower(if low < LEAST_SHARE { 0.0 } else { low * 0.95 })
    }
}

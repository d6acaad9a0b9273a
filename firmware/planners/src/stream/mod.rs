//! Targets that arrive one after the other, at a rate below the control rate, as one smooth motion.
//!
//! ```text
//!  sender      o  o   o o  o  o  o         at the sender's clock, with jitter
//!               \  \  | |  |  |  |
//!  queue        [ reserve | window ]       a few targets wait, so that one may be late
//!                            |
//!  curve          ~~~~~~~~~~~              a spline through them (`spline`)
//!                  |   |   |
//!  plans          [k k k|stop]             knots on the curve, three pieces of constant jerk each (`knot`), and a stop
//!                       [k k k|stop]       that the next plan takes the place of (`final_stop`)
//! ```
//!
//! Every plan ends in a stop of its own. A stream that dries up comes to rest by itself, with nobody's help, within the
//! limits and the workspace; so does one whose next target asks for too much, which is refused.
//!
//! Position, velocity and acceleration of the setpoint have no steps, as in any plan. What the targets ask for is held
//! against the limits of speed, acceleration and the pivots at every piece's end, with a tolerance of a thousandth.
//! Jerk is the sender's own business within [`JERK_TOLERANCE`](motion::tolerances::JERK_TOLERANCE) times its limit: samples that are rounded, or a path
//! with corners in its acceleration, have no better.
//!
//! The distance of the samples in time is what the sender says it is, not when they arrive. A sender whose clock
//! differs a little (up to 0.05 %) is followed: the curve is passed as much faster or slower as keeps the reserve.
//!
//! | file | idea |
//! |---|---|
//! | `messages` | what goes between a stream, its sender and the tick |
//! | `state` | the targets that wait, and what has been sent of them |
//! | `sequence` | which plan is sent when; the sender's clock |
//! | `plans` | a plan: knots along the curve, each held against every limit |
//! | `spline` | the curve through the targets |
//! | `knot` | from a state to a given one in three pieces |
//! | `final_stop` | the stop at the end of every plan |

mod final_stop;
mod knot;
mod plans;
mod spline;
mod state;

use motion::constraints::Constraints;
use spline::WINDOW;
use state::{BEFORE, PART_BITS, SentPlan};

pub use state::{
    Clock, PERIOD_RANGE, PlanProgress, PushError, STREAM_CAPACITY, Stream, StreamEnd, StreamStep,
};

/// A clock of the sender's own: how much faster the curve is passed for a target too many, as a share; how much at
/// most; and over how many plans the number of targets is averaged.
const FOLLOWING: f32 = 5e-4;

const MOST_FOLLOWING: f32 = 2e-3;

const AVERAGED: f32 = 32.0;

impl Stream {
    /// What is to be done, `id` being the identity of a plan to come. To be asked whenever there is news of the tick.
    pub fn next(
        &mut self,
        id: u32,
        progress: &PlanProgress,
        constraints: &Constraints,
    ) -> StreamStep {
        if let Some(end) = self.end {
            return StreamStep::Over(end);
        }
        let Some(sent) = self.sent else {
            let waiting = self.targets.len() - BEFORE;
            return if waiting >= self.targets_to_start() || (self.announced && waiting > 0) {
                self.send(id, None, constraints)
            } else if self.announced {
                self.over(StreamEnd::Done)
            } else {
                StreamStep::Wait
            };
        };
        if progress.plan != sent.id {
            // On the plan before. Once that is past its end the last one has come too late.
            let late =
                |before: SentPlan| progress.plan == before.id && progress.tick > before.splice;
            return if self.before.is_some_and(late) {
                self.over(StreamEnd::Starved)
            } else {
                StreamStep::Wait
            };
        }
        if self.complete {
            return if progress.moving {
                StreamStep::Wait
            } else {
                self.over(StreamEnd::Done)
            };
        }
        if progress.tick > sent.splice || !progress.moving {
            return self.over(StreamEnd::Starved);
        }
        self.follow(sent.splice - progress.tick);
        self.send(id, Some(sent), constraints)
    }

    fn over(&mut self, end: StreamEnd) -> StreamStep {
        self.end = Some(end);
        StreamStep::Over(end)
    }

    /// Follows the sender's clock by the number of targets that are left `ticks` before the end of what is planned.
    fn follow(&mut self, ticks: u64) {
        if self.clock == Clock::Own || self.announced {
            return;
        }
        const ONE: f32 = (1_u64 << PART_BITS) as f32;
        let ahead = self.targets.len() as f32
            + (ticks as f32 * self.rate as f32 - self.part as f32) / ONE
            - (BEFORE + self.targets_to_start()) as f32;
        self.surplus += (ahead - self.surplus) / AVERAGED;
        let faster = (self.surplus * FOLLOWING).clamp(-MOST_FOLLOWING, MOST_FOLLOWING);
        // Of a small share single precision is enough.
        let more = (self.nominal as f32 * faster) as i64;
        self.rate = self.nominal.wrapping_add_signed(more);
    }

    /// The next plan, if there are targets enough for it.
    fn send(&mut self, id: u32, sent: Option<SentPlan>, constraints: &Constraints) -> StreamStep {
        let ahead = self.part + u64::from(self.knots) * self.knot.whole() * self.rate;
        let needed = (ahead >> PART_BITS) as usize + WINDOW;
        if self.targets.len() < needed && !self.announced {
            return StreamStep::Wait;
        }
        match self.plan(id, sent, constraints) {
            Ok((plan, start, sent)) => {
                self.before = self.sent.replace(sent);
                StreamStep::Send(plan, start)
            }
            Err(refusal) => self.over(StreamEnd::Refused(refusal)),
        }
    }
}

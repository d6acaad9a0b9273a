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
mod messages;
mod plans;
mod sequence;
mod spline;
mod state;

pub use messages::{Clock, PlanProgress, PushError, StreamEnd, StreamStep};
pub use state::{PERIOD_RANGE, STREAM_CAPACITY, Stream};

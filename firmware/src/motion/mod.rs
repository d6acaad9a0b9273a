//! Motion: plans of constant-jerk pieces, made outside the tick, followed exactly inside it.
//!
//! # What a plan is
//!
//! A [`Plan`] is a list of pieces of constant jerk for the three axes together. The tick integrates it in integers
//! ([`AxisState`]), so setpoints are continuous by construction and the end is exact. Every plan ends at rest: whatever
//! becomes of the next one, the motion can stop. Planning needs divisions and roots and runs at low priority; a plan
//! reaches the tick through the command queue and is taken only if it starts where the motion is.
//!
//! # Which planner when
//!
//! | asked for | from | planner |
//! |---|---|---|
//! | a target | rest | [`plan_line`]: a straight line |
//! | a target | motion | [`plan_retarget`]: the end of the motion under way, and a line, that overlap |
//! | a velocity | rest or motion | [`plan_jog`] |
//! | targets at a steady rate | rest | [`Stream`] |
//! | a stop | motion | [`plan_stop`], smooth or urgent |
//! | the stop of a fault | motion | none: the plan under way is followed slower and slower ([`FaultStop`]) |
//!
//! There are two profiles. From rest to rest: seven segments, or the time-optimal ones where the pivots ask for it. From
//! any velocity and acceleration to a velocity: three segments and a closing tick; a stop is that to zero, a jog that to
//! a velocity, held, and to zero, the end of a stream that to zero. Everything else is a sum of these, because a plan is
//! linear in its pieces:
//!
//! ```text
//! speed  ______                            A new target in motion. The stop under way ends at A, a line goes from A to the
//!              \    stop                   target. Begun when the stop is over it is "stop, then line"; begun sooner, the
//!               \____                      two add up to a motion that ends at the target all the same. The least delay
//!                 ________                 at which every limit is kept is taken. Towards a target straight ahead the
//!           |    /  line  \                stop's braking and the line's acceleration cancel, and the stage goes on.
//!           |___/          \____           Translation and rotation each have their own line and delay.
//!           delay                    time
//! ```
//!
//! A target in motion is planned in three steps, so that the stage reacts soon: first the stop, then a first way that takes its
//! place, then, some milliseconds into that, the soonest of all ([`Effort`]).
//!
//! Retargets, stops and jogs in motion are held against every limit by one check (`check`), with the tolerances of one table
//! (`tolerances`). A line from rest, a jog from rest and a streamed target are planned inside them by means of their own; the
//! head of `check` says which.
//!
//! # Where what is
//!
//! A line uses only what stands in lines above it.
//!
//! | file or folder | idea |
//! |---|---|
//! | `limits`, `refusal`, `turn_direction`, `tolerances` | limits as a user states them; why a move is refused; which way round to an orientation; what is granted over a limit |
//! | `constraints` | what every plan keeps to: limits, mechanism, workspace, and the point that is moved |
//! | `plan` | the plan, the integers it is made of, sums of plans, and how the tick follows it |
//! | `speeds` | translation and rotation as one pair |
//! | `profile` | the two profiles |
//! | `check` | whether a plan is inside every limit |
//! | `line`, `stop`, `jog`, `stream` | the planners of the table above |
//! | `retarget` | a new target in motion |

pub mod profile;

mod check;
mod constraints;
mod jog;
mod limits;
mod line;
mod plan;
mod refusal;
mod retarget;
mod speeds;
mod stop;
mod stream;
mod tolerances;
mod turn_direction;

pub use check::target::check_target;
pub use constraints::{Bounds, Constraints};
pub use jog::plan_jog;
pub use limits::{Limits, PathLimits};
pub use line::disk::check_line;
pub use line::plan_line;
pub use plan::axis_state::{AxisState, JERK_STEP, SUB_BITS};
pub use plan::follower::{PlanFollower, Stale};
pub use plan::rotation_centre::{MAX_CENTRE_OFFSET, RotationCentre};
pub use plan::setpoint::{Setpoint, SetpointScale};
pub use plan::time_scaling::FaultStop;
pub use plan::{MAX_PIECES, Piece, Plan, PlanStart, Position};
pub use profile::rest_to_rest::RestToRestProfile;
pub use refusal::Refusal;
pub use refusal::RetargetError;
pub use retarget::{Effort, plan_retarget};
pub use stop::{Stop, plan_stop};
pub use stream::{
    Clock, PERIOD_RANGE, PlanProgress, PushError, STREAM_CAPACITY, Stream, StreamEnd, StreamStep,
};
pub use tolerances::JERK_TOLERANCE;
pub use turn_direction::TurnDirection;

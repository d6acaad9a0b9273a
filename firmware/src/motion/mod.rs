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
//! | a target | motion | [`try_retarget`]; where it says so, [`plan_stop`] and then [`plan_line`] |
//! | a velocity | rest or motion | [`plan_jog`] |
//! | targets at a steady rate | rest | [`Stream`] |
//! | a stop | motion | [`plan_stop`], smooth or urgent |
//! | the stop of a fault | motion | none: the plan under way is followed slower and slower ([`FaultStop`]) |
//!
//! A new target in motion is planned in slices, so that the first setpoint towards it does not wait for all that lies
//! ahead. All of what is handed over has been checked.
//!
//! | slice | what comes of it |
//! |---|---|
//! | 1 ([`try_retarget`]) | the new plan, when there is little to check; else its head, which ends in a stop |
//! | 2 ([`Ahead::go_on`]) | the rest of the new plan takes over from the head: the same motion to the bit |
//! | 1 again, when 2 has found it too fast | a slower one that leaves the head; when 1 has, one that leaves a stop just begun |
//!
//! # Where what is
//!
//! A line uses only what stands in lines above it.
//!
//! | file or folder | idea |
//! |---|---|
//! | `limits`, `refusal`, `turn_direction` | limits as a user states them; why a move is refused; which way round to an orientation |
//! | `constraints` | what every plan keeps to: limits, mechanism, workspace, and the point that is moved |
//! | `plan` | the plan, the integers it is made of, and how the tick follows it |
//! | `speeds` | translation and rotation as one pair |
//! | `brake` | from any state to rest, and from a velocity to another |
//! | `profile` | jerk-limited profiles: from rest to rest, and from any state to a target |
//! | `check` | whether a plan is inside every limit |
//! | `line`, `stop`, `jog`, `stream` | the planners of the table above |
//! | `retarget` | a new target in motion |

pub mod profile;

mod brake;
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
mod turn_direction;

pub use crate::number::float::Float;
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
pub use plan::units::AxisLimits;
pub use plan::{MAX_PIECES, Piece, Plan, PlanStart, Position};
pub use profile::any_state::stop_distance;
pub use profile::any_state::task::{AxisProfile, Task, Unusable};
pub use profile::rest_to_rest::RestToRestProfile;
pub use profile::tracks::synchronised;
pub use refusal::Refusal;
pub use refusal::RetargetError;
pub use retarget::ahead::Ahead;
pub use retarget::tries::Tries;
pub use retarget::{Leave, plan_retarget, try_retarget};
pub use stop::{Stop, plan_stop};
pub use stream::{
    Clock, JERK_TOLERANCE, PERIOD_RANGE, PlanProgress, PushError, STREAM_CAPACITY, Stream,
    StreamEnd, StreamStep,
};
pub use turn_direction::TurnDirection;

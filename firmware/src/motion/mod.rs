//! Motion: plans of constant-jerk pieces, made outside the tick, followed exactly inside it.
//!
//! A plan is a list of stretches of constant jerk for the three axes together ([`Plan`]). The tick integrates it in integers
//! ([`AxisState`]), so setpoints are continuous by construction and the end is exact. Planning needs divisions and roots and runs
//! at low priority ([`plan_line`], [`plan_stop`]); a plan reaches the tick through the command queue and is taken only if it
//! starts where the motion is.
//!
//! A new target in motion is planned in slices, so that the first setpoint towards it does not wait for all that lies ahead.
//! Every plan that is handed over ends at rest, all of it looked at: whatever becomes of the next slice, the motion can stop.
//!
//! | slice | what comes of it |
//! |---|---|
//! | 1 ([`try_retarget`]) | the transition, when there is little to look at; else its head, which ends in a stop |
//! | 2 ([`Ahead::go_on`]) | the rest of the transition takes over from the head: the same motion to the bit |
//! | 1 again, when 2 has found it too fast | a slower one that leaves the head; when 1 has, one that leaves a stop just begun |

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

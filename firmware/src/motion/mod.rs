//! Motion: plans of constant-jerk pieces, made outside the tick, followed exactly inside it.
//!
//! A plan is a list of stretches of constant jerk for the three axes together ([`Plan`]). The tick integrates it in integers
//! ([`Axis`]), so setpoints are continuous by construction and the end is exact. Planning needs divisions and roots and runs
//! at low priority ([`plan_line`], [`plan_stop`]); a plan reaches the tick through the command queue and is taken only if it
//! starts where the motion is.

mod axis;
mod follow;
mod limits;
mod line;
mod plan;
mod profile;
mod stop;

pub use axis::{Axis, JERK_STEP, SUB_BITS};
pub use follow::{Motion, Scale, Setpoint, Stale};
pub use limits::{Limits, Line, PathLimits};
pub use line::{Refusal, check_target, plan_line};
pub use plan::{MAX_PIECES, Piece, Plan, Position, Start};
pub use profile::Profile;
pub use stop::{Stop, plan_stop};

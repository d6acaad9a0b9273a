//! Motion: plans of constant-jerk pieces, made outside the tick, followed exactly inside it.
//!
//! A plan is a list of stretches of constant jerk for the three axes together ([`Plan`]). The tick integrates it in integers
//! ([`Axis`]), so setpoints are continuous by construction and the end is exact. Planning needs divisions and roots and runs
//! at low priority ([`plan_line`], [`plan_stop`]); a plan reaches the tick through the command queue and is taken only if it
//! starts where the motion is.

mod axis;
mod axis_profile;
mod envelope;
mod fit;
mod follow;
mod heading;
mod limits;
mod line;
mod plan;
mod profile;
mod stop;
mod transition;

pub use axis::{Axis, JERK_STEP, SUB_BITS};
pub use axis_profile::{AxisLimits, AxisProfile, Task, Unusable, stop_distance};
pub use envelope::Bounds;
pub use follow::{Motion, Scale, Setpoint, Stale};
pub use limits::{Limits, Line, PathLimits};
pub use line::{Refusal, check_target, plan_line};
pub use plan::{MAX_PIECES, Piece, Plan, Position, Start};
pub use profile::Profile;
pub use stop::{Stop, plan_stop};
pub use transition::{NoTransition, plan_curved_stop, plan_transition};

//! Motion: plans of constant-jerk pieces, made outside the tick, followed exactly inside it.
//!
//! A plan is a list of stretches of constant jerk for the three axes together ([`Plan`]). The tick integrates it in integers
//! ([`Axis`]), so setpoints are continuous by construction and the end is exact. Planning needs divisions and roots and runs
//! at low priority ([`plan_line`], [`plan_stop`]); a plan reaches the tick through the command queue and is taken only if it
//! starts where the motion is.
//!
//! A new target in motion is planned in slices, so that the first setpoint towards it does not wait for all that lies ahead.
//! Every plan that is handed over ends at rest, all of it looked at: whatever becomes of the next slice, the motion can stop.
//!
//! | slice | what comes of it |
//! |---|---|
//! | 1 ([`try_transition`]) | the transition, when there is little to look at; else its head, which ends in a stop |
//! | 2 ([`Ahead::go_on`]) | the rest of the transition takes over from the head: the same motion to the bit |
//! | 1 again, when 2 has found it too fast | a slower one that leaves the head; when 1 has, one that leaves a stop just begun |

mod ahead;
mod axis;
mod axis_brake;
mod axis_profile;
mod brake;
mod centre;
mod change;
mod check;
mod choice;
mod disk;
mod envelope;
mod fit;
mod float;
mod follow;
mod grid;
mod ground;
mod halt;
mod hats;
mod heading;
mod instant;
mod jog;
mod limits;
mod line;
mod pace;
mod path;
mod plan;
mod platform;
mod polygon;
mod profile;
mod quotient;
mod ramps;
mod reach;
mod refusal;
mod sample;
mod score;
mod sizes;
mod slower;
mod speed;
mod stop;
mod stream;
mod swing;
mod tracks;
mod transition;
mod units;
mod way;

pub use ahead::Ahead;
pub use axis::{Axis, JERK_STEP, SUB_BITS};
pub use axis_profile::{AxisLimits, AxisProfile, Task, Unusable, stop_distance};
pub use centre::{Centre, FURTHEST};
pub use float::Float;
pub use follow::{Motion, Scale, Setpoint, Slowdown, Stale};
pub use ground::{Bounds, Ground};
pub use jog::plan_jog;
pub use limits::{Limits, PathLimits};
pub use line::{check_line, check_target, plan_line};
pub use plan::{MAX_PIECES, Piece, Plan, Position, Start};
pub use profile::Profile;
pub use refusal::Refusal;
pub use stop::{Stop, plan_stop};
pub use stream::{CAPACITY, Clock, End, JERK_TOLERANCE, Next, NotTaken, PERIODS, Progress, Stream};
pub use tracks::synchronised;
pub use transition::{Leave, NoTransition, Tries, plan_transition, try_transition};
pub use way::Way;

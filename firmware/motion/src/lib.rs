//! Motion: what a plan is, the profiles that plans are made of, and the check that a plan is inside every limit. Plans are made
//! outside the tick, by the package `planners`, and followed exactly inside it.
//!
//! # What a plan is
//!
//! A [`Plan`] is a list of pieces of constant jerk for the three axes together. The tick integrates it in integers
//! ([`AxisState`]), so setpoints are continuous by construction and the end is exact. Every plan ends at rest: whatever
//! becomes of the next one, the motion can stop. Planning needs divisions and roots and runs at low priority; a plan
//! reaches the tick through the command queue and is taken only if it starts where the motion is.
//!
//! # Where what is
//!
//! A line uses only what stands in lines above it.
//!
//! | file or folder | idea |
//! |---|---|
//! | `refusal`, `tolerances` | why a move is refused; what is granted over a limit |
//! | `constraints` | what every plan keeps to: limits, mechanism, workspace, and the point that is moved |
//! | `plan` | the plan, the integers it is made of, sums of plans, and how the tick follows it |
//! | `profile` | `rest_to_rest`: seven segments in closed form, as three moving averages; `velocity`: three segments from any velocity and acceleration to a wanted velocity |
//! | `check` | whether a plan is inside every limit, and a target inside the workspace |
#![cfg_attr(not(test), no_std)]

/// The same for x, y and theta, written out: compiled for size, an array's `map` stays a loop over closures, at four times the
/// instructions.
#[macro_export]
macro_rules! each {
    ($i:ident => $value:expr) => {
        [
            $crate::each!($i, 0 => $value),
            $crate::each!($i, 1 => $value),
            $crate::each!($i, 2 => $value),
        ]
    };
    ($i:ident, $number:literal => $value:expr) => {{
        let $i = $number;
        $value
    }};
}

/// The same for x and y, or for translation and rotation.
#[macro_export]
macro_rules! both {
    ($i:ident => $value:expr) => {
        [$crate::each!($i, 0 => $value), $crate::each!($i, 1 => $value)]
    };
}

pub mod check;
pub mod constraints;
pub mod plan;
pub mod refusal;
pub mod tolerances;

/// Jerk-limited profiles: how long each segment lasts.
pub mod profile {
    pub mod rest_to_rest;
    pub mod velocity;
}

pub use check::workspace::{TurnDirection, check_target};
pub use constraints::{Bounds, Constraints, Limits, PathLimits};
pub use plan::axis_state::{AxisState, JERK_STEP, SUB_BITS};
pub use plan::fault_stop::FaultStop;
pub use plan::follower::{PlanFollower, Stale};
pub use plan::lone_follower::LoneFollower;
pub use plan::setpoint::{MAX_CENTRE_OFFSET, RotationCentre, Setpoint, SetpointScale};
pub use plan::slots::{PlanHandle, PlanReceiver, PlanSender, PlanSlots};
pub use plan::{MAX_PIECES, Piece, Plan, PlanStart, Position};
pub use profile::rest_to_rest::RestToRestProfile;
pub use refusal::{Refusal, RetargetError};
pub use tolerances::JERK_TOLERANCE;

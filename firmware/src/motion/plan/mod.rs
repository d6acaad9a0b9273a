//! A plan: the pieces of constant jerk that carry the three axes from a known state to rest.

pub(crate) mod axis_state;
pub(crate) mod cubic_segment;
pub(crate) mod fault_stop;
pub(crate) mod follower;
pub(crate) mod motion_plan;
pub(crate) mod piece;
pub(crate) mod rotation_centre;
pub(crate) mod setpoint;
pub(crate) mod time_scaling;
pub(crate) mod units;

pub(crate) use motion_plan::nudge_to;
pub use motion_plan::{Plan, PlanStart};
pub use piece::{MAX_PIECES, Piece, Position};
pub(crate) use piece::{Pieces, state_after_pieces};

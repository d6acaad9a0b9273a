//! A plan: the pieces of constant jerk that carry the three axes from a known state to rest, and how the tick follows
//! it.
//!
//! | file | idea |
//! |---|---|
//! | `axis_state` | one axis in integers: an exact cubic, tick by tick or many ticks at once |
//! | `piece` | a position, a piece of constant jerk, a list of them |
//! | `motion_plan` | the plan: what it starts from, its pieces, where it ends |
//! | `sum` | two motions that overlap, as one |
//! | `units` | the units of positions and axes as floats |
//! | `quantise` | profiles in whole ticks and integers |
//! | `cubic_segment` | a piece in floats: the state at an instant of it |
//! | `setpoint` | what the control loop is given at a tick |
//! | `rotation_centre` | the point that is moved, and what its motion is for the platform's centre |
//! | `time_scaling`, `fault_stop` | a fault's stop: the plan's time runs slower and slower |
//! | `follower` | following a plan, and taking the next |

pub mod axis_state;
pub mod cubic_segment;
pub mod fault_stop;
pub mod follower;
pub mod motion_plan;
pub mod piece;
pub mod quantise;
pub mod rotation_centre;
pub mod setpoint;
pub mod sum;
pub mod time_scaling;
pub mod units;

pub use motion_plan::nudge_to;
pub use motion_plan::{Plan, PlanStart};
pub use piece::{MAX_PIECES, Piece, Position};
pub use piece::{Pieces, pieces_after, state_after_pieces};
pub use sum::{push_piece, write_sum};

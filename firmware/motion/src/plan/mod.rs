//! A plan: the pieces of constant jerk that carry the three axes from a known state to rest, and how the tick follows
//! it.
//!
//! | file | idea |
//! |---|---|
//! | `axis_state` | one axis in integers: an exact cubic, tick by tick or many ticks at once |
//! | `motion_plan` | positions, pieces of constant jerk, the plan, and two motions that overlap as one |
//! | `quantise` | profiles in whole ticks and integers |
//! | `cubic_segment` | a piece in floats: the state at an instant of it |
//! | `setpoint` | what the control loop is given at a tick: of the point that is moved, and of the platform's centre |
//! | `fault_stop` | a fault's stop: the plan's time runs slower and slower |
//! | `follower` | following a plan, and taking the next |

pub mod axis_state;
pub mod cubic_segment;
pub mod fault_stop;
pub mod follower;
pub mod motion_plan;
pub mod quantise;
pub mod setpoint;

pub use motion_plan::{
    MAX_PIECES, Piece, Pieces, Plan, PlanStart, Position, nudge_to, pieces_after, push_piece,
    state_after_pieces, write_sum,
};

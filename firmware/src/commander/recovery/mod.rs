//! The way back of a stage that was found out of its reach: slow, with limited voltage, and no further out.
//!
//! The way goes straight towards the middle of the track, at the orientation at which the stage was found: on it the disk, every
//! guide and the separation of the pivots only get better (`on_the_way_back_all_margins_grow` in `tests/tests/recovery.rs` walks such ways). It
//! ends just inside the disk, where every orientation is in reach. Nobody can ask for another way, and what the supervisor watches
//! meanwhile is in [`Parameters::for_recovery`].
//!
//! | step | what happens next, as soon as nothing is in flight |
//! |---|---|
//! | `Limit` | the tick has the limits of recovery: it references, or holds |
//! | `Hold` | the stage holds: the way is planned and sent |
//! | `Drive` | the way: once settled at its end the limits are those of before, and the stage is held; given up, the servo goes off first |
//! | `Restore` | the servo is off, or a fault is latched: the limits are those of before |
//!
//! | file | idea |
//! |---|---|
//! | `state` | how far it has come, how it has ended |
//! | `advance` | its beginning, its steps and its end |

mod advance;
mod state;

pub(super) use state::Recovery;
pub use state::RecoveryEnd;

//! Whose constant velocities (`JOG`) are in force: they end smoothly with the connection that commanded them, or, where it has asked
//! for that with `JTM`, so many milliseconds after its last `JOG`. Those of a macro belong to nobody and go on.
//!
//! | file | idea |
//! |---|---|
//! | `state` | owner and end of the velocity of each axis |
//! | `execute` | `JOG`, `JTM`, and what ends |

mod execute;
mod state;

pub(super) use state::Jogs;

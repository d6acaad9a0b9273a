//! Connections as the controller knows them: their numbers, who commanded last, and what ends with one.
//!
//! | file | idea |
//! |---|---|
//! | `state` | what is known of all of them together |
//! | `execute` | one is heard of, moves, stops another's motion, ends |

mod execute;
mod state;

pub(super) use state::Connections;

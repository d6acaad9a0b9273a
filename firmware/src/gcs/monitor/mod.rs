//! `MON?`: what a client needs to draw the stage while it moves, in one answer.
//!
//! Pose and pivots are those of the base frame and of the platform's centre, whatever frame and centre of rotation are
//! in force. Following errors and duties change faster than anybody asks: told is the lowest and the highest since this
//! connection asked last, among the ticks that have been seen (on the host all of them).
//!
//! | file | idea |
//! |---|---|
//! | `state` | what a connection has not been told yet |
//! | `replies` | `MON?` |

mod replies;
mod state;

pub(super) use state::Monitor;

//! `RCV`: a stage that was found out of its reach, where `FRF` refuses, is driven back, slowly and with limited voltage. It goes on
//! as long as the connection that asked for it lives, or, where that has asked so with `JTM`, so many milliseconds after its last
//! `RCV 1`. Every stop ends it, and so does the silence that a heartbeat does not allow; the servo is off then.
//!
//! | file | idea |
//! |---|---|
//! | `state` | whose it is, and until when |
//! | `execute` | `RCV`, and what ends it |

mod execute;
mod state;

pub(super) use state::RecoveryOwner;

//! What the servos have learnt of their drives: gathered from the snapshots, told by `LST?`, kept over a restart.
//!
//! It is kept as parameters, which the tick starts with. `WPA` takes over what is in force; where a parameter asks for it, the
//! controller stores it by itself when the servo goes off, and every ten minutes at rest, if it has changed by more than what the
//! integral makes up for unnoticed.
//!
//! | file | idea |
//! |---|---|
//! | `reports` | the servos, as the snapshots tell of them |
//! | `keep` | `LST?`, what is taken over and stored |

mod keep;
mod reports;

pub(super) use reports::ServoReports;

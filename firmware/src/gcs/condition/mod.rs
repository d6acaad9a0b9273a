//! Condition monitoring of the drives: whether motor constants, current sensors and friction are still what the parameters say, and
//! whether something knocks.
//!
//! All of it is made of what a snapshot has anyway, while the servo is on. Nothing is latched, nothing stops: `EVT?` tells what
//! has passed a threshold and what is back, `LST?` what was found last (`DRIVE1=`).
//!
//! | file | idea |
//! |---|---|
//! | `drive` | what one drive's currents tell |
//! | `knocks` | what knocks at a pivot: a loose coupling |
//! | `watch` | thresholds, events, lines of `LST?` |

mod drive;
mod knocks;
mod watch;

pub(super) use knocks::Knocks;
pub(super) use watch::{DriveQuantity, DriveWatches};

//! Condition monitoring of the drives: whether motor constants, current sensors and friction are still what the parameters say.
//!
//! All of it is made of what a snapshot has of a servo anyway, while its pivot turns. Nothing is latched, nothing stops: `EVT?` tells what
//! has passed a threshold and what is back, `LST?` what was found last (`DRIVE1=`).
//!
//! | file | idea |
//! |---|---|
//! | `drive` | what one drive's currents tell |
//! | `watch` | thresholds, events, lines of `LST?` |

mod drive;
mod watch;

pub(super) use watch::{DriveQuantity, DriveWatches};

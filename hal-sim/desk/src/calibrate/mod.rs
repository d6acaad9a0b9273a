//! `tripivot calibrate` in front of a controller: a built machine is measured, and its calibration given to its controller.
//!
//! | file | idea |
//! |---|---|
//! | `measure` | a plan is driven, and an instrument read at each of its poses |
//! | `apply` | a calibration is sent to the controller it was made for, all of it or nothing |
//! | `verify` | one that is in force is judged by fresh poses |

mod apply;
mod measure;
mod verify;

pub use apply::{ApplyError, Evidence, apply, lines, switch_off};
pub use measure::{MeasureError, Measured, Reader, Wanted, Way, measure, serial, with_references};
pub use verify::{Verdict, Verified, VerifyError, verify};

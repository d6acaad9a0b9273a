//! `tripivot calibrate` in front of a controller: a built machine is measured, and its calibration given to its controller.
//!
//! | file | idea |
//! |---|---|
//! | `measure` | a plan is driven, and an instrument read at each of its poses |
//! | `guide_give` | what is not made up for meanwhile |
//! | `apply` | a calibration is sent to the controller it was made for, all of it or nothing |
//! | `verify`, `told` | one that is in force is judged by fresh poses |
//! | [`report`] | all that is known of one, as a page |

mod apply;
mod guide_give;
mod measure;
pub mod report;
mod told;
mod verify;

pub use apply::{ApplyError, Evidence, apply, lines, switch_off};
pub use measure::{MeasureError, Measured, Reader, Wanted, Way, measure, serial, with_references};
pub use told::{Kind, Told};
pub use verify::{Verdict, Verified, VerifyError, verify};

//! `tripivot calibrate` in front of a controller: a built machine is measured, and its calibration given to its controller.
//!
//! | file | idea |
//! |---|---|
//! | `planned` | where to measure, and what will come of it, in words |
//! | `measure` | a plan is driven, and an instrument read at each of its poses |
//! | `fitted` | a calibration from what was measured |
//! | `reading` | numbers to and from whoever reads an instrument |
//! | [`rows`] | a measurement as the text that is kept of it |
//! | `apply` | a calibration is sent to the controller it was made for, all of it or nothing |
//! | `verify`, `told` | one that is in force is judged by fresh poses |
//! | `line` | a line of what is told |
//! | [`report`] | all that is known of one, as a page |

mod apply;
mod fitted;
mod line;
mod measure;
mod planned;
mod reading;
pub mod report;
pub mod rows;
mod told;
mod verify;

pub use apply::{ApplyError, Evidence, apply, lines, switch_off};
pub use fitted::{FitTold, Fitted, FittedError, Moved};
pub use line::{Line, nm};
pub use measure::{MeasureError, Measured, Reader, Wanted, Way, measure, serial, with_references};
pub use planned::{NOISES, POSES, PlanTold, noise};
pub use reading::{fields, question, reading};
pub use told::{Kind, Told};
pub use verify::{Verdict, Verified, VerifyError, verify};

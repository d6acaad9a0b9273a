//! `tripivot calibrate` in front of a controller: a built machine is measured, and its calibration given to its controller.
//!
//! | file | idea |
//! |---|---|
//! | `measure` | a plan is driven, and an instrument read at each of its poses |
//! | `apply` | a calibration is sent to the controller it was made for, all of it or nothing |

mod apply;
mod measure;

pub use apply::{ApplyError, apply, switch_off};
pub use measure::{MeasureError, Reader, Wanted, measure, serial, with_references};

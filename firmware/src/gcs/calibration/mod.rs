//! `CAL`: the calibration of a built machine, line by line: all of it is taken or nothing.
//!
//! | file | idea |
//! |---|---|
//! | `request` | what lines ask for |
//! | `parse` | what lines mean |
//! | `execute` | what they do, and what is gathered until `CAL END` |
//! | `replies` | `CAL?` and `CAL POS?` |

mod execute;
pub(super) mod parse;
mod replies;
mod request;

pub(super) use execute::GatheredCalibration;
pub(super) use request::CalibrationAction;

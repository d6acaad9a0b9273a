//! `CAL`: the calibration of a built machine, line by line: all of it is taken or nothing. `TMP`: the temperature that the machine has.
//!
//! | file | idea |
//! |---|---|
//! | `request` | what lines ask for |
//! | `parse` | what lines mean |
//! | `execute` | what they do, and what is gathered until `CAL END` |
//! | `replies` | `CAL?`, `CAL POS?` and `TMP?` |

mod execute;
pub(super) mod parse;
mod replies;
mod request;

pub(super) use execute::GatheredCalibration;
pub(super) use request::CalibrationAction;

#![forbid(unsafe_code)]
//! What a built machine is off the drawing, fitted to what an instrument has measured.
//!
//! Every error of the mechanism's geometry enters guide by guide, through 48 numbers a pivot ([`kinematics::PivotCoefficients`]). An
//! instrument measures poses, or parts of them, beside readings of the three encoders; the numbers follow by least squares, together
//! with what is unknown about the instrument itself. Lengths are in track radii and angles in rad throughout; only the file and
//! the names of its keys speak of mm.
//!
//! | file | idea |
//! |---|---|
//! | [`numbers`] | the 48 numbers as a list: names, sizes that a workshop keeps |
//! | [`model`] | a pivot against its guide, with derivatives by everything |
//! | [`position`] | pose to encoder angles and back, by Newton's method on the model |
//! | [`kit`] | what an instrument measures, and what is unknown about it |
//! | [`visit`] | one measured pose, and what the model says of it |
//! | [`alignment`] | where the instrument stands, roughly |
//! | [`least_squares`] | rows to an orthogonal factor, and what that says of uncertainty |
//! | [`mod@fit`] | the fit: robust, with some visits held out |
//! | `descent`, `residuals` | Gauss-Newton's steps; what is left after them, and outliers |
//! | `scatter` | what the machine itself does not repeat |
//! | [`mod@left`] | what a fit leaves, by visit, pivot and harmonic |
//! | [`mod@contact`] | how a stage comes to the end of a guide, and where that is |
//! | [`drift`] | what has moved while was measured |
//! | [`mod@judge`] | whether a machine of given numbers is the one that was measured |
//! | `error` | why there is no fit |
//! | [`frames`] | errors of poses without what only the choice of frames and of scale makes |
//! | [`accuracy`] | what is left of the machine's errors after a fit, before anything is measured |
//! | [`freedom`] | what an instrument cannot tell |
//! | [`plan`] | poses to measure at, chosen one by one for what they add |
//! | [`spread`] | poses spread evenly over the disk and all orientations |
//! | [`table`] | measured visits as rows of a text file |
//! | [`file`](mod@file) | a fitted machine as a text file |

pub mod accuracy;
pub mod alignment;
pub mod contact;
mod descent;
pub mod drift;
mod error;
pub mod file;
pub mod fit;
pub mod frames;
pub mod freedom;
pub mod judge;
pub mod kit;
pub mod least_squares;
pub mod left;
pub mod model;
pub mod numbers;
pub mod plan;
pub mod position;
mod residuals;
mod scatter;
pub mod spread;
pub mod table;
pub mod visit;

pub use accuracy::Accuracy;
pub use drift::Drift;
pub use error::FitError;
pub use fit::{Fit, fit};
pub use judge::{Judged, Predicted, judge};
pub use kit::{GUIDE_ENDS, Instrument, Kit, Noise};
pub use left::{Left, left};
pub use plan::{Plan, plan};
pub use visit::{Seen, Visit};

/// The three pivots with their rings, encoders and guides.
pub type Machine = [kinematics::PivotCoefficients; 3];
/// A machine as drawn.
pub const DRAWN: Machine = [kinematics::PivotCoefficients::IDEAL; 3];
/// Numbers of a whole machine.
pub const MACHINE_NUMBERS: usize = 3 * kinematics::COEFFICIENTS;

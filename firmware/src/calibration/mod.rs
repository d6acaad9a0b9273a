//! What a built machine's pivots are off the drawing, as the tick takes it.
//!
//! Six numbers of a pivot have a closed form and are constants of the corrected kinematics. Encoder, runout and
//! straightness are curves, series of 42 numbers: too long to be summed for three pivots in a tick. So the tick sums
//! those of one pivot when its duties are written, and goes on along their tangents until that pivot's turn comes again,
//! four ticks later. At 10 rad/s that is 2 mrad, over which a curve bends by 3e-9 rad.
//!
//! | file | idea |
//! |---|---|
//! | `machine` | a calibrated machine: its numbers, whose they are, how they came about |
//! | `margins` | how far the pivots of a built machine stand from where the planners take them to be |

mod machine;
mod margins;

use crate::number::Fixed;
use kinematics::{Corrections, Line, Series};

pub use machine::{
    BeyondLimits, BuiltMachine, CALIBRATION_TEXT_BYTES, CalibrationNumbers, CalibrationText,
    MachineCalibration,
};
pub use margins::CalibrationMargins;

/// What the corrected kinematics take in the tick: the lines of the three pivots and their curves.
pub type Calibration = Corrections<Fixed, Series<f32>>;

/// The calibration of a machine as drawn.
pub const IDEAL: Calibration = Corrections {
    lines: [Line::IDEAL; 3],
    curves: [Series::ZERO; 3],
};

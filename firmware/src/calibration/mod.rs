//! What a built machine's pivots are off the drawing, as the tick takes it.
//!
//! Six numbers of a pivot have a closed form and are constants of the corrected kinematics. Encoder, runout and
//! straightness are curves: too long to be summed in a tick, so they are tables, made outside of it.
//!
//! | file | idea |
//! |---|---|
//! | `table` | values at even steps, straight between them, with the slope |
//! | `pivot_tables` | the tables of a pivot, from its coefficients |

mod pivot_tables;
mod table;

use crate::number::Fixed;
use kinematics::{CoefficientError, Corrections, Line, PivotCoefficients, check_coefficients};

pub use pivot_tables::PivotTables;

/// What the corrected kinematics take in the tick: the lines of the three pivots and their tables, 16 KB.
pub type Calibration = Corrections<Fixed, PivotTables>;

const _: () = assert!(size_of::<Calibration>() <= 16 << 10);

/// The calibration of a machine as drawn.
pub const IDEAL: Calibration = Calibration {
    lines: [Line::IDEAL; 3],
    curves: [PivotTables::ZERO; 3],
};

/// Makes `calibration` that of these coefficients, in place: it is too long for a stack. It computes in f64 with
/// functions that give the same bits everywhere, some 6,000 sums of series: outside the tick, and of a calibration that
/// no tick uses.
///
/// # Errors
/// [`CoefficientError`] names the first number that is not within its limit; nothing is changed then.
pub fn calibrate(
    calibration: &mut Calibration,
    pivots: &[PivotCoefficients; 3],
) -> Result<(), CoefficientError> {
    check_coefficients(pivots)?;
    calibration.lines = pivots.each_ref().map(Line::new);
    for (tables, pivot) in calibration.curves.iter_mut().zip(pivots) {
        tables.fill(pivot);
    }
    Ok(())
}

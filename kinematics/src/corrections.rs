//! All that is corrected of a machine, and what may be.

use core::fmt;

use crate::coefficients::PivotCoefficients;
use crate::corrected_scalar::CorrectedScalar;
use crate::curves::Curves;
use crate::line::Line;

/// What the three pivots of a machine are off the drawing, as the corrected kinematics take it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Corrections<T: CorrectedScalar, C> {
    /// The six numbers of each pivot that have a closed form.
    pub lines: [Line<T>; 3],
    /// Encoder, runout and straightness of each pivot.
    pub curves: [C; 3],
}

impl<T: CorrectedScalar, C: Curves<T>> Corrections<T, C> {
    /// From coefficients within their limits, with `curves` made of each pivot's.
    ///
    /// # Errors
    /// [`CoefficientError`] names the first number that is not within its limit.
    pub fn new(
        pivots: &[PivotCoefficients; 3],
        curves: impl Fn(&PivotCoefficients) -> C,
    ) -> Result<Self, CoefficientError> {
        check_coefficients(pivots)?;
        Ok(Self {
            lines: pivots.each_ref().map(Line::new),
            curves: pivots.each_ref().map(curves),
        })
    }

    /// Whether the machine is as drawn.
    #[must_use]
    pub fn are_zero(&self) -> bool {
        self.lines == [Line::IDEAL; 3] && self.curves.iter().all(Curves::are_zero)
    }
}

/// A number of a machine that the corrected kinematics do not hold for, or that is no number.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct CoefficientError {
    /// Which pivot, 1 to 3.
    pub pivot: usize,
    /// Field of [`PivotCoefficients`].
    pub name: &'static str,
    /// The number; of a curve the sum of its coefficients' sizes.
    pub value: f64,
    /// The largest that is taken, either way.
    pub limit: f64,
}

impl fmt::Display for CoefficientError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            pivot,
            name,
            value,
            limit,
        } = self;
        write!(f, "pivot {pivot}: {name} is {value}, not within {limit}")
    }
}

impl core::error::Error for CoefficientError {}

/// Half a turn, rad.
const ZERO_LIMIT_RAD: f64 = core::f64::consts::PI;
/// Of centre, radius, direction and offset: ten times what a workshop keeps.
const LINE_LIMIT: f64 = 0.02;
/// Of a curve: the step onto a curved guide is good to the square of it.
const CURVE_LIMIT: f64 = 2e-3;

/// Whether the corrected kinematics hold for these numbers: 20 mrad of direction and 0.02 track radii of lengths, 2
/// mrad and 0.002 track radii of curves.
///
/// # Errors
/// [`CoefficientError`] names the first number that is not within its limit.
pub fn check_coefficients(pivots: &[PivotCoefficients; 3]) -> Result<(), CoefficientError> {
    for (built, pivot) in pivots.iter().zip(1..) {
        let size = |numbers: &[f64]| numbers.iter().map(|number| number.abs()).sum::<f64>();
        let sizes = [
            ("encoder_zero_rad", built.encoder_zero_rad, ZERO_LIMIT_RAD),
            ("radius_error", built.radius_error, LINE_LIMIT),
            ("ring_centre", size(&built.ring_centre), LINE_LIMIT),
            ("guide_error_rad", built.guide_error_rad, LINE_LIMIT),
            ("guide_offset", built.guide_offset, LINE_LIMIT),
            (
                "encoder_rad",
                size(built.encoder_rad.as_flattened()),
                CURVE_LIMIT,
            ),
            ("runout", size(built.runout.as_flattened()), CURVE_LIMIT),
            ("straightness", size(&built.straightness), CURVE_LIMIT),
        ];
        for (name, value, limit) in sizes {
            // NaN is within nothing.
            if !(value.abs() <= limit) {
                return Err(CoefficientError {
                    pivot,
                    name,
                    value,
                    limit,
                });
            }
        }
    }
    Ok(())
}

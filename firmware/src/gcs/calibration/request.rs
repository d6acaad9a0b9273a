//! What lines about calibration ask for.

use crate::gcs::text::Text;

/// Numbers in a line, at most.
pub(super) const LINE_NUMBERS: usize = 8;

/// What lines about calibration ask for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CalibrationAction {
    /// `CAL BEG`: whose, of which day, and at how many deg C.
    Begin(Text, Text, Option<f32>),
    /// `CAL SET`: numbers of a pivot (0 to 2), from this one on.
    Set {
        /// The pivot.
        pivot: usize,
        /// Place of the first.
        first: usize,
        /// The numbers.
        numbers: [f32; LINE_NUMBERS],
        /// How many there are.
        count: usize,
    },
    /// `CAL END`: with this checksum.
    End(u32),
    /// `CAL ON`, `CAL OFF`.
    Switch(bool),
    /// `CAL DEL`
    Forget,
    /// `TMP`: the machine's temperature, deg C, and perhaps how much it grows, ppm per K.
    Temperature(f64, Option<f64>),
}

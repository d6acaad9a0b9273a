//! What can not be done with waveforms.

use crate::commander::axis::Axis;
use core::fmt;

/// Why tables and generators stay as they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WaveError {
    /// A segment without a point, or a curve whose parts do not fit into its length.
    NoCurve,
    /// The table would be longer than a table may be.
    TableTooLong,
    /// No memory for as many points, or no room for another segment.
    NoMemory,
    /// The axis can not move: its generator has no table.
    FrozenAxis(Axis),
    /// The generator has no table, or an empty one.
    NoTable(Axis),
}

impl fmt::Display for WaveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoCurve => f.write_str("the parts of the curve do not fit into its length"),
            Self::TableTooLong => f.write_str("the table would be too long"),
            Self::NoMemory => f.write_str("no memory for the waveform"),
            Self::FrozenAxis(axis) => write!(f, "axis {} can not move", axis.letter()),
            Self::NoTable(axis) => write!(f, "axis {} has no waveform", axis.letter()),
        }
    }
}

impl core::error::Error for WaveError {}

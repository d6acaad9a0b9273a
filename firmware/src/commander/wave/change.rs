//! What can be changed about tables and generators.

use super::shape::Shape;
use super::waveforms::{Join, WAVE_TABLES};

/// Points that one change can bring.
pub const LINE_POINTS: usize = 32;

/// Points of a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WavePoints {
    values: [f64; LINE_POINTS],
    count: u8,
}

impl WavePoints {
    /// These; `None` when they are too many.
    pub fn new(values: &[f64]) -> Option<Self> {
        let mut points = Self {
            values: [0.0; LINE_POINTS],
            count: values.len() as u8,
        };
        points
            .values
            .get_mut(..values.len())?
            .copy_from_slice(values);
        Some(points)
    }

    /// The points.
    pub fn values(&self) -> &[f64] {
        let count = usize::from(self.count).min(LINE_POINTS);
        &self.values[..count]
    }
}

/// What is to be done with tables and generators. Tables are counted from 0, generators are the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
// Points are by far the largest; there is no heap to box them in.
#[allow(clippy::large_enum_variant)]
pub enum WaveChange {
    /// A calculated segment.
    Define {
        /// Which.
        table: u8,
        /// How it joins.
        join: Join,
        /// Points of the segment.
        length: u32,
        /// Its curve.
        shape: Shape,
    },
    /// A segment of points.
    Points {
        /// Which.
        table: u8,
        /// How it joins.
        join: Join,
        /// The values.
        points: WavePoints,
    },
    /// Empties tables: a flag for each table.
    Clear([bool; WAVE_TABLES]),
    /// A table (from 1, 0: none) for each generator.
    Select([Option<u32>; 6]),
    /// Cycles of each generator.
    Cycles([Option<u32>; 6]),
    /// Ticks of a point.
    Rate(u32),
    /// Starts and stops generators.
    Switch([Option<bool>; 6]),
}

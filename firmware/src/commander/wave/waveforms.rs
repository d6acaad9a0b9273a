//! Tables and generators.

use super::error::WaveError;
use super::shape::Shape;
use crate::commander::axis::Axis;
use heapless::Vec;

/// Wave tables there are.
pub const WAVE_TABLES: usize = 8;
/// Segments of a table.
pub const WAVE_SEGMENTS: usize = 8;
/// Points, given one by one, of all tables together.
pub const WAVE_POINTS: usize = 1024;
/// Longest table, points: at the fastest rate of points more than a day.
pub const MAX_TABLE_POINTS: u32 = 1 << 28;

/// Where a segment stands in its table.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Segment {
    first: u32,
    length: u32,
    shape: Shape,
}

/// How a segment joins a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Join {
    /// The table begins anew.
    Anew,
    /// Behind the last point.
    Append,
    /// Added to what is there, from the first point.
    Add,
}

/// A generator, as it has been set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Generator {
    /// Its table, counted from 1; 0: none.
    pub table: u8,
    /// How often it runs through; 0: without end.
    pub cycles: u32,
}

/// All tables and generators.
pub struct Waveforms {
    tables: [Vec<Segment, WAVE_SEGMENTS>; WAVE_TABLES],
    points: Vec<f64, WAVE_POINTS>,
    /// By [`Axis::index`].
    pub generators: [Generator; 6],
    /// Ticks of a point, for all generators.
    pub ticks: u32,
}

/// Ticks of a point at first: 1 ms.
const DEFAULT_POINT_TICKS: u32 = 20;

impl Waveforms {
    /// Empty tables.
    pub(in crate::commander) const fn new() -> Self {
        Self {
            tables: [const { Vec::new() }; WAVE_TABLES],
            points: Vec::new(),
            generators: [Generator {
                table: 0,
                cycles: 0,
            }; 6],
            ticks: DEFAULT_POINT_TICKS,
        }
    }

    /// Points of a table (counted from 0).
    pub fn length(&self, table: usize) -> u32 {
        let segments = self.tables[table].iter();
        segments.map(|s| s.first + s.length).max().unwrap_or(0)
    }

    /// A point of a table, both counted from 0.
    pub fn value(&self, table: usize, point: u32) -> f64 {
        self.tables[table]
            .iter()
            .filter(|s| (s.first..s.first + s.length).contains(&point))
            .map(|s| s.shape.value(point - s.first, &self.points))
            .sum()
    }

    /// A calculated segment.
    pub fn define(
        &mut self,
        table: usize,
        join: Join,
        length: u32,
        shape: Shape,
    ) -> Result<(), WaveError> {
        if length == 0 || !shape.is_valid() {
            return Err(WaveError::NoCurve);
        }
        self.join(table, join, length, shape)
    }

    /// A segment of points.
    pub fn define_points(
        &mut self,
        table: usize,
        join: Join,
        values: &[f64],
    ) -> Result<(), WaveError> {
        let freed = if join == Join::Anew {
            self.points_of(table)
        } else {
            0
        };
        if self.points.len() - freed + values.len() > WAVE_POINTS {
            return Err(WaveError::NoMemory);
        }
        if join == Join::Anew {
            self.clear(table);
        }
        let at = self.points.len();
        // The points of a table that grows by lines belong together, if nothing has come between.
        let length = self.length(table);
        if join == Join::Append
            && let Some(last) = self.tables[table].last_mut()
            && let Shape::Points { at: first } = last.shape
            && usize::from(first) + last.length as usize == at
            && last.first + last.length == length
        {
            last.length += values.len() as u32;
        } else {
            let shape = Shape::Points { at: at as u16 };
            self.join(table, join, values.len() as u32, shape)?;
        }
        // There is room.
        let _ = self.points.extend_from_slice(values);
        Ok(())
    }

    fn join(
        &mut self,
        table: usize,
        join: Join,
        length: u32,
        shape: Shape,
    ) -> Result<(), WaveError> {
        let first = match join {
            Join::Anew | Join::Add => 0,
            Join::Append => self.length(table),
        };
        if length > MAX_TABLE_POINTS - first {
            return Err(WaveError::TableTooLong);
        }
        if join == Join::Anew {
            self.clear(table);
        }
        let segment = Segment {
            first,
            length,
            shape,
        };
        self.tables[table]
            .push(segment)
            .map_err(|_| WaveError::NoMemory)
    }

    fn points_of(&self, table: usize) -> usize {
        let segments = self.tables[table].iter();
        segments
            .filter(|s| matches!(s.shape, Shape::Points { .. }))
            .map(|s| s.length as usize)
            .sum()
    }

    /// Empties a table, and closes the gaps that its points leave.
    pub fn clear(&mut self, table: usize) {
        while let Some(segment) = self.tables[table].pop() {
            let Shape::Points { at } = segment.shape else {
                continue;
            };
            let (gap, length) = (usize::from(at), segment.length as usize);
            self.points.copy_within(gap + length.., gap);
            self.points.truncate(self.points.len() - length);
            for other in self.tables.iter_mut().flatten() {
                if let Shape::Points { at } = &mut other.shape
                    && usize::from(*at) > gap
                {
                    *at -= length as u16;
                }
            }
        }
    }

    /// The table of an axis' generator (counted from 0), if it has one with points.
    pub fn table_of(&self, axis: Axis) -> Option<usize> {
        let table = usize::from(self.generators[axis.index()].table).checked_sub(1)?;
        (self.length(table) > 0).then_some(table)
    }
}

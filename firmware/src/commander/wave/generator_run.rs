//! A run of generators: sample after sample, from rest to rest.
//!
//! Curves begin and end at speed. A run passes them as they are, but slowly at first and at last: for a tenth of a
//! second the place in the tables gains speed, so that the axes start from rest, on the very path.
//!
//! ```text
//! points a sample
//! 1 |     .--------------------.
//!   |   .'                      '.
//! 0 | .'                          '.      area: the points of the run
//!   +--|---|------------------|---|--> samples
//!      run-up                  run-out
//! ```

use super::Waveforms;
use crate::commander::axis::Axis;
use crate::commander::axis::Coordinates;

/// How long the run-up lasts, s.
const RUN_UP_S: f64 = 0.1;

/// What is known of a run when it starts, and how far it has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeneratorRun {
    /// The target of the axes that do not take part.
    base: Coordinates,
    /// Of each axis: its table, and its points in all; without end when there is no number of them.
    axes: [Option<(u8, Option<u64>)>; 6],
    /// The last point's number; `None` without end.
    last: Option<u64>,
    /// Samples of the run-up, and of the run-out.
    ramp: u64,
    /// The next sample.
    sample: u64,
}

impl GeneratorRun {
    /// A run of the generators of `starting`, all of which have tables.
    pub fn new(waves: &Waveforms, starting: &[bool; 6], base: Coordinates, rate_hz: f64) -> Self {
        let axes = core::array::from_fn(|i| {
            let table = usize::from(waves.generators[i].table).checked_sub(1)?;
            let points = u64::from(waves.length(table));
            let cycles = u64::from(waves.generators[i].cycles);
            starting[i].then_some((table as u8, (cycles > 0).then_some(cycles * points)))
        });
        let mut last = Some(0);
        for (_, points) in axes.iter().flatten() {
            last = last
                .zip(*points)
                .map(|(last, points): (u64, u64)| last.max(points.saturating_sub(1)));
        }
        // Even, so that behind the run-up every sample is a point.
        let ramp = libm::ceil(RUN_UP_S * rate_hz / f64::from(2 * waves.ticks)) as u64 * 2;
        Self {
            base,
            axes,
            last,
            ramp: last.map_or(ramp, |last| ramp.min(last / 2 * 2)),
            sample: 0,
        }
    }

    /// Which generators it is of.
    pub fn running(&self) -> [bool; 6] {
        self.axes.map(|axis| axis.is_some())
    }

    /// Of each axis that takes part: its table.
    pub fn tables(&self) -> [Option<usize>; 6] {
        self.axes.map(|axis| axis.map(|(table, _)| table.into()))
    }

    /// Samples from the first to the last; `None` without end.
    pub fn samples(&self) -> Option<u64> {
        self.last.map(|last| last + self.ramp)
    }

    /// The next sample; `None` behind the last.
    pub fn next(&mut self, waves: &Waveforms) -> Option<Coordinates> {
        let place = self.place(self.sample)?;
        self.sample += 1;
        Some(self.target(waves, place))
    }

    /// Where the run begins.
    pub fn start(&self, waves: &Waveforms) -> Coordinates {
        self.target(waves, (0, 0.0))
    }

    /// The place in the tables at a sample: a point, and the part of the way to the next.
    fn place(&self, sample: u64) -> Option<(u64, f64)> {
        let Some(last) = self.last else {
            return Some(self.run_up_place(sample));
        };
        // Both ends cost half of the samples that they take.
        let all = last + self.ramp;
        let left = all.checked_sub(sample)?;
        if left >= self.ramp {
            return Some(self.run_up_place(sample));
        }
        let (whole, part) = self.run_up_place(left);
        Some(if part == 0.0 {
            (last - whole, 0.0)
        } else {
            (last - whole - 1, 1.0 - part)
        })
    }

    /// The place so many samples after the start, without an end.
    fn run_up_place(&self, sample: u64) -> (u64, f64) {
        if sample >= self.ramp {
            return (sample - self.ramp / 2, 0.0);
        }
        let (ramp, u) = (self.ramp as f64, sample as f64 / self.ramp as f64);
        let place = ramp * u * u * u * (1.0 - u / 2.0);
        let whole = libm::floor(place);
        (whole as u64, place - whole)
    }

    fn target(&self, waves: &Waveforms, (point, part): (u64, f64)) -> Coordinates {
        let mut target = self.base;
        for axis in Axis::ALL {
            let i = axis.index();
            let Some((table, points)) = self.axes[i] else {
                continue;
            };
            let at = |point: u64| waves.cycled(usize::from(table), points, point);
            target[i] = if part == 0.0 {
                at(point)
            } else {
                interpolate(
                    [
                        at(point.saturating_sub(1)),
                        at(point),
                        at(point + 1),
                        at(point + 2),
                    ],
                    part,
                )
            };
        }
        target
    }
}

/// A part of the way from the second of four points to the third: a cubic whose slopes are those of the neighbours'
/// chords.
fn interpolate([a, b, c, d]: [f64; 4], part: f64) -> f64 {
    let (slope_b, slope_c) = ((c - a) / 2.0, (d - b) / 2.0);
    let bend = 3.0 * (c - b) - 2.0 * slope_b - slope_c;
    let twist = slope_b + slope_c - 2.0 * (c - b);
    b + part * (slope_b + part * (bend + part * twist))
}

impl Waveforms {
    /// The value at a point of a table that is run through again and again, for so many points in all.
    fn cycled(&self, table: usize, points: Option<u64>, point: u64) -> f64 {
        let length = u64::from(self.length(table)).max(1);
        let point = points.map_or(point, |points| point.min(points.saturating_sub(1)));
        self.value(table, (point % length) as u32)
    }
}

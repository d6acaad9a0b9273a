//! Curves as values of 16 bits at even steps, straight between them.

use kinematics::CurvePoint;

/// The largest entry.
const LARGEST: f64 = i16::MAX as f64;
/// A straight line between two values is off in its middle by an eighth of their second difference. Values less a
/// sixteenth of it are off by that everywhere, which is half as much.
const OF_SECOND_DIFFERENCE: f64 = 1.0 / 16.0;

/// `CURVES` curves at the same places: looked up together, one index serves all.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Table<const CURVES: usize, const ENTRIES: usize> {
    entries: [[i16; CURVES]; ENTRIES],
    /// Of a curve's entries.
    units: [f32; CURVES],
    /// Of the differences of its entries, as slopes.
    slope_units: [f32; CURVES],
}

impl<const CURVES: usize, const ENTRIES: usize> Table<CURVES, ENTRIES> {
    pub(super) const ZERO: Self = Self {
        entries: [[0; CURVES]; ENTRIES],
        units: [0.0; CURVES],
        slope_units: [0.0; CURVES],
    };

    pub(super) fn is_zero(&self) -> bool {
        self.units == [0.0; CURVES]
    }

    /// From the curves' `values` at each step from -1 to `ENTRIES`, with so many steps in a unit of the place.
    pub(super) fn fill(&mut self, steps_per_unit: f64, values: impl Fn(f64) -> [f64; CURVES]) {
        let mut largest = [0.0_f64; CURVES];
        each_entry(ENTRIES, &values, |_, entry| {
            for (largest, value) in largest.iter_mut().zip(entry) {
                *largest = largest.max(value.abs());
            }
        });
        self.units = largest.map(|largest| (largest / LARGEST) as f32);
        self.slope_units = self.units.map(|unit| unit * steps_per_unit as f32);
        let (entries, units) = (&mut self.entries, &self.units);
        each_entry(ENTRIES, &values, |index, entry| {
            let Some(places) = entries.get_mut(index) else {
                return;
            };
            for ((place, value), &unit) in places.iter_mut().zip(entry).zip(units) {
                *place = if unit > 0.0 {
                    libm::rint(value / f64::from(unit)) as i16
                } else {
                    0
                };
            }
        });
    }

    /// The curves at `fraction` (0 to 1) of the way from entry `index` to the next; zero beyond the last.
    #[inline]
    pub(super) fn at(&self, index: usize, fraction: f32) -> [CurvePoint<f32>; CURVES] {
        let mut points = [CurvePoint {
            value: 0.0,
            slope: 0.0,
        }; CURVES];
        if let (Some(from), Some(to)) = (self.entries.get(index), self.entries.get(index + 1)) {
            for k in 0..CURVES {
                let (from, to) = (f32::from(from[k]), f32::from(to[k]));
                let step = to - from;
                points[k] = CurvePoint {
                    value: (from + step * fraction) * self.units[k],
                    slope: step * self.slope_units[k],
                };
            }
        }
        points
    }
}

/// Gives `take` every entry before it is rounded.
fn each_entry<const CURVES: usize>(
    entries: usize,
    values: &impl Fn(f64) -> [f64; CURVES],
    mut take: impl FnMut(usize, [f64; CURVES]),
) {
    let (mut before, mut at) = (values(-1.0), values(0.0));
    for index in 0..entries {
        let after = values((index + 1) as f64);
        let mut entry = at;
        for (entry, (before, after)) in entry.iter_mut().zip(before.into_iter().zip(after)) {
            *entry -= OF_SECOND_DIFFERENCE * (before - 2.0 * *entry + after);
        }
        take(index, entry);
        (before, at) = (at, after);
    }
}

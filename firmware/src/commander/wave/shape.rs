//! Curves of waveforms, point by point.
//!
//! ```text
//!   line                    ramp                     sine
//!   |            ____ amp   |       .                |       _-_
//!   |          .'           |     .' '.              |     .'   '.
//!   |        .'             |   .'     '.            |    .       .
//!   |______.'   offset      |_.'         '._         |__-'         '-__
//!     start  |<- length       start  center            start  center
//! ```
//!
//! The line holds its ends outside of the curve. Ramp and sine are cyclic: `start` shifts them inside their length;
//! behind the end of that they hold their first value.

use core::f64::consts::PI;

/// A curve of a segment: values of the points from the segment's first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A line with rounded ends.
    Line {
        /// What all of these have.
        curve: Curve,
        /// Points in which its speed is reached, and lost.
        speed_points: u32,
    },
    /// Up and down again.
    Ramp {
        /// What all of these have.
        curve: Curve,
        /// Points in which its speed is reached, and lost, on either way.
        speed_points: u32,
        /// Point of the curve at which it turns.
        centre: u32,
    },
    /// Up and down again, as a cosine.
    Sine {
        /// What all of these have.
        curve: Curve,
        /// Point of the curve at which it turns.
        centre: u32,
    },
    /// Points one by one.
    Points {
        /// Where they begin in the store of points.
        at: u16,
    },
}

/// What the calculated curves have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curve {
    /// Height, mm or deg.
    pub amplitude: f64,
    /// Lowest value, mm or deg.
    pub offset: f64,
    /// Points of the curve; at least 1.
    pub length: u32,
    /// Point of the segment at which it begins.
    pub start: u32,
}

impl Shape {
    /// Whether the curve is one: its parts fit into its length.
    pub fn is_valid(&self) -> bool {
        match *self {
            Self::Line {
                curve,
                speed_points,
            } => curve.length >= 2 && speed_points <= (curve.length - 1) / 2,
            Self::Ramp {
                curve,
                speed_points,
                centre,
            } => {
                curve.is_around(centre)
                    && speed_points <= centre / 2
                    && speed_points <= (curve.length - centre) / 2
            }
            Self::Sine { curve, centre } => curve.is_around(centre),
            Self::Points { .. } => true,
        }
    }

    /// The value at a point of the segment, mm or deg; `points` is the store of points.
    pub fn value(&self, point: u32, points: &[f64]) -> f64 {
        match *self {
            Self::Line {
                curve,
                speed_points,
            } => {
                let way = point.saturating_sub(curve.start);
                curve.scaled(rounded_line(way, curve.length - 1, speed_points))
            }
            Self::Ramp {
                curve,
                speed_points,
                centre,
            } => curve.cyclic(point, centre, |way, length| {
                rounded_line(way, length, speed_points)
            }),
            Self::Sine { curve, centre } => curve.cyclic(point, centre, |way, length| {
                (1.0 - libm::cos(PI * f64::from(way) / f64::from(length))) / 2.0
            }),
            Self::Points { at } => points
                .get(usize::from(at) + point as usize)
                .copied()
                .unwrap_or_default(),
        }
    }
}

impl Curve {
    const fn is_around(&self, centre: u32) -> bool {
        self.start < self.length && 0 < centre && centre < self.length
    }

    /// `part` of the height.
    fn scaled(&self, part: f64) -> f64 {
        self.offset + self.amplitude * part
    }

    /// Up to `centre` and down to the length by `rise`, which goes from 0 to 1 on a way of a length.
    fn cyclic(&self, point: u32, centre: u32, rise: impl Fn(u32, u32) -> f64) -> f64 {
        let way = match point.checked_sub(self.start) {
            Some(way) => way.min(self.length),
            None => point + self.length - self.start,
        };
        self.scaled(if way < centre {
            rise(way, centre)
        } else {
            rise(self.length - way, self.length - centre)
        })
    }
}

/// From 0 to 1 on a way of `length` points, the first and last `rounding` of them at constant acceleration; 1 behind
/// it.
fn rounded_line(way: u32, length: u32, rounding: u32) -> f64 {
    if way >= length {
        return 1.0;
    }
    let [at, length, rounding] = [way, length, rounding].map(f64::from);
    let speed = 1.0 / (length - rounding);
    let parabola = |at: f64| speed * at * at / (2.0 * rounding);
    if at < rounding {
        parabola(at)
    } else if length - at < rounding {
        1.0 - parabola(length - at)
    } else {
        speed * (at - rounding / 2.0)
    }
}

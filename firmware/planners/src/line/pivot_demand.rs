//! The pivots' demands along a line, at places evenly spaced on it, and what a motion makes of them.

use super::path::Path;
use heapless::Vec;
use motion::constraints::PathLimits;
use motion::tolerances::{PIVOT_MARGIN, PIVOT_MARGIN_PER_SQUARE};
use number::float::FloatMinMax;

/// Most intervals between places.
const MOST: usize = 64;

/// With less than this of it on the whole line, half a turn, half of the places do.
const FEW: f32 = 10.0;

/// What a place asks of a motion: each of these, times what the motion does there, is at most 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct GridPoint {
    /// Times s'': the pivots' shares of their acceleration.
    pub first: [f32; 3],
    /// Times s'^2.
    pub second: [f32; 3],
    /// Times s': the share of the rate, a pivot's or the line's own.
    pub rate: f32,
    /// Whether whatever keeps the rate and the line's own acceleration keeps that of the pivots too.
    pub pivot_limits_inactive: bool,
    /// The largest of `first` and of `second`, whatever the sign.
    most: [f32; 2],
}

/// The part of the pivots' acceleration up to which the pivots' limits are inactive at a place: between two of them a
/// little more may be asked for.
const INACTIVE_BELOW: f32 = 0.9;

/// The demands along a line, as shares of the limits.
#[derive(Clone, Debug)]
pub(super) struct DemandGrid {
    /// From its start to its end.
    pub places: Vec<GridPoint, { MOST + 1 }>,
    /// Limits on s, per second.
    pub limits: PathLimits,
}

/// Speed, acceleration and place of a motion along a line, per second.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PathState {
    pub s: f32,
    pub rate: f32,
    pub acceleration: f32,
}

impl DemandGrid {
    /// Without places yet.
    pub fn new(limits: &PathLimits) -> Self {
        let (places, limits) = (Vec::new(), *limits);
        Self { places, limits }
    }

    /// Lays out the places of a line, where they stay: returned, three kilobytes were copied.
    pub fn fill(&mut self, path: &Path, pivot_rate: f32, pivot_acceleration: f32) {
        let square = path.turn * path.turn + path.length * path.length;
        let many = path.spans_many_turns();
        let intervals = if many || square < FEW { MOST / 2 } else { MOST };
        let spacing = 1.0 / intervals as f32;
        let bent = if many { 0.0 } else { square };
        let granted = 1.0 - (PIVOT_MARGIN + PIVOT_MARGIN_PER_SQUARE * bent * (spacing * spacing));
        let over_rate = 1.0 / (pivot_rate * granted);
        let over_acceleration = 1.0 / (pivot_acceleration * granted);
        let least = 1.0 / self.limits.rate;
        // From place to place the direction is turned by a product, which is a fourth of what sine and cosine cost, and off
        // by some 1e-7 a place.
        let [[mut cos, mut sin], [a, b]] = path.directions(spacing);
        for k in 0..=intervals {
            let demand = path.demand(k as f32 * spacing, [cos, sin]);
            (cos, sin) = (cos * a - sin * b, sin * a + cos * b);
            let (first, second) = (largest(&demand.first), largest(&demand.second));
            let rate = (first * over_rate).fmax(least);
            let asked = first * self.limits.acceleration + second / (rate * rate);
            // There is room for all.
            let _ = self.places.push(GridPoint {
                first: each!(i => demand.first[i] * over_acceleration),
                second: each!(i => demand.second[i] * over_acceleration),
                rate,
                pivot_limits_inactive: asked * over_acceleration <= INACTIVE_BELOW,
                most: [first * over_acceleration, second * over_acceleration],
            });
        }
    }

    /// Number of intervals.
    pub fn intervals(&self) -> usize {
        self.places.len() - 1
    }

    /// The square of the factor by which a motion would have to take longer for this state of it to keep every limit
    /// but that of the line's own acceleration; 1 and less when it does. Between places the demand goes straight.
    pub fn excess(&self, state: &PathState) -> f32 {
        let intervals = self.intervals();
        let at = state.s * intervals as f32;
        let before = (at as usize).min(intervals - 1);
        let Some([a, b]) = self.places.get(before..before + 2) else {
            return 0.0;
        };
        let part = at - before as f32;
        let between = |a: f32, b: f32| a + (b - a) * part;
        let square = state.rate * state.rate;
        let rate = between(a.rate, b.rate);
        let worst = rate * rate * square;
        // As a rule less is asked of the pivots' acceleration than they have, whatever its signs.
        let most = both!(k => a.most[k].fmax(b.most[k]));
        if most[0] * state.acceleration.abs() + most[1] * square <= 1.0 {
            return worst;
        }
        let asked = each!(i => {
            let first = between(a.first[i], b.first[i]);
            let second = between(a.second[i], b.second[i]);
            first * state.acceleration + second * square
        });
        asked
            .into_iter()
            .fold(worst, |worst, asked| worst.fmax(asked.abs()))
    }
}

/// The largest size.
fn largest(values: &[f32; 3]) -> f32 {
    let [a, b, c] = each!(i => values[i].abs());
    a.fmax(b).fmax(c)
}

#[cfg(test)]
mod tests {
    use crate::line::pivot_demand::*;
    use crate::line::topp::{GRID_POINTS, velocity_limit_squared};
    use kinematics::Geometry;
    use motion::Limits;
    use motion::constraints::Constraints;
    use motion::plan::Position;

    const RATE: f32 = 10.0;
    const LIMITS: PathLimits = PathLimits {
        rate: 2.0,
        acceleration: 20.0,
        jerk: 1e4,
    };

    /// Through the middle of the disk and near its rim, by parts of a turn and several.
    fn lines() -> impl Iterator<Item = Path> {
        const ONE: f64 = 4_294_967_296.0;
        let constraints = Constraints::new(Limits::REFERENCE, Geometry::REFERENCE);
        [0.1, -0.8, 1.7, -2.9, 40.0]
            .into_iter()
            .flat_map(move |turns| {
                [(0.1, -0.2), (0.6, 0.3), (-0.4, 0.65)].map(|(x, y)| {
                    let at =
                        |place: [f64; 3]| -> Position { place.map(|part| (part * ONE) as i64) };
                    Path::new(&at([-x, y, 0.3]), &at([x, -y, 0.3 + turns]), &constraints)
                })
            })
    }

    fn grid(path: &Path, pivot_acceleration: f32) -> DemandGrid {
        let mut grid = DemandGrid::new(&LIMITS);
        grid.fill(path, RATE, pivot_acceleration);
        grid
    }

    /// Every place is as demanding as the line is there, whatever came before it.
    #[test]
    fn places_do_not_drift() {
        for path in lines() {
            let grid = grid(&path, 1.0);
            let last = grid.intervals() as f32;
            let kept = grid.places[0].first[0] / path.demand(0.0, path.directions(0.0)[0]).first[0];
            for (k, place) in grid.places.iter().enumerate() {
                let s = k as f32 / last;
                let [[cos, sin], [a, b]] = path.directions(s);
                let right = path.demand(s, [cos * a - sin * b, sin * a + cos * b]);
                let close = |a: f32, b: f32| (a - b).abs() <= 2e-5 * (1.0 + b.abs());
                for i in 0..3 {
                    assert!(
                        close(place.first[i] / kept, right.first[i]),
                        "{place:?} {right:?}"
                    );
                    let scale = path.turn.abs().fmax(1.0);
                    let [a, b] = [place.second[i] / kept, right.second[i]].map(|part| part / scale);
                    assert!(close(a, b), "{place:?} {right:?}");
                }
            }
        }
    }

    /// What places with inactive pivot limits skip makes no difference.
    #[test]
    fn places_with_inactive_limits_are_as_fast_as_others() {
        let (mut inactive, mut others) = (0, 0);
        for path in lines() {
            for acceleration in [60.0, 200.0, 600.0, 3_000.0, 20_000.0] {
                let grid = grid(&path, acceleration);
                let mut wary = grid.clone();
                for place in &mut wary.places {
                    inactive += usize::from(place.pivot_limits_inactive);
                    others += usize::from(!place.pivot_limits_inactive);
                    place.pivot_limits_inactive = false;
                }
                let (mut fast, mut slow) = ([0.0; GRID_POINTS], [0.0; GRID_POINTS]);
                velocity_limit_squared(&grid, &mut fast);
                velocity_limit_squared(&wary, &mut slow);
                for (fast, slow) in fast.iter().zip(&slow) {
                    assert!((fast - slow).abs() <= 1e-5 * slow, "{fast} {slow}");
                }
            }
        }
        assert!(inactive > 500 && others > 500, "{inactive} {others}");
    }

    /// At the places themselves: by the limits' definition, pivot for pivot.
    #[test]
    fn an_excess_is_that_of_the_worst_limit() {
        let mut over = 0;
        for path in lines() {
            let grid = grid(&path, 50.0);
            for (k, place) in grid.places.iter().enumerate() {
                for (rate, acceleration) in [(0.0, 12.0), (0.5, 0.01), (0.4, -19.0), (2.2, 8.0)] {
                    let state = PathState {
                        s: k as f32 / grid.intervals() as f32,
                        rate,
                        acceleration,
                    };
                    let worst = (0..3)
                        .map(|i| place.first[i] * acceleration + place.second[i] * rate * rate)
                        .fold((place.rate * rate) * (place.rate * rate), |worst, part| {
                            worst.fmax(part.abs())
                        });
                    let given = grid.excess(&state);
                    over += usize::from(worst > 1.0);
                    let same = (given - worst).abs() <= 1e-3 * worst;
                    assert!(same || (given <= 1.0 && worst <= 1.0), "{given} {worst}");
                }
            }
        }
        assert!(over > 100, "{over}");
    }
}

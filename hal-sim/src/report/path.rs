//! The way of the centre over the plane, in a bounded number of points.

/// Points kept at most.
const CAPACITY: usize = 8192;
/// Distance between points to begin with, mm: a third of a pixel in the picture of the reference stage.
const FIRST_SPACING_MM: f64 = 0.1;

/// A polyline whose points are at least one spacing apart. When it is full, every other point goes and the spacing
/// doubles.
#[derive(Clone, Debug)]
pub struct Path {
    points: Vec<[f64; 2]>,
    spacing_mm: f64,
    last: Option<[f64; 2]>,
}

impl Default for Path {
    fn default() -> Self {
        Self {
            points: Vec::new(),
            spacing_mm: FIRST_SPACING_MM,
            last: None,
        }
    }
}

impl Path {
    /// Adds one tick's place, mm.
    pub fn add(&mut self, point: [f64; 2]) {
        self.last = Some(point);
        if let Some(&[x, y]) = self.points.last()
            && (point[0] - x).hypot(point[1] - y) < self.spacing_mm
        {
            return;
        }
        if self.points.len() == CAPACITY {
            let mut index = 0;
            self.points.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            self.spacing_mm *= 2.0;
        }
        self.points.push(point);
    }

    /// The points, the very last one included, mm.
    pub fn points(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        self.points.iter().copied().chain(self.last)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stays_bounded_and_near_every_place() {
        let place = |tick: u32| {
            let angle = f64::from(tick) * 1e-3;
            [angle * 0.7 * angle.cos(), angle * 0.7 * angle.sin()]
        };
        let ticks = 120_000;
        let mut path = Path::default();
        (0..ticks).for_each(|tick| path.add(place(tick)));
        let points: Vec<_> = path.points().collect();
        assert!(points.len() <= CAPACITY + 1);
        assert_eq!(points[points.len() - 1], place(ticks - 1));
        for tick in (0..ticks).step_by(997) {
            let [x, y] = place(tick);
            let nearest_mm = (points.iter())
                .map(|point| (point[0] - x).hypot(point[1] - y))
                .fold(f64::INFINITY, f64::min);
            assert!(
                nearest_mm <= path.spacing_mm,
                "tick {tick}: {nearest_mm} mm"
            );
        }
    }
}

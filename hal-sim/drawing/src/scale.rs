//! Axes: a range of values laid on a range of pixels, with round ticks.

/// A linear axis.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    low: f64,
    pixels_per_value: f64,
    low_px: f64,
}

impl Scale {
    /// `low` to `high` laid from `low_px` to `high_px`.
    pub fn new((low, high): (f64, f64), (low_px, high_px): (f64, f64)) -> Self {
        Self {
            low,
            pixels_per_value: (high_px - low_px) / (high - low),
            low_px,
        }
    }

    /// Where a value is, px.
    pub fn pixel(&self, value: f64) -> f64 {
        self.low_px + (value - self.low) * self.pixels_per_value
    }
}

/// Which steps between ticks are round.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Steps {
    /// 1, 2, 5 times a power of ten.
    Decimal,
    /// Parts and multiples of a turn in degrees; decimal below 15 deg.
    Degrees,
}

const DEGREE_STEPS: [f64; 10] = [
    15.0, 30.0, 45.0, 90.0, 180.0, 360.0, 720.0, 1_080.0, 1_800.0, 3_600.0,
];

/// Share of a step, less than a tenth of a pixel, that asks for no further step: a stage rests nanometres below zero.
const UNSEEN: f64 = 1e-3;

/// A range widened to whole steps, and those steps.
#[derive(Clone, Debug)]
pub struct Ticks {
    /// From the first mark to the last.
    pub range: (f64, f64),
    /// The marks.
    pub values: Vec<f64>,
    decimals: usize,
}

impl Ticks {
    /// About `count` steps over at least `low` to `high`. An empty range is widened, one that is not finite becomes 0 to 1.
    pub fn covering((low, high): (f64, f64), count: f64, steps: Steps) -> Self {
        let (low, high) = widened(low, high);
        let step = round_step((high - low) / count, steps);
        let (first, last) = ((low / step + UNSEEN).floor(), (high / step - UNSEEN).ceil());
        let values = (0..=(last - first) as u32)
            .map(|index| (first + f64::from(index)) * step)
            .collect();
        Self {
            range: (first * step, last * step),
            values,
            decimals: (-step.log10().floor()).clamp(0.0, 9.0) as usize,
        }
    }

    /// What is written at a mark.
    pub fn label(&self, value: f64) -> String {
        let decimals = self.decimals;
        // A typographic minus, as wide as the digits.
        format!("{:.decimals$}", value + 0.0).replace('-', "\u{2212}")
    }
}

fn widened(low: f64, high: f64) -> (f64, f64) {
    if !(low.is_finite() && high.is_finite()) {
        return (0.0, 1.0);
    }
    let least = 1e-9_f64.max(1e-9 * low.abs().max(high.abs()));
    if high - low < least {
        (low - 1.0, high + 1.0)
    } else {
        (low, high)
    }
}

fn round_step(raw: f64, steps: Steps) -> f64 {
    if steps == Steps::Degrees && raw > 10.0 {
        let known = DEGREE_STEPS.into_iter().find(|&step| step >= raw);
        return known.unwrap_or_else(|| 360.0 * round_step(raw / 360.0, Steps::Decimal));
    }
    let power = 10.0_f64.powf(raw.log10().floor());
    let round = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|&mantissa| mantissa * power >= raw);
    round.unwrap_or(10.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_cover_the_range() {
        let ticks = Ticks::covering((-0.3, 1.9), 4.0, Steps::Decimal);
        assert_eq!(ticks.values, [-1.0, 0.0, 1.0, 2.0]);
        assert_eq!(ticks.range, (-1.0, 2.0));
        let turns = Ticks::covering((0.0, 1080.0), 4.0, Steps::Degrees);
        assert_eq!(turns.values, [0.0, 360.0, 720.0, 1080.0]);
        let at_rest = Ticks::covering((-1e-6, 1_080.000_001), 4.0, Steps::Degrees);
        assert_eq!(at_rest.range, (0.0, 1080.0));
        let small = Ticks::covering((0.0, 0.034), 4.0, Steps::Decimal);
        assert_eq!(small.label(small.values[1]), "0.01");
    }

    #[test]
    fn any_range_has_ticks() {
        for range in [
            (0.0, 0.0),
            (5e9, 5e9),
            (f64::NAN, 1.0),
            (f64::INFINITY, f64::NEG_INFINITY),
        ] {
            for steps in [Steps::Decimal, Steps::Degrees] {
                let ticks = Ticks::covering(range, 4.0, steps);
                assert!(
                    (2..=20).contains(&ticks.values.len()),
                    "{range:?}: {ticks:?}"
                );
                assert!(ticks.range.0 < ticks.range.1);
            }
        }
    }
}

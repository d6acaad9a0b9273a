//! Errors over a disk: an arrow from each place, as long as the error there by a scale that is told, and its colour another error.

use crate::colour::{self, diverging, viridis};
use crate::scale::{Steps, Ticks};
use crate::svg::{Anchor, Font, Point, Rect, Stroke, Svg};

/// An error at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrow {
    /// Where, mm.
    pub at: Point,
    /// How far off, in the unit of the scale.
    pub off: Point,
    /// The other error, in its unit.
    pub shade: f64,
}

/// What arrows and colours are worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worth<'a> {
    /// The longest arrow, and its unit.
    pub longest: (f64, &'a str),
    /// The strongest colour, what it is, and its unit.
    pub strongest: (f64, &'a str, &'a str),
    /// Whether there is another error.
    pub has_shades: bool,
}

impl Worth<'_> {
    /// From the largest of many errors, made round.
    #[must_use]
    pub fn of<'a>(
        arrows: impl Iterator<Item = &'a Arrow>,
        unit: &'a str,
        (what, shade_unit): (&'a str, &'a str),
    ) -> Worth<'a> {
        let (longest, strongest) = arrows.fold((0.0_f64, 0.0_f64), |(off, shade), arrow| {
            let here = arrow.off[0].hypot(arrow.off[1]);
            (off.max(here), shade.max(arrow.shade.abs()))
        });
        let round = |most: f64| {
            *Ticks::covering((0.0, most), 1.0, Steps::Decimal)
                .values
                .last()
                .unwrap_or(&1.0)
        };
        Worth {
            longest: (round(longest), unit),
            strongest: (round(strongest), what, shade_unit),
            has_shades: strongest > 0.0,
        }
    }
}

/// The longest arrow, as a share of the disk's radius.
const LONGEST: f64 = 0.3;
/// Half the width of an arrow's head, and its length, px.
const HEAD_PX: [f64; 2] = [2.6, 6.0];

/// Circles are smaller than arrows by this, or they would overlap.
const CIRCLE: f64 = 0.45;

/// A disk (its radius in mm) in a square frame, its title above.
pub struct Field<'a> {
    /// The frame.
    pub frame: Rect,
    /// The disk's radius, mm.
    pub radius_mm: f64,
    /// What arrows and colours are worth.
    pub worth: &'a Worth<'a>,
}

impl Field<'_> {
    /// Errors as arrows.
    pub fn draw_arrows(&self, svg: &mut Svg, title: &str, arrows: &[Arrow]) {
        self.draw_disk(svg, title);
        for arrow in arrows {
            let at = self.place(arrow.at);
            let [x, y] = arrow.off.map(|part| part * self.arrow_px());
            let shade = diverging(arrow.shade / self.worth.strongest.0);
            svg.circle(at, 3.4, &shade, Some(&Stroke::new(colour::FAINT, 0.6)));
            draw_arrow(svg, at, [at[0] + x, at[1] - y]);
        }
    }

    /// Standard deviations as circles, as large as the first part of `off` by the scale.
    pub fn draw_circles(&self, svg: &mut Svg, title: &str, arrows: &[Arrow]) {
        self.draw_disk(svg, title);
        for arrow in arrows {
            let shade = viridis(1.0 - arrow.shade / self.worth.strongest.0);
            let size = CIRCLE * arrow.off[0] * self.arrow_px();
            let rim = Stroke::new(colour::FAINT, 0.6);
            svg.circle(self.place(arrow.at), size, &shade, Some(&rim));
        }
    }

    fn draw_disk(&self, svg: &mut Svg, title: &str) {
        let ([x, y], reach) = (self.middle(), self.reach_px());
        let font = Font::new(15.0, colour::INK, Anchor::Middle).bold();
        svg.text([x, self.frame.top - 4.0], title, &font);
        let rim = Stroke::new(colour::STEEL, 1.0);
        svg.circle([x, y], reach, colour::PANEL, Some(&rim));
        let axis = Stroke::new(colour::GRID, 1.0);
        svg.line([x - reach, y], [x + reach, y], &axis);
        svg.line([x, y - reach], [x, y + reach], &axis);
    }

    fn middle(&self) -> Point {
        let Rect {
            left,
            top,
            width,
            height,
        } = self.frame;
        [left + width / 2.0, top + height / 2.0]
    }

    fn reach_px(&self) -> f64 {
        self.frame.width / 2.0 / (1.0 + LONGEST / 2.0)
    }

    fn place(&self, at: Point) -> Point {
        let [x, y] = at.map(|mm| mm / self.radius_mm * self.reach_px());
        [self.middle()[0] + x, self.middle()[1] - y]
    }

    /// Px of one unit of an arrow.
    fn arrow_px(&self) -> f64 {
        LONGEST * self.reach_px() / self.worth.longest.0
    }

    /// What arrows, or circles, and colours are worth; from this place to the right and down.
    pub fn draw_worth(&self, svg: &mut Svg, [left, top]: Point, are_circles: bool) {
        let longest_px = LONGEST * self.reach_px();
        let font = Font::new(14.0, colour::INK, Anchor::Start);
        let (most, unit) = self.worth.longest;
        if are_circles {
            let (radius, rim) = (CIRCLE * longest_px, Stroke::new(colour::INK, 1.2));
            svg.circle([left + radius, top], radius, "none", Some(&rim));
        } else {
            draw_arrow(svg, [left, top], [left + longest_px, top]);
        }
        svg.text([left, top + 34.0], &format!("{most} {unit}"), &font);
        if !self.worth.has_shades {
            return;
        }
        let (most, what, unit) = self.worth.strongest;
        svg.text([left, top + 74.0], &format!("{what}, {unit}"), &font);
        let (shade, low): (fn(f64) -> String, _) = if are_circles {
            (|share| viridis(1.0 - share), "0".to_owned())
        } else {
            (
                |share| diverging(2.0 * share - 1.0),
                format!("\u{2212}{most}"),
            )
        };
        draw_bar(svg, [left, top + 82.0], shade, [&low, &most.to_string()]);
    }
}

fn draw_bar(svg: &mut Svg, [left, top]: Point, shade: fn(f64) -> String, ends: [&str; 2]) {
    const STEPS: u32 = 40;
    const SIZE_PX: [f64; 2] = [110.0, 12.0];
    for step in 0..STEPS {
        let share = f64::from(step) / f64::from(STEPS);
        let part = Rect {
            left: left + share * SIZE_PX[0],
            top,
            // A little over the next, or there is a line between them.
            width: SIZE_PX[0] / f64::from(STEPS) + 0.5,
            height: SIZE_PX[1],
        };
        svg.rect(&part, &shade(share), None);
    }
    let below = top + SIZE_PX[1] + 15.0;
    let small = |anchor| Font::new(13.0, colour::FAINT, anchor);
    svg.text([left, below], ends[0], &small(Anchor::Start));
    svg.text([left + SIZE_PX[0], below], ends[1], &small(Anchor::End));
}

fn draw_arrow(svg: &mut Svg, from: Point, to: Point) {
    let along = [to[0] - from[0], to[1] - from[1]];
    let length = along[0].hypot(along[1]);
    svg.line(from, to, &Stroke::new(colour::INK, 1.2));
    if length < HEAD_PX[1] {
        return;
    }
    let [u, v] = along.map(|part| part / length);
    let back = |side: f64| {
        [
            to[0] - HEAD_PX[1] * u - side * HEAD_PX[0] * v,
            to[1] - HEAD_PX[1] * v + side * HEAD_PX[0] * u,
        ]
    };
    svg.path([to, back(1.0), back(-1.0)], true, colour::INK, None);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrows_are_as_long_as_their_errors() {
        let arrow = |at: Point, off: Point| Arrow {
            at,
            off,
            shade: -3.0,
        };
        let arrows = [
            arrow([0.0, 0.0], [4.0, 0.0]),
            arrow([80.0, 0.0], [0.0, 1.0]),
        ];
        let worth = Worth::of(arrows.iter(), "um", ("theta", "urad"));
        assert_eq!((worth.longest.0, worth.strongest.0), (5.0, 5.0));
        let frame = Rect {
            left: 0.0,
            top: 0.0,
            width: 230.0,
            height: 230.0,
        };
        let field = Field {
            frame,
            radius_mm: 80.0,
            worth: &worth,
        };
        assert_eq!(field.place([80.0, 40.0]), [215.0, 65.0]);
        assert!((field.arrow_px() * worth.longest.0 - LONGEST * 100.0).abs() < 1e-9);
        let mut svg = Svg::new(230.0, 230.0);
        field.draw_arrows(&mut svg, "errors", &arrows);
        assert_eq!(svg.finish().matches("<circle").count(), 3);
    }
}

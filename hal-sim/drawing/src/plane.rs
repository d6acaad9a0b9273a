//! Curves in a plane whose axes are linear or logarithmic: frequency responses and their loci.

use crate::colour;
use crate::scale::{Scale, Steps, Ticks};
use crate::svg::{Anchor, Font, Point, Rect, Stroke, Svg};

/// An axis from its lowest value to its highest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axis {
    /// Equal steps.
    Linear(f64, f64),
    /// Decades; both ends are positive.
    Logarithmic(f64, f64),
}

/// A curve.
pub struct Curve<'a> {
    /// For the legend; empty: none.
    pub name: &'a str,
    /// As CSS has it.
    pub colour: &'a str,
    /// Dashes instead of a whole line.
    pub dashed: bool,
    /// Through these.
    pub points: Vec<Point>,
}

/// A frame with curves in it.
pub struct Plane<'a> {
    /// What is shown.
    pub title: &'a str,
    /// To the right.
    pub x: Axis,
    /// Upwards.
    pub y: Axis,
    /// What `x` is, and its unit.
    pub x_name: &'a str,
    /// The curves.
    pub curves: &'a [Curve<'a>],
    /// Values of `y` to be marked by a dashed line: limits.
    pub marks: &'a [f64],
}

struct Laid {
    scale: Scale,
    is_logarithmic: bool,
    /// Values and what is written there.
    ticks: Vec<(f64, String)>,
}

impl Laid {
    fn new(axis: Axis, pixels: (f64, f64)) -> Self {
        match axis {
            Axis::Linear(low, high) => {
                let ticks = Ticks::covering((low, high), 4.0, Steps::Decimal);
                let inside = |value: &&f64| (low..=high).contains(*value);
                Self {
                    scale: Scale::new((low, high), pixels),
                    is_logarithmic: false,
                    ticks: (ticks.values.iter().filter(inside))
                        .map(|value| (*value, ticks.label(*value)))
                        .collect(),
                }
            }
            Axis::Logarithmic(low, high) => Self {
                scale: Scale::new((low.log10(), high.log10()), pixels),
                is_logarithmic: true,
                ticks: decades(low, high),
            },
        }
    }

    fn pixel(&self, value: f64) -> f64 {
        let shown = if self.is_logarithmic {
            value.log10()
        } else {
            value
        };
        self.scale.pixel(shown)
    }
}

/// 1, 2 and 5 of each decade between two values.
fn decades(low: f64, high: f64) -> Vec<(f64, String)> {
    let (first, last) = (low.log10().floor() as i32, high.log10().ceil() as i32);
    (first..=last)
        .flat_map(|decade| [1.0, 2.0, 5.0].map(|digit| (digit * 10_f64.powi(decade), decade)))
        .filter(|(value, _)| (low..=high).contains(value))
        .map(|(value, decade)| (value, format!("{value:.0$}", (-decade).max(0) as usize)))
        .collect()
}

impl Plane<'_> {
    /// Draws into `frame`, the title above it and the axis' name below.
    pub fn draw(&self, svg: &mut Svg, frame: &Rect) {
        let x = Laid::new(self.x, (frame.left, frame.right()));
        let y = Laid::new(self.y, (frame.bottom(), frame.top));
        self.draw_words(svg, frame);
        svg.rect(frame, colour::PANEL, None);
        draw_grid(svg, frame, &x, &y);
        svg.clipped_to_rect(frame, |svg| {
            for curve in self.curves {
                let points = (curve.points.iter()).map(|at| [x.pixel(at[0]), y.pixel(at[1])]);
                let mut stroke = Stroke::new(curve.colour, 2.0);
                stroke.dashed = curve.dashed;
                svg.path(points, false, "none", Some(&stroke));
            }
            for &mark in self.marks {
                let line = Stroke::new(colour::INK, 1.2).dashed();
                svg.line(
                    [frame.left, y.pixel(mark)],
                    [frame.right(), y.pixel(mark)],
                    &line,
                );
            }
        });
        svg.rect(frame, "none", Some(&Stroke::new(colour::STEEL, 1.0)));
    }

    /// Draws places into a frame that is drawn, each set in its colour.
    pub fn draw_dots(&self, svg: &mut Svg, frame: &Rect, dots: &[(&str, Vec<Point>)]) {
        let x = Laid::new(self.x, (frame.left, frame.right()));
        let y = Laid::new(self.y, (frame.bottom(), frame.top));
        svg.clipped_to_rect(frame, |svg| {
            for (colour, places) in dots {
                for &[at_x, at_y] in places {
                    svg.circle([x.pixel(at_x), y.pixel(at_y)], 2.6, colour, None);
                }
            }
        });
    }

    fn draw_words(&self, svg: &mut Svg, frame: &Rect) {
        let title = Font::new(16.0, colour::INK, Anchor::Start).bold();
        svg.text([frame.left, frame.top - 30.0], self.title, &title);
        let mut left = frame.left;
        for curve in self.curves.iter().filter(|curve| !curve.name.is_empty()) {
            let mut swatch = Stroke::new(curve.colour, 3.0);
            swatch.dashed = curve.dashed;
            let height = frame.top - 13.0;
            svg.line([left, height], [left + 20.0, height], &swatch);
            let name = Font::new(14.0, colour::INK, Anchor::Start);
            svg.text([left + 26.0, height + 5.0], curve.name, &name);
            left += 50.0 + 7.5 * curve.name.chars().count() as f64;
        }
        let name = Font::new(14.0, colour::INK, Anchor::Middle);
        let middle = frame.left + frame.width / 2.0;
        svg.text([middle, frame.bottom() + 40.0], self.x_name, &name);
    }
}

fn draw_grid(svg: &mut Svg, frame: &Rect, x: &Laid, y: &Laid) {
    let grid = Stroke::new(colour::GRID, 1.0);
    for (value, text) in &x.ticks {
        let at = x.pixel(*value);
        svg.line([at, frame.top], [at, frame.bottom()], &grid);
        let label = Font::new(13.0, colour::FAINT, Anchor::Middle);
        svg.text([at, frame.bottom() + 18.0], text, &label);
    }
    for (value, text) in &y.ticks {
        let at = y.pixel(*value);
        svg.line([frame.left, at], [frame.right(), at], &grid);
        let label = Font::new(13.0, colour::FAINT, Anchor::End);
        svg.text([frame.left - 6.0, at + 4.5], text, &label);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decades_are_marked_at_1_2_and_5() {
        let texts: Vec<_> = decades(0.03, 3.0).into_iter().map(|tick| tick.1).collect();
        assert_eq!(texts, ["0.05", "0.1", "0.2", "0.5", "1", "2"]);
        let axis = Laid::new(Axis::Logarithmic(1.0, 100.0), (0.0, 200.0));
        assert!((axis.pixel(10.0) - 100.0).abs() < 1e-9);
        let axis = Laid::new(Axis::Linear(-1.0, 1.0), (200.0, 0.0));
        assert!((axis.pixel(0.5) - 50.0).abs() < 1e-9);
    }
}

//! A chart of one or a few quantities over time.

use crate::colour;
use crate::envelope::Bin;
use crate::scale::{Scale, Steps, Ticks};
use crate::svg::{Anchor, Font, Rect, Stroke, Svg};

/// Steps of a chart's value axis, about.
const VALUE_STEPS: f64 = 4.0;

/// One line of a chart.
pub struct Series<'a> {
    /// For the legend; empty: none.
    pub name: &'a str,
    /// As CSS has it.
    pub colour: &'a str,
    /// Which channel of the bins.
    pub channel: usize,
}

/// A chart over a time axis that it shares with others.
pub struct Chart<'a, const N: usize> {
    /// What and its unit.
    pub title: &'a str,
    /// At the right end of the title's line.
    pub note: String,
    /// What is drawn.
    pub bins: &'a [Bin<N>],
    /// What a value is multiplied by to be shown.
    pub factor: f64,
    /// The lines.
    pub series: &'a [Series<'a>],
    /// How the value axis is divided.
    pub steps: Steps,
    /// Whether the axis has to include zero.
    pub from_zero: bool,
    /// Values to be marked by a dashed line: limits.
    pub marks: &'a [f64],
}

/// The time axis and the stretches in which the stage moves.
pub struct TimeAxis {
    /// From s to px.
    pub scale: Scale,
    /// Marks, s.
    pub ticks: Ticks,
    /// Begin and end of each stretch, s.
    pub moving: Vec<(f64, f64)>,
}

impl<const N: usize> Chart<'_, N> {
    /// Draws into `frame`, the title above it.
    pub fn draw(&self, svg: &mut Svg, frame: &Rect, time: &TimeAxis) {
        let ticks = Ticks::covering(self.range(), VALUE_STEPS, self.steps);
        let values = Scale::new(ticks.range, (frame.bottom(), frame.top));
        self.draw_title(svg, frame);
        draw_back(svg, frame, time);
        draw_grid(svg, frame, &ticks, &values);
        svg.clipped_to_rect(frame, |svg| {
            for series in self.series {
                self.draw_series(svg, series, time, &values);
            }
            for &mark in self.marks {
                let y = values.pixel(mark);
                let line = Stroke::new(colour::INK, 1.2).dashed();
                svg.line([frame.left, y], [frame.right(), y], &line);
            }
        });
        svg.rect(frame, "none", Some(&Stroke::new(colour::STEEL, 1.0)));
    }

    fn range(&self) -> (f64, f64) {
        let start = if self.from_zero {
            (0.0, 0.0)
        } else {
            (f64::INFINITY, f64::NEG_INFINITY)
        };
        let values = (self.series.iter()).flat_map(|series| {
            (self.bins.iter()).map(|bin| (bin.min[series.channel], bin.max[series.channel]))
        });
        let (low, high) = values.fold(start, |(low, high), (min, max)| {
            (low.min(min * self.factor), high.max(max * self.factor))
        });
        (self.marks.iter()).fold((low, high), |(low, high), &mark| {
            (low.min(mark), high.max(mark))
        })
    }

    fn draw_title(&self, svg: &mut Svg, frame: &Rect) {
        let baseline = frame.top - 8.0;
        let title = Font::new(16.0, colour::INK, Anchor::Start).bold();
        svg.text([frame.left, baseline], self.title, &title);
        if self.series.len() > 1 {
            for (index, series) in self.series.iter().enumerate() {
                let left = frame.left + 250.0 + 95.0 * index as f64;
                let swatch = Stroke::new(series.colour, 4.0);
                svg.line(
                    [left, baseline - 5.0],
                    [left + 18.0, baseline - 5.0],
                    &swatch,
                );
                let name = Font::new(15.0, colour::INK, Anchor::Start);
                svg.text([left + 26.0, baseline], series.name, &name);
            }
        }
        let note = Font::new(15.0, colour::FAINT, Anchor::End);
        svg.text([frame.right(), baseline], &self.note, &note);
    }

    /// Down and up through the smallest and largest value of each bin.
    fn draw_series(&self, svg: &mut Svg, series: &Series<'_>, time: &TimeAxis, values: &Scale) {
        let channel = series.channel;
        let points = self.bins.iter().flat_map(|bin| {
            let middle_s = (bin.start_s + bin.end_s) / 2.0;
            let x = time.scale.pixel(middle_s);
            [bin.min[channel], bin.max[channel]].map(|value| [x, values.pixel(value * self.factor)])
        });
        svg.path(
            points,
            false,
            "none",
            Some(&Stroke::new(series.colour, 1.6)),
        );
    }
}

fn draw_back(svg: &mut Svg, frame: &Rect, time: &TimeAxis) {
    svg.rect(frame, colour::PANEL, None);
    for &(start_s, end_s) in &time.moving {
        let (left, right) = (time.scale.pixel(start_s), time.scale.pixel(end_s));
        let band = Rect {
            left,
            width: right - left,
            ..*frame
        };
        svg.rect(&band, colour::TINT, None);
    }
    for &tick in &time.ticks.values {
        let x = time.scale.pixel(tick);
        svg.line(
            [x, frame.top],
            [x, frame.bottom()],
            &Stroke::new(colour::GRID, 1.0),
        );
    }
}

fn draw_grid(svg: &mut Svg, frame: &Rect, ticks: &Ticks, values: &Scale) {
    for &tick in &ticks.values {
        let y = values.pixel(tick);
        let width = if tick == 0.0 { 1.6 } else { 1.0 };
        svg.line(
            [frame.left, y],
            [frame.right(), y],
            &Stroke::new(colour::GRID, width),
        );
        let label = Font::new(14.0, colour::FAINT, Anchor::End);
        svg.text([frame.left - 8.0, y + 5.0], &ticks.label(tick), &label);
    }
}

/// The labels of the time axis below `frame`.
pub fn draw_time_labels(svg: &mut Svg, frame: &Rect, time: &TimeAxis) {
    let label = Font::new(14.0, colour::FAINT, Anchor::Middle);
    for &tick in &time.ticks.values {
        let x = time.scale.pixel(tick);
        svg.text([x, frame.bottom() + 20.0], &time.ticks.label(tick), &label);
    }
    let name = Font::new(15.0, colour::INK, Anchor::Middle);
    let middle = frame.left + frame.width / 2.0;
    svg.text([middle, frame.bottom() + 40.0], "time, s", &name);
}

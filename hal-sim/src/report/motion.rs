//! The picture of a run's setpoints: how fast, how hard and how jerkily the moved point, theta and the pivots are driven,
//! beside the limits that hold for them.

use super::Run;
use super::picture::{COLUMNS, draw_conditions, series, time_axis};
use super::trace::Plots;
use drawing::chart::{Chart, Series, TimeAxis, draw_time_labels};
use drawing::colour;
use drawing::scale::Steps;
use drawing::svg::{Anchor, Font, Rect, Svg};

const WIDTH: f64 = 1600.0;
const HEIGHT: f64 = 1270.0;
const LEFT: f64 = super::picture::CHART_LEFT;
const TOP: f64 = 110.0;
const CHART_HEIGHT: f64 = 107.0;
const PITCH: f64 = 142.0;

/// The whole picture.
pub(super) fn draw(run: &Run) -> String {
    let mut svg = Svg::new(WIDTH, HEIGHT);
    let title = Font::new(26.0, colour::INK, Anchor::Start).bold();
    let heading = format!("Tripivot: {}, setpoints and their limits", run.name);
    svg.text([30.0, 48.0], &heading, &title);
    draw_conditions(&mut svg, run);
    draw_notes(&mut svg);
    let plots = &run.trace.plots().reduced(COLUMNS);
    let time = time_axis(plots);
    let frames: [Rect; 8] = std::array::from_fn(|index| Rect {
        left: LEFT,
        top: TOP + PITCH * index as f64,
        width: super::picture::CHART_WIDTH,
        height: CHART_HEIGHT,
    });
    draw_point(&mut svg, run, plots, &time, &frames);
    draw_pivots(&mut svg, run, plots, &time, &frames);
    draw_time_labels(&mut svg, &frames[7], &time);
    svg.finish()
}

/// What the reader looks at, beside the charts.
fn draw_notes(svg: &mut Svg) {
    let notes: [(f64, &[&str]); 3] = [
        (
            TOP,
            &[
                "The point that is moved",
                "Speed, acceleration and jerk along its path:",
                "a diagonal is no faster than a straight.",
                "Dashed: the limits of the parameters. Stops",
                "by command and after faults may brake harder.",
            ],
        ),
        (
            TOP + 3.0 * PITCH,
            &[
                "Orientation",
                "The same for theta. Both groups of a straight",
                "move start and arrive together, so that one",
                "of them is usually below its limits.",
            ],
        ),
        (
            TOP + 6.0 * PITCH,
            &[
                "Pivots",
                "What the mechanism makes of it: the motion is",
                "slowed down where, and only where, a pivot",
                "would pass its limit.",
            ],
        ),
    ];
    for (top, lines) in notes {
        for (index, line) in lines.iter().enumerate() {
            let font = if index == 0 {
                Font::new(19.0, colour::INK, Anchor::Start).bold()
            } else {
                Font::new(16.0, colour::FAINT, Anchor::Start)
            };
            svg.text([30.0, top + 16.0 + 26.0 * index as f64], line, &font);
        }
    }
}

fn draw_point(svg: &mut Svg, run: &Run, plots: &Plots, time: &TimeAxis, frames: &[Rect; 8]) {
    let limits = &run.limits;
    let charts: [(&str, &str, f64, bool); 6] = [
        ("Speed, mm/s", colour::CENTRE, limits.speed_mm_s, false),
        (
            "Acceleration, mm/s\u{b2}",
            colour::CENTRE,
            limits.acceleration_mm_s2,
            false,
        ),
        ("Jerk, mm/s\u{b3}", colour::CENTRE, limits.jerk_mm_s3, false),
        (
            "Rate of \u{3b8}, deg/s",
            colour::THETA,
            limits.turn_speed_deg_s,
            true,
        ),
        (
            "Acceleration of \u{3b8}, deg/s\u{b2}",
            colour::THETA,
            limits.turn_acceleration_deg_s2,
            true,
        ),
        (
            "Jerk of \u{3b8}, deg/s\u{b3}",
            colour::THETA,
            limits.turn_jerk_deg_s3,
            true,
        ),
    ];
    for (channel, (title, colour, limit, signed)) in charts.into_iter().enumerate() {
        let bins = plots.motion.bins();
        let peak = bins.iter().fold(0.0_f64, |peak, bin| {
            peak.max(bin.max[channel].abs()).max(bin.min[channel].abs())
        });
        let marks = [limit, -limit];
        let chart = Chart {
            title,
            note: peak_note(peak, limit),
            bins,
            factor: 1.0,
            series: &[series("", colour, channel)],
            steps: Steps::Decimal,
            from_zero: true,
            marks: if signed { &marks } else { &marks[..1] },
        };
        chart.draw(svg, &frames[channel], time);
    }
}

fn draw_pivots(svg: &mut Svg, run: &Run, plots: &Plots, time: &TimeAxis, frames: &[Rect; 8]) {
    let bins = plots.pivot_rates.bins();
    let [first, second, third] = colour::PIVOTS;
    let limits = [
        ("Rates of the pivots, rad/s", run.limits.pivot_rate_rad_s),
        (
            "Accelerations, rad/s\u{b2}",
            run.limits.pivot_acceleration_rad_s2,
        ),
    ];
    for (group, (title, limit)) in limits.into_iter().enumerate() {
        let from = 3 * group;
        let series: [Series<'_>; 3] = [
            series("pivot 1", first, from),
            series("pivot 2", second, from + 1),
            series("pivot 3", third, from + 2),
        ];
        let peak = bins.iter().fold(0.0_f64, |peak, bin| {
            (from..from + 3).fold(peak, |peak, channel| {
                peak.max(bin.max[channel].abs()).max(bin.min[channel].abs())
            })
        });
        let chart = Chart {
            title,
            note: peak_note(peak, limit),
            bins,
            factor: 1.0,
            series: &series,
            steps: Steps::Decimal,
            from_zero: true,
            marks: &[limit, -limit],
        };
        chart.draw(svg, &frames[6 + group], time);
    }
}

fn peak_note(peak: f64, limit: f64) -> String {
    format!("peak {:.1} % of the limit", 100.0 * peak / limit)
}

//! The picture of a run: its path, its last pose, and what it did over time.

use super::Run;
use super::mechanism::{Plane, draw_mechanism, draw_track};
use super::sample::Move;
use super::statistics::Spread;
use super::trace::Plots;
use drawing::chart::{Chart, Series, TimeAxis, draw_time_labels};
use drawing::colour;
use drawing::scale::{Scale, Steps, Ticks};
use drawing::svg::{Anchor, Font, Rect, Stroke, Svg};

const WIDTH: f64 = 1600.0;
const HEIGHT: f64 = 1000.0;
/// The two square views at the left.
const VIEW: f64 = 400.0;
const VIEW_LEFT: f64 = 70.0;
const PATH_TOP: f64 = 110.0;
const MECHANISM_TOP: f64 = 582.0;
/// The stack of charts at the right.
pub(super) const CHART_LEFT: f64 = 580.0;
pub(super) const CHART_WIDTH: f64 = 990.0;
const CHART_TOP: f64 = 110.0;
const CHART_HEIGHT: f64 = 107.0;
const CHART_PITCH: f64 = 142.0;
/// Bins of a chart at most: more than it has columns of pixels.
pub(super) const COLUMNS: usize = 2048;

/// The whole picture.
pub(super) fn draw(run: &Run) -> String {
    let mut svg = Svg::new(WIDTH, HEIGHT);
    draw_heading(&mut svg, run);
    draw_path(&mut svg, run);
    draw_last_pose(&mut svg, run);
    draw_charts(&mut svg, run);
    svg.finish()
}

fn draw_heading(svg: &mut Svg, run: &Run) {
    let title = Font::new(26.0, colour::INK, Anchor::Start).bold();
    svg.text(
        [VIEW_LEFT - 40.0, 48.0],
        &format!("Tripivot: {}", run.name),
        &title,
    );
    let facts = Font::new(17.0, colour::FAINT, Anchor::End);
    svg.text([CHART_LEFT + CHART_WIDTH, 46.0], &facts_line(run), &facts);
    draw_conditions(svg, run);
}

/// What the run was made under, below the heading.
pub(super) fn draw_conditions(svg: &mut Svg, run: &Run) {
    let font = Font::new(13.0, colour::FAINT, Anchor::Start);
    let place = [VIEW_LEFT - 40.0, 70.0];
    svg.text(place, &run.conditions.to_string(), &font);
}

fn facts_line(run: &Run) -> String {
    let statistics = run.trace.statistics();
    let moves = run.moves.len();
    if statistics.moving.truth.xy_um.count() == 0 {
        return format!("{moves} moves in {:.1} s", statistics.end_s);
    }
    let mut line = format!(
        "{moves} moves in {:.1} s  \u{b7}  rms error of the true pose {} \u{b5}m, {} \u{b5}rad",
        statistics.end_s,
        digits(statistics.moving.truth.xy_um.rms()),
        digits(statistics.moving.truth.theta_urad.rms()),
    );
    if let Some(worst_s) = worst_settle_s(&run.moves) {
        line += &format!("  \u{b7}  settled within {:.1} ms", 1e3 * worst_s);
    }
    line
}

/// `None` without moves or if one of them never settled.
fn worst_settle_s(moves: &[Move]) -> Option<f64> {
    let settles: Option<Vec<f64>> = moves.iter().map(Move::settle_s).collect();
    settles?.into_iter().reduce(f64::max)
}

fn view(top: f64) -> Rect {
    Rect {
        left: VIEW_LEFT,
        top,
        width: VIEW,
        height: VIEW,
    }
}

fn draw_view_title(svg: &mut Svg, frame: &Rect, title: &str) {
    let font = Font::new(16.0, colour::INK, Anchor::Start).bold();
    svg.text([frame.left, frame.top - 8.0], title, &font);
}

fn draw_path(svg: &mut Svg, run: &Run) {
    let frame = view(PATH_TOP);
    let radius_mm = run.geometry.radius_mm;
    let reach_mm = 1.12 * radius_mm;
    let plane = Plane::new(&frame, [0.0; 2], reach_mm / radius_mm);
    draw_view_title(svg, &frame, "Path of the centre, mm");
    svg.rect(
        &frame,
        colour::PANEL,
        Some(&Stroke::new(colour::STEEL, 1.0)),
    );
    draw_path_axes(svg, &frame, reach_mm);
    draw_track(svg, &plane, &run.geometry);
    let places: Vec<_> = (run.trace.path().points())
        .map(|[x, y]| plane.pixel([x / radius_mm, y / radius_mm]))
        .collect();
    svg.clipped_to_rect(&frame, |svg| {
        let line = Stroke::new(colour::CENTRE, 2.0);
        svg.path(places.iter().copied(), false, "none", Some(&line));
    });
    if let (Some(&first), Some(&last)) = (places.first(), places.last()) {
        let ring = Stroke::new(colour::CENTRE, 2.0);
        svg.circle(first, 7.0, colour::PANEL, Some(&ring));
        svg.circle(last, 4.5, colour::CENTRE, None);
    }
    let note = Font::new(13.0, colour::FAINT, Anchor::End);
    let disk_mm = run.geometry.usable_radius() * radius_mm;
    let text = format!("dashed: usable disk, {disk_mm:.0} mm");
    svg.text([frame.right(), frame.top - 8.0], &text, &note);
}

fn draw_path_axes(svg: &mut Svg, frame: &Rect, reach_mm: f64) {
    let ticks = Ticks::covering((-reach_mm, reach_mm), 5.0, Steps::Decimal);
    let across = Scale::new((-reach_mm, reach_mm), (frame.left, frame.right()));
    let upwards = Scale::new((-reach_mm, reach_mm), (frame.bottom(), frame.top));
    for &tick in ticks.values.iter().filter(|tick| tick.abs() <= reach_mm) {
        let (x, y) = (across.pixel(tick), upwards.pixel(tick));
        let grid = Stroke::new(colour::GRID, 1.0);
        svg.line([x, frame.top], [x, frame.bottom()], &grid);
        svg.line([frame.left, y], [frame.right(), y], &grid);
        let label = ticks.label(tick);
        let below = Font::new(14.0, colour::FAINT, Anchor::Middle);
        svg.text([x, frame.bottom() + 19.0], &label, &below);
        let beside = Font::new(14.0, colour::FAINT, Anchor::End);
        svg.text([frame.left - 8.0, y + 5.0], &label, &beside);
    }
}

fn draw_last_pose(svg: &mut Svg, run: &Run) {
    let Some(last) = run.trace.last() else {
        return;
    };
    let frame = view(MECHANISM_TOP);
    draw_view_title(svg, &frame, "Last pose");
    draw_mechanism(svg, &frame, &run.geometry, last.pose);
    // Rounded to nothing, a small negative number would keep its sign.
    let [x_mm, y_mm, theta_deg] = last.pose.map(|value| (1e3 * value).round() / 1e3 + 0.0);
    let text = format!("x {x_mm:.3} mm, y {y_mm:.3} mm, \u{3b8} {theta_deg:.3}\u{b0}")
        .replace('-', "\u{2212}");
    let font = Font::new(13.0, colour::FAINT, Anchor::End);
    svg.text([frame.right(), frame.top - 8.0], &text, &font);
}

pub(super) fn time_axis(plots: &Plots) -> TimeAxis {
    let bins = plots.error.bins();
    let start_s = bins.first().map_or(0.0, |bin| bin.start_s);
    let end_s = bins.last().map_or(1.0, |bin| bin.end_s);
    let mut ticks = Ticks::covering((start_s, end_s), 10.0, Steps::Decimal);
    let end_s = if end_s > start_s {
        end_s
    } else {
        start_s + 1.0
    };
    // The first sample lies one period after zero, and zero is still to be named.
    let slack_s = 1e-3 * (end_s - start_s);
    (ticks.values).retain(|tick| (start_s - slack_s..=end_s + slack_s).contains(tick));
    let pixels = (CHART_LEFT, CHART_LEFT + CHART_WIDTH);
    TimeAxis {
        scale: Scale::new((start_s, end_s), pixels),
        ticks,
        moving: moving_stretches(plots),
    }
}

/// Bins in which the stage moves, joined.
fn moving_stretches(plots: &Plots) -> Vec<(f64, f64)> {
    let mut stretches: Vec<(f64, f64)> = Vec::new();
    let mut moved = false;
    for bin in plots.error.bins() {
        let moves = bin.max[2] > 0.0;
        match stretches.last_mut() {
            Some(stretch) if moves && moved => stretch.1 = bin.end_s,
            _ if moves => stretches.push((bin.start_s, bin.end_s)),
            _ => {}
        }
        moved = moves;
    }
    stretches
}

fn draw_charts(svg: &mut Svg, run: &Run) {
    let plots = &run.trace.plots().reduced(COLUMNS);
    let time = time_axis(plots);
    let frames: [Rect; 6] = std::array::from_fn(|index| Rect {
        left: CHART_LEFT,
        top: CHART_TOP + CHART_PITCH * index as f64,
        width: CHART_WIDTH,
        height: CHART_HEIGHT,
    });
    let [centre, theta, centre_error, theta_error, pivots, duty] = &frames;
    draw_pose(svg, plots, &time, centre, theta);
    draw_errors(svg, run, plots, &time, centre_error, theta_error);
    draw_drives(svg, run, plots, &time, pivots, duty);
    draw_time_labels(svg, duty, &time);
}

pub(super) fn series<'a>(name: &'a str, colour: &'a str, channel: usize) -> Series<'a> {
    Series {
        name,
        colour,
        channel,
    }
}

fn draw_pose(svg: &mut Svg, plots: &Plots, time: &TimeAxis, centre: &Rect, theta: &Rect) {
    let chart = Chart {
        title: "Centre, mm",
        note: "shaded: setpoint moving".to_owned(),
        bins: plots.pose.bins(),
        factor: 1.0,
        series: &[series("x", colour::X, 0), series("y", colour::Y, 1)],
        steps: Steps::Decimal,
        from_zero: true,
        marks: &[],
    };
    chart.draw(svg, centre, time);
    let chart = Chart {
        title: "Orientation \u{3b8}, deg",
        note: String::new(),
        series: &[series("\u{3b8}", colour::THETA, 2)],
        steps: Steps::Degrees,
        ..chart
    };
    chart.draw(svg, theta, time);
}

/// Of the following error, and of the true pose's.
fn both_notes(seen: &Spread, truth: &Spread) -> String {
    let [peak, rms, true_peak, true_rms] =
        [seen.peak(), seen.rms(), truth.peak(), truth.rms()].map(digits);
    format!("moving, peak and rms: following {peak}, {rms}; true pose {true_peak}, {true_rms}")
}

/// Three significant digits, in plain notation.
fn digits(value: f64) -> String {
    let decimals = (2.0 - value.abs().log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{value:.decimals$}")
}

fn draw_errors(
    svg: &mut Svg,
    run: &Run,
    plots: &Plots,
    time: &TimeAxis,
    centre: &Rect,
    theta: &Rect,
) {
    let statistics = run.trace.statistics();
    let chart = Chart {
        title: "Error of the centre, \u{b5}m",
        note: both_notes(
            &statistics.moving.following.xy_um,
            &statistics.moving.truth.xy_um,
        ),
        bins: plots.error.bins(),
        factor: 1.0,
        series: &[
            series("true pose", colour::STEEL, 3),
            series("following", colour::CENTRE, 0),
        ],
        steps: Steps::Decimal,
        from_zero: true,
        marks: &[],
    };
    chart.draw(svg, centre, time);
    let chart = Chart {
        title: "Error of \u{3b8}, \u{b5}rad",
        note: both_notes(
            &statistics.moving.following.theta_urad,
            &statistics.moving.truth.theta_urad,
        ),
        series: &[
            series("true pose", colour::STEEL, 4),
            series("following", colour::THETA, 1),
        ],
        ..chart
    };
    chart.draw(svg, theta, time);
}

fn draw_drives(
    svg: &mut Svg,
    run: &Run,
    plots: &Plots,
    time: &TimeAxis,
    pivots: &Rect,
    duty: &Rect,
) {
    let statistics = run.trace.statistics();
    let [first, second, third] = colour::PIVOTS;
    let series = [
        series("pivot 1", first, 0),
        series("pivot 2", second, 1),
        series("pivot 3", third, 2),
    ];
    let chart = Chart {
        title: "Pivots on the track, deg",
        note: format!("closest two: {:.1}\u{b0}", statistics.separation_deg),
        bins: plots.pivots.bins(),
        factor: 1.0,
        series: &series,
        steps: Steps::Degrees,
        from_zero: false,
        marks: &[],
    };
    chart.draw(svg, pivots, time);
    let chart = Chart {
        title: "Duty of the motors, %",
        note: format!("peak {:.1} %", 100.0 * statistics.peak_duty),
        bins: plots.duty.bins(),
        factor: 100.0,
        steps: Steps::Decimal,
        from_zero: true,
        ..chart
    };
    chart.draw(svg, duty, time);
}

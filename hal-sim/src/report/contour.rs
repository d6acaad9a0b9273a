//! A quantity over the disk as a filled contour picture, in the manner of the source paper's Fig. 5.

use contour::{Contour, ContourBuilder};
use kinematics::Geometry;

use super::mechanism::Plane;
use drawing::colour;
use drawing::scale::{Steps, Ticks};
use drawing::svg::{Anchor, Font, Point, Rect, Stroke, Svg};

/// What to draw.
pub struct ContourMap<'a> {
    /// Heading.
    pub title: String,
    /// What the numbers at the lines are.
    pub quantity: &'a str,
    /// Where lines are drawn, ascending.
    pub levels: &'a [f64],
    /// Decimals of the numbers at the lines.
    pub decimals: usize,
    /// The quantity at (x, y) in track radii, anywhere strictly inside the track.
    pub value: &'a dyn Fn(f64, f64) -> f64,
    /// Whose usable disk is shown.
    pub geometry: Geometry,
}

const WIDTH: f64 = 1000.0;
const HEIGHT: f64 = 900.0;
const FRAME: Rect = Rect {
    left: 90.0,
    top: 80.0,
    width: 740.0,
    height: 740.0,
};
/// Half the side of the square shown, track radii.
const REACH: f64 = 1.06;
/// Samples along a side of the grid, which covers a little more than the disk so that no line ends short of the rim.
const SAMPLES: usize = 421;
const GRID_REACH: f64 = 1.02;
/// Outside this radius the quantity is taken from it: at the track it may be infinite.
const OUTERMOST: f64 = 0.999;
/// A line's number needs this much of it inside the disk, pixels.
const LABELLED_PX: f64 = 90.0;
/// Numbers keep this far apart, pixels.
const LABELS_APART_PX: f64 = 46.0;

/// The picture as an SVG document.
pub fn contour_map(map: &ContourMap<'_>) -> String {
    let mut svg = Svg::new(WIDTH, HEIGHT);
    let title = Font::new(22.0, colour::INK, Anchor::Start).bold();
    svg.text([FRAME.left, 48.0], &map.title, &title);
    svg.rect(&FRAME, colour::PANEL, None);
    let plane = Plane::new(&FRAME, [0.0; 2], REACH);
    draw_axes(&mut svg, &plane);
    draw_areas(&mut svg, map, &plane);
    draw_key(&mut svg, map);
    svg.finish()
}

fn draw_axes(svg: &mut Svg, plane: &Plane) {
    let grid = Stroke::new(colour::GRID, 1.0);
    let ticks = Ticks::covering((-1.0, 1.0), 4.0, Steps::Decimal);
    for &tick in &ticks.values {
        let ([x, _], [_, y]) = (plane.pixel([tick, 0.0]), plane.pixel([0.0, tick]));
        svg.line([x, FRAME.top], [x, FRAME.bottom()], &grid);
        svg.line([FRAME.left, y], [FRAME.right(), y], &grid);
        let label = ticks.label(tick);
        let below = Font::new(15.0, colour::FAINT, Anchor::Middle);
        svg.text([x, FRAME.bottom() + 22.0], &label, &below);
        let beside = Font::new(15.0, colour::FAINT, Anchor::End);
        svg.text([FRAME.left - 10.0, y + 5.0], &label, &beside);
    }
    svg.rect(&FRAME, "none", Some(&Stroke::new(colour::STEEL, 1.0)));
    let name = Font::new(16.0, colour::INK, Anchor::Middle);
    let [middle_x, middle_y] = plane.pixel([0.0; 2]);
    svg.text([middle_x, FRAME.bottom() + 48.0], "x, track radii", &name);
    let turned = Font {
        turned_deg: -90.0,
        ..name
    };
    svg.text([FRAME.left - 58.0, middle_y], "y, track radii", &turned);
}

fn draw_areas(svg: &mut Svg, map: &ContourMap<'_>, plane: &Plane) {
    let origin = plane.pixel([0.0; 2]);
    let radius = plane.length(1.0);
    let contours = contours(map);
    svg.clipped_to_circle(origin, radius, |svg| {
        svg.circle(origin, radius, &fill(map, 0), None);
        for (index, contour) in contours.iter().enumerate() {
            let edge = Stroke::new(colour::PANEL, 1.2);
            svg.rings(&rings(contour, plane), &fill(map, index + 1), Some(&edge));
        }
    });
    let track = Stroke::new(colour::INK, 2.0);
    svg.circle(origin, radius, "none", Some(&track));
    let rim = Stroke::new(colour::INK, 1.8).dashed();
    let usable = plane.length(map.geometry.usable_radius());
    svg.circle(origin, usable, "none", Some(&rim));
    draw_numbers(svg, map, &contours, plane);
}

/// The colour between level `index` and the one before it.
fn fill(map: &ContourMap<'_>, index: usize) -> String {
    colour::viridis(index as f64 / map.levels.len() as f64)
}

/// The area above each level.
fn contours(map: &ContourMap<'_>) -> Vec<Contour> {
    let step = 2.0 * GRID_REACH / (SAMPLES - 1) as f64;
    let at = |index: usize| index as f64 * step - GRID_REACH;
    let values: Vec<f64> = (0..SAMPLES * SAMPLES)
        .map(|index| value_near(map, at(index % SAMPLES), at(index / SAMPLES)))
        .collect();
    // The builder's samples lie in the middle of its cells.
    let origin = -GRID_REACH - step / 2.0;
    ContourBuilder::new(SAMPLES, SAMPLES, true)
        .x_origin(origin)
        .y_origin(origin)
        .x_step(step)
        .y_step(step)
        .contours(&values, map.levels)
        // Its only error is a grid of another size than it was told.
        .unwrap_or_default()
}

/// The value at a place, or at the nearest place on the outermost circle.
fn value_near(map: &ContourMap<'_>, x: f64, y: f64) -> f64 {
    let radius = x.hypot(y);
    if radius < OUTERMOST {
        return (map.value)(x, y);
    }
    let shrink = OUTERMOST / radius;
    (map.value)(x * shrink, y * shrink)
}

/// Outer and inner rims of a contour's area, on the sheet.
fn rings(contour: &Contour, plane: &Plane) -> Vec<Vec<Point>> {
    let polygons = contour.geometry().iter();
    let lines =
        polygons.flat_map(|polygon| std::iter::once(polygon.exterior()).chain(polygon.interiors()));
    lines
        .map(|line| {
            (line.0.iter())
                .map(|place| plane.pixel([place.x, place.y]))
                .collect()
        })
        .collect()
}

fn draw_numbers(svg: &mut Svg, map: &ContourMap<'_>, contours: &[Contour], plane: &Plane) {
    let mut taken: Vec<Point> = Vec::new();
    for (&level, contour) in map.levels.iter().zip(contours) {
        let text = number(map, level);
        for ring in rings(contour, plane) {
            for run in runs_inside(&ring, plane) {
                let Some((place, turned_deg)) = label_place(run, &taken) else {
                    continue;
                };
                taken.push(place);
                draw_number(svg, place, turned_deg, &text);
            }
        }
    }
}

fn draw_number(svg: &mut Svg, [x, y]: Point, turned_deg: f64, text: &str) {
    let font = Font {
        turned_deg,
        halo: Some(colour::PANEL),
        ..Font::new(15.0, colour::INK, Anchor::Middle).bold()
    };
    // Across the line, not above it.
    let (sin, cos) = turned_deg.to_radians().sin_cos();
    svg.text([x - 5.0 * sin, y + 5.0 * cos], text, &font);
}

fn number(map: &ContourMap<'_>, level: f64) -> String {
    let decimals = map.decimals;
    format!("{level:.decimals$}")
}

/// The stretches of a ring that lie inside the disk, each long enough for a number.
fn runs_inside<'a>(ring: &'a [Point], plane: &Plane) -> impl Iterator<Item = &'a [Point]> {
    let ([x0, y0], radius) = (plane.pixel([0.0; 2]), plane.length(0.96));
    ring.split(move |&[x, y]| (x - x0).hypot(y - y0) > radius)
        .filter(|run| length_px(run) > LABELLED_PX)
}

fn length_px(run: &[Point]) -> f64 {
    (run.windows(2))
        .map(|pair| (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]))
        .sum()
}

/// Where on a line a number fits, nearest to the line's middle, and the line's direction there, deg, never upside down.
fn label_place(run: &[Point], taken: &[Point]) -> Option<(Point, f64)> {
    let free = |[x, y]: Point| {
        (taken.iter()).all(|other| (other[0] - x).hypot(other[1] - y) >= LABELS_APART_PX)
    };
    let middle = run.len() / 2;
    let mut order: Vec<usize> = (4..run.len().saturating_sub(4)).collect();
    order.sort_by_key(|index| index.abs_diff(middle));
    let index = order.into_iter().find(|&index| free(run[index]))?;
    let ([x1, y1], [x2, y2]) = (run[index - 4], run[index + 4]);
    let turned_deg = (y2 - y1).atan2(x2 - x1).to_degrees();
    let upright_deg = (turned_deg + 90.0).rem_euclid(180.0) - 90.0;
    Some((run[index], upright_deg))
}

/// The colours and what they mean, at the right.
fn draw_key(svg: &mut Svg, map: &ContourMap<'_>) {
    let fields = map.levels.len() + 1;
    let key = Rect {
        left: FRAME.right() + 36.0,
        width: 26.0,
        ..FRAME
    };
    let height = key.height / fields as f64;
    for index in 0..fields {
        let bottom = key.bottom() - height * index as f64;
        let field = Rect {
            top: bottom - height,
            height,
            ..key
        };
        svg.rect(
            &field,
            &fill(map, index),
            Some(&Stroke::new(colour::PANEL, 1.2)),
        );
        if let Some(&level) = map.levels.get(index) {
            let label = Font::new(15.0, colour::INK, Anchor::Start);
            svg.text(
                [key.right() + 10.0, bottom - height + 5.0],
                &number(map, level),
                &label,
            );
        }
    }
    let name = Font {
        turned_deg: -90.0,
        ..Font::new(16.0, colour::INK, Anchor::Middle)
    };
    svg.text(
        [key.right() + 76.0, key.top + key.height / 2.0],
        map.quantity,
        &name,
    );
    let note = Font::new(15.0, colour::FAINT, Anchor::End);
    let usable = map.geometry.usable_radius();
    let text = format!("dashed: usable disk, {usable:.2} track radii");
    svg.text([FRAME.right(), 70.0], &text, &note);
}

//! Views of the plane: the centre's way inside the usable disk, and the mechanism at one pose.

use kinematics::{Geometry, Guide, Inverse, Pose, inverse};

use drawing::colour;
use drawing::mechanism::SIZES;
use drawing::svg::{Anchor, Font, Point, Rect, Stroke, Svg};

/// The stage's plane, in track radii, laid on a square of the sheet.
pub(super) struct Plane {
    centre: Point,
    centre_px: Point,
    pixels_per_radius: f64,
}

impl Plane {
    /// The square of half the side `reach` about `centre`, track radii, filling `frame`.
    pub(super) fn new(frame: &Rect, centre: Point, reach: f64) -> Self {
        Self {
            centre,
            centre_px: [
                frame.left + frame.width / 2.0,
                frame.top + frame.height / 2.0,
            ],
            pixels_per_radius: frame.width.min(frame.height) / (2.0 * reach),
        }
    }

    pub(super) fn pixel(&self, [x, y]: Point) -> Point {
        [
            self.centre_px[0] + (x - self.centre[0]) * self.pixels_per_radius,
            self.centre_px[1] - (y - self.centre[1]) * self.pixels_per_radius,
        ]
    }

    pub(super) fn length(&self, radii: f64) -> f64 {
        radii * self.pixels_per_radius
    }
}

/// Track, usable disk and origin.
pub(super) fn draw_track(svg: &mut Svg, plane: &Plane, geometry: &Geometry) {
    let origin = plane.pixel([0.0; 2]);
    let rim = Stroke::new(colour::FAINT, 1.2).dashed();
    let disk = plane.length(geometry.usable_radius());
    svg.circle(origin, disk, colour::TINT, Some(&rim));
    let width = plane.length(SIZES.track_width).max(SIZES.track_least_px);
    let track = Stroke::new(colour::STEEL, width);
    svg.circle(origin, plane.length(1.0), "none", Some(&track));
    let cross = Stroke::new(colour::FAINT, 1.2);
    let [x, y] = origin;
    svg.line([x - 6.0, y], [x + 6.0, y], &cross);
    svg.line([x, y - 6.0], [x, y + 6.0], &cross);
}

/// The mechanism at a pose (mm, mm, deg), or a word in its place if the pose has no pivots.
pub(super) fn draw_mechanism(svg: &mut Svg, frame: &Rect, geometry: &Geometry, pose: [f64; 3]) {
    let [x_mm, y_mm, theta_deg] = pose;
    let pose = Pose {
        x: x_mm / geometry.radius_mm,
        y: y_mm / geometry.radius_mm,
        theta: theta_deg.to_radians(),
    };
    let Ok(solution) = inverse(&pose) else {
        let plane = Plane::new(frame, [0.0; 2], 1.15);
        draw_track(svg, &plane, geometry);
        return;
    };
    let centre = [pose.x, pose.y];
    let plane = fitting(frame, geometry, centre, &solution.guides);
    draw_track(svg, &plane, geometry);
    for (guide, colour) in solution.guides.iter().zip(colour::PIVOTS) {
        draw_guide(svg, &plane, geometry, centre, guide, colour);
    }
    draw_platform(svg, &plane, geometry, centre, &solution.guides);
    draw_orientation(svg, &plane, centre, pose.theta);
    draw_carriages(svg, &plane, &solution);
}

/// A plane that shows the track and the guides' ends.
fn fitting(frame: &Rect, geometry: &Geometry, centre: Point, guides: &[Guide<f64>; 3]) -> Plane {
    let end = geometry.guide_start + geometry.guide_length;
    let ends = guides.map(|guide| along(centre, &guide, end));
    let bounds = |axis: usize| {
        let low = ends.iter().fold(-1.0, |low: f64, end| low.min(end[axis]));
        let high = ends.iter().fold(1.0, |high: f64, end| high.max(end[axis]));
        ((low + high) / 2.0, (high - low) / 2.0)
    };
    let ((x, half_x), (y, half_y)) = (bounds(0), bounds(1));
    Plane::new(frame, [x, y], half_x.max(half_y) + 0.08)
}

/// The place at `rho` on a guide.
fn along([x, y]: Point, guide: &Guide<f64>, rho: f64) -> Point {
    [x + rho * guide.cos, y + rho * guide.sin]
}

/// The rail: its usable part in the pivot's colour, the rest thin.
fn draw_guide(
    svg: &mut Svg,
    plane: &Plane,
    geometry: &Geometry,
    centre: Point,
    guide: &Guide<f64>,
    colour: &str,
) {
    let end = geometry.guide_start + geometry.guide_length;
    let at = |rho: f64| plane.pixel(along(centre, guide, rho));
    let width = plane.length(SIZES.guide_width).max(SIZES.guide_least_px);
    svg.line(
        at(0.0),
        at(geometry.guide_start),
        &Stroke::new(colour::INK, width / 3.0),
    );
    let (start, end) = (at(geometry.guide_start), at(end));
    svg.line(start, end, &Stroke::new(colour, width));
    svg.line(
        start,
        end,
        &Stroke::new(colour::PANEL, width - SIZES.guide_walls_px),
    );
}

fn draw_platform(
    svg: &mut Svg,
    plane: &Plane,
    geometry: &Geometry,
    centre: Point,
    guides: &[Guide<f64>; 3],
) {
    let out = geometry.guide_start + SIZES.corner_beyond_start;
    let corners = guides.map(|guide| plane.pixel(along(centre, &guide, out)));
    let edge = Stroke::new(colour::INK, 2.0);
    svg.path(corners, true, colour::PLATFORM, Some(&edge));
}

/// An arrow along the platform's x' axis from the centre.
fn draw_orientation(svg: &mut Svg, plane: &Plane, centre: Point, theta_rad: f64) {
    let (sin, cos) = theta_rad.sin_cos();
    let at = |forward: f64, left: f64| {
        plane.pixel([
            centre[0] + forward * cos - left * sin,
            centre[1] + forward * sin + left * cos,
        ])
    };
    let shaft = Stroke::new(colour::THETA, 3.0);
    svg.line(at(0.0, 0.0), at(SIZES.arrow_shaft, 0.0), &shaft);
    let (back, half) = (SIZES.arrow_back, SIZES.arrow_half_width);
    let head = [at(SIZES.arrow_tip, 0.0), at(back, half), at(back, -half)];
    svg.path(head, true, colour::THETA, None);
    let name = Font {
        halo: Some(colour::TINT),
        ..Font::new(16.0, colour::THETA, Anchor::Middle).bold()
    };
    let [x, y] = at(SIZES.arrow_name, 0.0);
    svg.text([x, y + 5.0], "x\u{2032}", &name);
    let dot = Stroke::new(colour::PANEL, 1.5);
    let radius = plane.length(SIZES.centre_radius);
    let radius = radius.max(SIZES.centre_least_px);
    svg.circle(plane.pixel(centre), radius, colour::CENTRE, Some(&dot));
}

/// The carriages sit on the track, turned with their guides.
fn draw_carriages(svg: &mut Svg, plane: &Plane, solution: &Inverse<f64>) {
    let outline = Stroke::new(colour::PANEL, 2.0);
    for index in 0..3 {
        let (guide, angle) = (&solution.guides[index], solution.pivots[index]);
        let place = [angle.cos(), angle.sin()];
        let corner = |forward: f64, left: f64| {
            plane.pixel([
                place[0] + forward * guide.cos - left * guide.sin,
                place[1] + forward * guide.sin + left * guide.cos,
            ])
        };
        let (long, wide) = (SIZES.carriage_half_length, SIZES.carriage_half_width);
        let block = [
            corner(long, wide),
            corner(-long, wide),
            corner(-long, -wide),
            corner(long, -wide),
        ];
        svg.path(block, true, colour::PIVOTS[index], Some(&outline));
        let height = plane.length(SIZES.number_height);
        let height = height.max(SIZES.number_least_px);
        let number = Font::new(height, colour::ON_PIVOT, Anchor::Middle).bold();
        let [x, y] = plane.pixel(place);
        svg.text([x, y + 0.36 * height], &(index + 1).to_string(), &number);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn guides_are_drawn_where_the_kinematics_has_them() {
        let pose = Pose {
            x: 0.0,
            y: 0.0,
            theta: 0.0,
        };
        let solution = inverse(&pose).expect("the centre is in reach");
        for (guide, deg) in solution.guides.iter().zip(SIZES.guides_deg) {
            let (sin, cos) = deg.to_radians().sin_cos();
            let off = (guide.cos - cos).hypot(guide.sin - sin);
            assert!(off < 1e-12, "{deg} deg: {off}");
        }
    }
}

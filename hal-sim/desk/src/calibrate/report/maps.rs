//! Errors over disk and orientation: four disks beside each other, each for a quarter of all orientations.

use calibration::accuracy::{DISK, variances};
use calibration::frames::{Pair, without_frames};
use calibration::position::{pose, readings_rad};
use calibration::{DRAWN, Machine};
use drawing::colour;
use drawing::field::{Arrow, Field, Worth};
use drawing::svg::{Anchor, Font, Rect, Svg};
use kinematics::Geometry;
use std::f64::consts::TAU;

use super::super::told::{Seen, Told};
use super::{Found, Truth, sizes_of};

const RADIUS_MM: f64 = Geometry::REFERENCE.radius_mm;
const UM: f64 = RADIUS_MM * 1e3;
const URAD: f64 = 1e6;
/// Orientations of a picture.
const FIELDS: usize = 4;
/// Rings of places over the disk, and places on each.
const RINGS: [(f64, u32); 4] = [(0.0, 1), (0.35, 6), (0.68, 11), (1.0, 16)];

/// A row of four disks.
struct Row {
    title: String,
    names: [String; FIELDS],
    arrows: [Vec<Arrow>; FIELDS],
    is_spread: bool,
}

const WIDTH: f64 = 1220.0;
const FIELD_PX: f64 = 250.0;
const PITCH_PX: f64 = 262.0;
const LEFT_PX: f64 = 14.0;
const LEGEND_PX: f64 = LEFT_PX + PITCH_PX * FIELDS as f64 + 8.0;
const ROW_PX: f64 = 330.0;

fn picture(rows: &[Row]) -> String {
    let mut svg = Svg::new(WIDTH, ROW_PX * rows.len() as f64);
    for (row, place) in rows.iter().zip(0..) {
        let top = ROW_PX * f64::from(place);
        let title = Font::new(18.0, colour::INK, Anchor::Start).bold();
        svg.text([LEFT_PX, top + 28.0], &row.title, &title);
        let worth = Worth::of(row.arrows.iter().flatten(), "um", ("theta", "urad"));
        for ((arrows, name), index) in row.arrows.iter().zip(&row.names).zip(0..) {
            let frame = Rect {
                left: LEFT_PX + PITCH_PX * f64::from(index),
                top: top + 66.0,
                width: FIELD_PX,
                height: FIELD_PX,
            };
            let field = Field {
                frame,
                radius_mm: DISK * RADIUS_MM,
                worth: &worth,
            };
            if row.is_spread {
                field.draw_circles(&mut svg, name, arrows);
            } else {
                field.draw_arrows(&mut svg, name, arrows);
            }
            if index == 0 {
                field.draw_worth(&mut svg, [LEGEND_PX, top + 130.0], row.is_spread);
            }
        }
    }
    svg.finish()
}

/// Errors of pairs by the quarter of their orientation.
fn by_quarter(title: String, asked: &[[f64; 3]], errors: &[[f64; 3]]) -> Row {
    let mut arrows = [const { Vec::new() }; FIELDS];
    for (pose, error) in asked.iter().zip(errors) {
        let quarter = (pose[2].rem_euclid(TAU) / TAU * FIELDS as f64) as usize;
        arrows[quarter.min(FIELDS - 1)].push(arrow(pose, error));
    }
    let names = [0, 90, 180, 270].map(|from| format!("theta {from} to {} deg", from + 90));
    Row {
        title,
        names,
        arrows,
        is_spread: false,
    }
}

fn arrow(pose: &[f64; 3], error: &[f64; 3]) -> Arrow {
    Arrow {
        at: [pose[0] * RADIUS_MM, pose[1] * RADIUS_MM],
        off: [error[0] * UM, error[1] * UM],
        shade: error[2] * URAD,
    }
}

/// Errors of poses with the best frames and scale: x, y (track radii), theta (rad).
#[must_use]
pub fn errors(pairs: &[Pair]) -> Vec<[f64; 3]> {
    let left = without_frames(pairs);
    let turns = left.turns_rad.iter();
    let errors = left.places.iter().zip(turns);
    errors
        .map(|(place, turn)| [place.x, place.y, *turn])
        .collect()
}

/// True poses against commanded ones, without and with a calibration.
#[must_use]
pub fn before_and_after(truth: &Truth) -> String {
    let row = |what: &str, pairs: &[Pair]| {
        let asked: Vec<[f64; 3]> = pairs.iter().map(|pair| pair.asked).collect();
        let [um, urad] = sizes_of(pairs, RADIUS_MM);
        let title = format!("{what}: {} um and {} urad rms", figures(um), figures(urad));
        by_quarter(title, &asked, &errors(pairs))
    };
    picture(&[
        row("Before calibration", &truth.before),
        row("After", &truth.after),
    ])
}

/// Three figures of a number.
pub(super) fn figures(value: f64) -> String {
    let decimals = if value > 0.0 {
        (2.0 - value.log10().floor()).clamp(0.0, 6.0) as usize
    } else {
        0
    };
    format!("{value:.decimals$}")
}

/// Places over the disk at four orientations.
fn grid() -> impl Iterator<Item = [f64; 3]> {
    (0..FIELDS).flat_map(|field| {
        RINGS.iter().flat_map(move |&(share, count)| {
            (0..count).map(move |place| {
                let (sin, cos) = (TAU * f64::from(place) / f64::from(count)).sin_cos();
                let r = 0.97 * DISK * share;
                [r * cos, r * sin, TAU * field as f64 / FIELDS as f64]
            })
        })
    })
}

fn at_four(title: String, is_spread: bool, poses: &[[f64; 3]], errors: &[[f64; 3]]) -> Row {
    let mut row = by_quarter(title, poses, errors);
    row.names = [0, 90, 180, 270].map(|deg| format!("theta {deg} deg"));
    row.is_spread = is_spread;
    row
}

/// What a controller that believes the drawing makes of this machine.
pub(super) fn before(machine: &Machine) -> String {
    let pairs: Vec<Pair> = grid()
        .filter_map(|asked| {
            let reached = pose(machine, &readings_rad(&DRAWN, &asked).ok()?).ok()?;
            Some(Pair { asked, reached })
        })
        .collect();
    let [um, urad] = sizes_of(&pairs, RADIUS_MM);
    let title = format!(
        "As drawn: {} um and {} urad rms",
        figures(um),
        figures(urad)
    );
    let asked: Vec<[f64; 3]> = pairs.iter().map(|pair| pair.asked).collect();
    picture(&[at_four(title, false, &asked, &errors(&pairs))])
}

/// One standard deviation of what is left.
pub(super) fn expected(found: &Found) -> Option<String> {
    let poses: Vec<[f64; 3]> = grid().collect();
    let sizes = found.instrument.sizes();
    let variances = variances(&found.fit.machine, &found.fit.factor, &sizes, &poses)?;
    let errors: Vec<[f64; 3]> = (variances.iter())
        .map(|[place, turn]| [place.sqrt(), 0.0, turn.sqrt()])
        .collect();
    let title = "Expected after calibration, one standard deviation".to_owned();
    Some(picture(&[at_four(title, true, &poses, &errors)]))
}

/// What was seen at fresh poses.
pub(super) fn seen(told: &Told) -> String {
    let asked: Vec<[f64; 3]> = (told.poses.iter())
        .map(|seen| {
            let [x, y, deg] = seen.commanded_mm_deg;
            [x / RADIUS_MM, y / RADIUS_MM, deg.to_radians()]
        })
        .collect();
    let row = |title: &str, error: fn(&Seen) -> [f64; 3]| {
        let errors: Vec<[f64; 3]> = (told.poses.iter())
            .map(|seen| {
                let [x, y, turn] = error(seen);
                [x / UM, y / UM, turn / URAD]
            })
            .collect();
        by_quarter(title.to_owned(), &asked, &errors)
    };
    picture(&[
        row("Seen, without calibration", |seen| seen.as_drawn_um_urad),
        row("Seen, with it", |seen| seen.off_um_urad),
    ])
}

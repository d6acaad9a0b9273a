//! What the fit leaves: over visits, over harmonics of the rings, and over time.

use calibration::left::HARMONICS;
use calibration::table::Table;
use calibration::{Fit, Left};
use drawing::colour;
use drawing::page::figure;
use drawing::plane::{Axis, Curve, Plane};
use drawing::scale::{Steps, Ticks};
use drawing::svg::{Point, Rect, Svg};
use kinematics::Geometry;

use super::Found;
use crate::commission::Plot;

const NM: f64 = Geometry::REFERENCE.radius_mm * 1e6;
const URAD: f64 = 1e6;
const WIDTH: f64 = 1100.0;
const HEIGHT: f64 = 340.0;
const FRAME: Rect = Rect {
    left: 80.0,
    top: 60.0,
    width: 990.0,
    height: 220.0,
};

/// Places of one colour, and a name.
struct Set<'a> {
    name: &'a str,
    colour: &'a str,
    places: Vec<Point>,
}

/// Sets of places in a frame, with a line through each where there is one, and dashed limits.
fn dots(
    title: &str,
    x_name: &str,
    x: (f64, f64),
    sets: Vec<Set<'_>>,
    lines: &[[Point; 2]],
    marks: &[f64],
) -> String {
    let mut svg = Svg::new(WIDTH, HEIGHT);
    let values = (sets.iter()).flat_map(|set| set.places.iter().map(|place| place[1]));
    let range = (values.chain(marks.iter().copied()))
        .fold((0.0_f64, 0.0_f64), |(low, high), value| {
            (low.min(value), high.max(value))
        });
    let range = Ticks::covering(range, 4.0, Steps::Decimal).range;
    let named = sets.iter().map(|set| Curve {
        name: set.name,
        colour: set.colour,
        dashed: false,
        points: Vec::new(),
    });
    let drawn = lines.iter().zip(&sets).map(|(line, set)| Curve {
        name: "",
        colour: set.colour,
        dashed: true,
        points: line.to_vec(),
    });
    let curves: Vec<Curve<'_>> = named.chain(drawn).collect();
    let plane = Plane {
        title,
        x: Axis::Linear(x.0, x.1),
        y: Axis::Linear(range.0, range.1),
        x_name,
        curves: &curves,
        marks,
    };
    plane.draw(&mut svg, &FRAME);
    let dots: Vec<_> = sets
        .iter()
        .map(|set| (set.colour, set.places.clone()))
        .collect();
    plane.draw_dots(&mut svg, &FRAME, &dots);
    svg.finish()
}

/// x, y and theta as they are drawn: name, colour, unit.
const AXES: [(&str, &str, f64); 3] = [
    ("x", colour::X, NM),
    ("y", colour::Y, NM),
    ("theta", colour::THETA, URAD),
];

/// What is left of each visit, as figures of a page.
pub(super) fn visits(found: &Found) -> String {
    let plots = left_by_visit(&found.fit, &found.left);
    let figures = plots.iter().map(|plot| figure(&plot.svg, &plot.caption));
    figures.collect()
}

/// What a fit leaves of each visit: of x and y, and of theta, where they are seen.
#[must_use]
pub fn left_by_visit(fit: &Fit, left: &Left) -> Vec<Plot> {
    let misses = &left.visits;
    let sees = |axis: usize| misses.iter().any(|miss| miss.seen.contains(&axis));
    let set = |axis: usize| {
        let (name, colour, unit) = AXES[axis];
        let of_visit = |(visit, miss): (usize, &calibration::left::Miss)| {
            let is_left = miss.seen.contains(&axis) && !fit.outliers.contains(&visit);
            is_left.then(|| [visit as f64 + 1.0, miss.off[axis] * unit])
        };
        let places = misses.iter().enumerate().filter_map(of_visit).collect();
        Set {
            name,
            colour,
            places,
        }
    };
    let end = misses.len() as f64 + 1.0;
    let outliers = match &fit.outliers[..] {
        [] => "No visit was left out.".to_owned(),
        list => {
            let list: Vec<String> = list.iter().map(|visit| (visit + 1).to_string()).collect();
            format!(
                "Left out, as further off than any noise: {}.",
                list.join(", ")
            )
        }
    };
    let caption = "Seen less what the fitted machine says, visit by visit. It should be a band of even width around 0 without steps or \
         slopes: a step is a knock, a slope is drift, a band that widens an instrument that gets worse.";
    let mut plots = Vec::new();
    if sees(0) {
        let title = "What is left of x and y, nm";
        plots.push(Plot {
            svg: dots(title, "visit", (0.0, end), vec![set(0), set(1)], &[], &[]),
            caption: format!("{caption} {outliers}"),
        });
    }
    if sees(2) {
        let title = "What is left of theta, urad";
        plots.push(Plot {
            svg: dots(title, "visit", (0.0, end), vec![set(2)], &[], &[]),
            caption: format!("The same of theta. {outliers}"),
        });
    }
    plots
}

/// What is left at harmonics of each ring.
pub(super) fn harmonics(found: &Found) -> String {
    const NAMES: [&str; 3] = ["pivot 1", "pivot 2", "pivot 3"];
    let sets = (found.left.harmonics.iter().zip(0..3))
        .map(|(harmonics, pivot)| Set {
            name: NAMES[pivot],
            colour: colour::PIVOTS[pivot],
            places: (harmonics.iter().zip(1..))
                .map(|(harmonic, times)| {
                    let beside = 0.14 * (pivot as f64 - 1.0);
                    [f64::from(times) + beside, harmonic.size_rad * NM]
                })
                .collect(),
        })
        .collect();
    let all = || found.left.harmonics.iter().flatten();
    let noise = all().map(|harmonic| harmonic.noise_rad).fold(0.0, f64::max) * NM;
    let svg = dots(
        "What is left at each guide by harmonics of its ring's angle, nm on the track",
        "times a turn of the ring",
        (0.0, HARMONICS as f64 + 1.0),
        sets,
        &[],
        &[3.0 * noise],
    );
    figure(
        &svg,
        "Each dot is a wave that is left in the measurement, so many times a turn of a pivot's ring. The model has waves to 12; beyond there is what it \
         cannot hold. Dots below the dashed line (three times what noise makes) are noise; one far above it says that this ring has an error of its own there.",
    )
}

/// The reference pose over time.
pub(super) fn drift(table: &Table, found: &Found) -> String {
    let Some(drift) = found.drift else {
        return "<p>The reference pose was not visited often enough to tell.</p>\n".to_owned();
    };
    let start_s = table.references.first().map_or(0.0, |&(_, at_s)| at_s);
    let minutes = |at_s: f64| (at_s - start_s) / 60.0;
    let end = minutes(start_s + drift.seconds);
    let seen = |axis: usize| drift.noise[axis] > 0.0;
    let mut page = String::new();
    for (axes, unit) in [(&[0, 1][..], "nm"), (&[2][..], "urad")] {
        let axes: Vec<usize> = axes.iter().copied().filter(|&axis| seen(axis)).collect();
        if axes.is_empty() {
            continue;
        }
        let mut lines = Vec::new();
        let mut sets = Vec::new();
        for &axis in &axes {
            let (name, colour, factor) = AXES[axis];
            let places: Vec<Point> = (table.references.iter())
                .filter_map(|&(visit, at_s)| {
                    let miss = found.left.visits.get(visit)?;
                    Some([minutes(at_s), miss.off[axis] * factor])
                })
                .collect();
            let mean = places.iter().map(|place| place[1]).sum::<f64>() / places.len() as f64;
            let half = drift.moved[axis] * factor / 2.0;
            lines.push([[0.0, mean - half], [end, mean + half]]);
            sets.push(Set {
                name,
                colour,
                places,
            });
        }
        let title = format!("The reference pose while was measured, {unit}");
        let told: Vec<String> = (axes.iter())
            .map(|&axis| {
                let (name, _, factor) = AXES[axis];
                let [moved, noise] = [drift.moved, drift.noise].map(|all| all[axis] * factor);
                format!("{name} {moved:.1} {unit} (one standard deviation by noise: {noise:.1})")
            })
            .collect();
        let verdict = if drift.is_significant() {
            "That is more than the noise explains: the stage or the instrument was warming up; `tripivot calibrate apply` refuses such a calibration."
        } else {
            "That is no more than the noise explains."
        };
        page += &figure(
            &dots(&title, "minutes", (0.0, end.max(0.1)), sets, &lines, &[]),
            &format!(
                "The first pose, visited again every 20 poses; dashed the best straight line. From first to last it has moved by {}. {verdict}",
                told.join(", ")
            ),
        );
    }
    page
}

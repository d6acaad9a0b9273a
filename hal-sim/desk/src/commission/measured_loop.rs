//! A loop as it was measured at a spot, and what it is worth.

use super::bench::Bench;
use super::found::{CommissionError, Found, Plot, Table, fail};
use super::id;
use super::sines::{Excited, Recorded, Spot, excite};
use commissioning::chain::{Chain, Place};
use commissioning::closed_loop::{LoopLine, closed_loop};
use commissioning::drive_model::DriveModel;
use commissioning::record::Timing;
use commissioning::tuning::{Gains, MOST_MS, Plant, REJECTION_HZ, sensitivity, worst_direction};
use drawing::colour;
use drawing::plane::{Axis, Curve, Plane};
use drawing::svg::{Point, Rect, Svg};
use nalgebra::Complex;
use std::f64::consts::TAU;

/// Sets of lines.
const SETS: u32 = 2;

/// See the module.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredLoop {
    pub spot: Spot,
    /// Of the excitation.
    pub peak_v: f64,
    pub lines: Vec<LoopLine>,
}

/// Track radii for a spot.
pub fn place(spot: &Spot, radius_m: f64) -> Option<Place> {
    Place::new(spot.x_mm * 1e-3 / radius_m, spot.y_mm * 1e-3 / radius_m)
}

/// The same with the radius that the controller is told of.
pub fn place_of(bench: &mut Bench<'_>, spot: &Spot) -> Result<Place, CommissionError> {
    let radius_m = 1e-3 * bench.parameter(id::TRACK_RADIUS)?;
    place(spot, radius_m).map_or_else(
        || {
            fail(
                format!("{} is outside of the track", spot.words()),
                "the track's radius, a parameter, is too small",
            )
        },
        Ok,
    )
}

impl MeasuredLoop {
    /// Measures it.
    pub fn measure(
        bench: &mut Bench<'_>,
        spot: Spot,
        peak_v: f64,
        model: &DriveModel,
    ) -> Result<Self, CommissionError> {
        let place = place_of(bench, &spot)?;
        let excited = excite(bench, &spot, (SETS, peak_v), Recorded::Loop)?;
        Ok(Self::new(&excited, (spot, &place), model))
    }

    /// From what was recorded.
    pub fn new(excited: &Excited, (spot, place): (Spot, &Place), model: &DriveModel) -> Self {
        let lines = closed_loop(
            &excited.runs,
            &excited.lines,
            excited.peak_v,
            (&model.electrical, &model.mechanical.excited, place),
            &Timing::STAGE,
        );
        Self {
            spot,
            peak_v: excited.peak_v,
            lines,
        }
    }

    /// Largest singular value of the sensitivity over all lines.
    pub fn ms(&self) -> f64 {
        let sizes = self
            .lines
            .iter()
            .map(|line| worst_direction(&line.sensitivity));
        sizes.fold(0.0, f64::max)
    }

    /// The same at the line that is nearest to 30 Hz.
    pub fn rejection(&self) -> f64 {
        let far = |line: &&LoopLine| (line.hz / REJECTION_HZ).ln().abs();
        let nearest = self.lines.iter().min_by(|a, b| far(a).total_cmp(&far(b)));
        nearest.map_or(f64::NAN, |line| worst_direction(&line.sensitivity))
    }

    /// Highest line at which the loop of a pivot, with the others closed, has a gain of 1, of the slowest pivot, Hz.
    pub fn crossover_hz(&self) -> f64 {
        let of_pivot = |pivot: usize| {
            (self.lines.iter().rev())
                .find(|line| of_loop(line, pivot).norm() >= 1.0)
                .map_or(0.0, |line| line.hz)
        };
        [0, 1, 2]
            .map(of_pivot)
            .into_iter()
            .fold(f64::INFINITY, f64::min)
    }

    /// What it is worth, and the lines themselves.
    pub fn tell_numbers(&self, found: &mut Found) {
        let place = self.spot.words();
        found.number(format!("Ms {place}"), self.ms(), "");
        found.number(format!("S(30 Hz) {place}"), self.rejection(), "");
        found.number(format!("crossover {place}"), self.crossover_hz(), "Hz");
        found.tables.push(self.table());
    }

    /// Plant and sensitivity as rows: `i_k` is pivot i's answer to drive k.
    fn table(&self) -> Table {
        let mut csv = "frequency_hz".to_owned();
        let entries = || (1..=3).flat_map(|i| (1..=3).map(move |k| (i, k)));
        for (name, unit) in [("plant", "_rad_v"), ("sensitivity", "")] {
            for (i, k) in entries() {
                csv += &format!(",{name}_{i}_{k}_re{unit},{name}_{i}_{k}_im{unit}");
            }
        }
        csv += "\n";
        for line in &self.lines {
            csv += &format!("{}", line.hz);
            for matrix in [&line.plant, &line.sensitivity] {
                for (i, k) in entries() {
                    let value = matrix[(i - 1, k - 1)];
                    csv += &format!(",{},{}", value.re, value.im);
                }
            }
            csv += "\n";
        }
        Table {
            name: format!("loop-x{:.0}-y{:.0}", self.spot.x_mm, self.spot.y_mm),
            csv,
        }
    }

    /// The same plant with other gains.
    pub fn with(&self, gains: &Gains, chain: &Chain, radius_m: f64) -> Option<Self> {
        let said = sensitivity(&self.plant(chain, radius_m)?, gains);
        let lines = (self.lines.iter().zip(said))
            .map(|(line, sensitivity)| LoopLine {
                sensitivity,
                ..line.clone()
            })
            .collect();
        Some(Self { lines, ..*self })
    }

    /// How far the sensitivity is from what gains make of the plant that was measured with it, over its size: the median of the lines.
    pub fn distance(&self, gains: &Gains, chain: &Chain, radius_m: f64) -> Option<f64> {
        let said = self.with(gains, chain, radius_m)?;
        let mut off: Vec<f64> = (self.lines.iter().zip(said.lines))
            .map(|(line, said)| {
                (line.sensitivity - said.sensitivity).norm() / said.sensitivity.norm()
            })
            .collect();
        off.sort_by(f64::total_cmp);
        off.get(off.len() / 2).copied()
    }

    /// What the servos drive, as measured.
    pub fn plant(&self, chain: &Chain, radius_m: f64) -> Option<Plant> {
        let inertia = chain.inertia(&place(&self.spot, radius_m)?).diagonal();
        Some(Plant::from_lines(
            &self.lines,
            inertia.into(),
            &Timing::STAGE,
        ))
    }
}

/// Loop of a pivot with the others closed.
fn of_loop(line: &LoopLine, pivot: usize) -> Complex<f64> {
    1.0 / line.sensitivity[(pivot, pivot)] - 1.0
}

const SHEET: [f64; 2] = [1_000.0, 800.0];
const HZ: Axis = Axis::Logarithmic(25.0, 2_500.0);

/// Bode and Nyquist plots of a loop, with one that it had before.
pub fn plot(now: &MeasuredLoop, before: Option<&MeasuredLoop>) -> Plot {
    let also = before.map_or("", |_| "; dashed: before the gains were found");
    Plot {
        caption: format!(
            "The loop {}, as measured{also}. {}",
            now.spot.words(),
            read_so()
        ),
        svg: draw(now, before, ["now", "before"]),
    }
}

/// The same of a loop as other gains would make it, with the one that was measured.
pub fn plot_predicted(predicted: &MeasuredLoop, measured: &MeasuredLoop) -> Plot {
    Plot {
        caption: format!(
            "The loop {}, as these gains would make it; dashed: as measured with the gains in force. {}",
            predicted.spot.words(),
            read_so()
        ),
        svg: draw(
            predicted,
            Some(measured),
            ["with these gains", "as measured"],
        ),
    }
}

/// How the plots are read.
fn read_so() -> String {
    format!(
        "L of a pivot is with the others closed, 1/S - 1. The dashed circle: sensitivity {MOST_MS}; a locus that stays out of it keeps that margin."
    )
}

/// The four plots; names of the two in the legend.
fn draw(now: &MeasuredLoop, before: Option<&MeasuredLoop>, names: [&'static str; 2]) -> String {
    let mut svg = Svg::new(SHEET[0], SHEET[1]);
    let frame = |left: f64, top: f64, width: f64, height: f64| Rect {
        left,
        top,
        width,
        height,
    };
    draw_sensitivity(
        &mut svg,
        &frame(60.0, 50.0, 420.0, 285.0),
        [Some(now), before],
        names,
    );
    draw_gain(&mut svg, &frame(60.0, 440.0, 420.0, 300.0), now, before);
    draw_phase(&mut svg, &frame(545.0, 580.0, 420.0, 160.0), now, before);
    draw_nyquist(&mut svg, &frame(545.0, 50.0, 420.0, 420.0), now, before);
    svg.finish()
}

/// The curves of each pivot, now and before.
fn curves<'a>(
    now: &MeasuredLoop,
    before: Option<&MeasuredLoop>,
    of: impl Fn(&LoopLine, usize) -> Point,
) -> Vec<Curve<'a>> {
    let names = ["pivot 1", "pivot 2", "pivot 3"];
    let all = before.map(|before| (before, true));
    (all.into_iter().chain([(now, false)]))
        .flat_map(|(measured, dashed)| {
            let of = &of;
            (0..3).map(move |pivot| Curve {
                name: if dashed { "" } else { names[pivot] },
                colour: colour::PIVOTS[pivot],
                dashed,
                points: measured.lines.iter().map(|line| of(line, pivot)).collect(),
            })
        })
        .collect()
}

fn draw_sensitivity(
    svg: &mut Svg,
    frame: &Rect,
    loops: [Option<&MeasuredLoop>; 2],
    names: [&'static str; 2],
) {
    // The later one lies over the one before.
    let all: Vec<_> = (loops.into_iter().zip(names).zip([false, true]).rev())
        .filter_map(|((measured, name), dashed)| {
            Some(Curve {
                name,
                colour: colour::ACT,
                dashed,
                points: (measured?.lines.iter())
                    .map(|line| [line.hz, worst_direction(&line.sensitivity)])
                    .collect(),
            })
        })
        .collect();
    let plane = Plane {
        title: "sensitivity S, largest singular value",
        x: HZ,
        y: Axis::Logarithmic(0.02, 5.0),
        x_name: "frequency, Hz",
        curves: &all,
        marks: &[MOST_MS],
    };
    plane.draw(svg, frame);
}

fn draw_gain(svg: &mut Svg, frame: &Rect, now: &MeasuredLoop, before: Option<&MeasuredLoop>) {
    let all = curves(now, before, |line, pivot| {
        [line.hz, of_loop(line, pivot).norm()]
    });
    let plane = Plane {
        title: "loop L: gain",
        x: HZ,
        y: Axis::Logarithmic(0.02, 50.0),
        x_name: "frequency, Hz",
        curves: &all,
        marks: &[1.0],
    };
    plane.draw(svg, frame);
}

fn draw_phase(svg: &mut Svg, frame: &Rect, now: &MeasuredLoop, before: Option<&MeasuredLoop>) {
    // From 0 down to -360 deg: a loop that is stable is near -180 where its gain is 1.
    let all = curves(now, before, |line, pivot| {
        let degrees = of_loop(line, pivot).arg().to_degrees();
        [
            line.hz,
            if degrees > 0.0 {
                degrees - 360.0
            } else {
                degrees
            },
        ]
    });
    let plane = Plane {
        title: "loop L: phase, deg",
        x: HZ,
        y: Axis::Linear(-360.0, 0.0),
        x_name: "frequency, Hz",
        curves: &all,
        marks: &[-180.0],
    };
    plane.draw(svg, frame);
}

fn draw_nyquist(svg: &mut Svg, frame: &Rect, now: &MeasuredLoop, before: Option<&MeasuredLoop>) {
    let mut all = curves(now, before, |line, pivot| {
        let at = of_loop(line, pivot);
        [at.re, at.im]
    });
    let circle = (0..=90).map(|k| TAU * f64::from(k) / 90.0);
    all.push(Curve {
        name: "",
        colour: colour::INK,
        dashed: true,
        points: circle
            .map(|angle| [angle.cos() / MOST_MS - 1.0, angle.sin() / MOST_MS])
            .collect(),
    });
    let plane = Plane {
        title: "locus of L (Nyquist)",
        x: Axis::Linear(-3.0, 1.0),
        y: Axis::Linear(-3.0, 1.0),
        x_name: "real part; upwards: imaginary part",
        curves: &all,
        marks: &[],
    };
    plane.draw(svg, frame);
}

//! A verification as it is told, and kept for a report.

use calibration::Instrument;
use calibration::judge::Errors;
use kinematics::Geometry;
use serde::{Deserialize, Serialize};

use super::line::Line;
use super::verify::{Verdict, Verified};

const URAD: f64 = 1e6;

/// x and y, um, or theta, urad.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
pub struct Kind {
    /// Rms, noise in it.
    pub seen: f64,
    /// What noise and the machine's scatter alone would be.
    pub noise: f64,
    /// Without these: the stage's own.
    pub of_stage: f64,
    /// What is predicted of the stage's own.
    pub predicted: f64,
    /// Seen over what was to be seen, noise in both.
    pub ratio: f64,
    /// The largest.
    pub largest: f64,
    /// Where that was, from 1.
    pub largest_at_visit: usize,
    /// How far the errors of both sides are apart, rms.
    pub both_sides_apart: f64,
    /// Rms of the same visits without the calibration.
    pub as_drawn: f64,
}

/// One fresh pose.
#[derive(Clone, Copy, PartialEq, Debug, Serialize, Deserialize)]
pub struct Seen {
    /// Where the stage was sent.
    pub commanded_mm_deg: [f64; 3],
    /// What it was off: x, y (um) and theta (urad), 0 where that was not seen.
    pub off_um_urad: [f64; 3],
    /// The same without the calibration.
    pub as_drawn_um_urad: [f64; 3],
}

/// All of it.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
pub struct Told {
    /// The instrument.
    pub kit: String,
    /// Fresh poses, each twice.
    pub visits: usize,
    /// x and y, where they are seen.
    pub xy_um: Option<Kind>,
    /// theta, where it is seen.
    pub theta_urad: Option<Kind>,
    /// What of seen over predicted is as predicted.
    pub as_predicted: [f64; 2],
    /// The stage's scale over the instrument's, taken out, where the calibration does not know it.
    #[serde(default)]
    pub scale: Option<f64>,
    /// In words.
    pub verdict: String,
    /// The visits.
    pub poses: Vec<Seen>,
}

impl Told {
    /// What an instrument has seen.
    #[must_use]
    pub fn new(instrument: &Instrument, verified: &Verified) -> Self {
        let um = Geometry::REFERENCE.radius_mm * 1e3;
        let kind = |now: Option<Errors>, drawn: Option<Errors>, apart: f64, unit: f64| {
            let (now, drawn) = now.zip(drawn)?;
            Some(Kind {
                seen: now.seen * unit,
                noise: now.noise * unit,
                of_stage: now.of_stage() * unit,
                predicted: now.predicted_of_stage() * unit,
                ratio: now.ratio(),
                largest: now.largest * unit,
                largest_at_visit: now.at + 1,
                both_sides_apart: apart * unit,
                as_drawn: drawn.seen * unit,
            })
        };
        let Verified {
            now, drawn, sides, ..
        } = verified;
        let range = &verified.as_predicted;
        Self {
            kit: instrument.kit.name().to_owned(),
            visits: now.visits.len(),
            xy_um: kind(now.places, drawn.places, sides[0], um),
            theta_urad: kind(now.turns, drawn.turns, sides[1], URAD),
            as_predicted: [*range.start(), *range.end()],
            scale: verified.scale,
            verdict: match verified.verdict() {
                Verdict::Holds => "as predicted",
                Verdict::Better => "better than predicted",
                Verdict::Worse => "worse than predicted",
                Verdict::WorseThanDrawn => "worse than without it",
            }
            .to_owned(),
            poses: seen(verified),
        }
    }

    /// In words.
    #[must_use]
    pub fn lines(&self) -> Vec<Line> {
        let poses = self.visits / 2;
        let mut lines = vec![Line::new(
            "verified",
            format!("{}, {poses} fresh poses, each from both sides", self.kit),
        )];
        let kinds = [
            ("x and y", "um", &self.xy_um),
            ("theta", "urad", &self.theta_urad),
        ];
        for (what, unit, kind) in kinds {
            let Some(kind) = kind else { continue };
            let told = |more: &str, told: String| Line::new(format!("{what}{more}"), told);
            lines.push(told(
                "",
                format!(
                    "{:.4} {unit} rms seen, {:.4} of it noise and scatter: {}, {:.4} predicted",
                    kind.seen,
                    kind.noise,
                    if kind.of_stage > 0.0 {
                        format!("{:.4} of the stage", kind.of_stage)
                    } else {
                        "nothing of the stage to be seen".to_owned()
                    },
                    kind.predicted
                ),
            ));
            lines.push(told(
                ", over predicted",
                format!(
                    "{:.3}, noise in both; from {} to {} is as predicted",
                    kind.ratio, self.as_predicted[0], self.as_predicted[1]
                ),
            ));
            lines.push(told(
                ", largest",
                format!(
                    "{:.4} {unit}, on visit {}",
                    kind.largest, kind.largest_at_visit
                ),
            ));
            lines.push(told(
                ", both sides",
                format!(
                    "{:.4} {unit} rms apart, {:.4} by noise and scatter alone",
                    kind.both_sides_apart,
                    kind.noise * std::f64::consts::SQRT_2
                ),
            ));
            lines.push(told(
                ", as drawn",
                format!("{:.3} {unit} rms without it", kind.as_drawn),
            ));
        }
        if let Some(scale) = self.scale {
            let told =
                format!("{scale:.7} of the instrument's, taken out: the calibration knows none");
            lines.push(Line::new("scale", told));
        }
        let verdict = match &*self.verdict {
            "worse than predicted" | "worse than without it" => format!(
                "{}: another machine's, damaged, out of date, or the instrument is not what was said; `tripivot calibrate undo` takes it out of force",
                self.verdict
            ),
            "better than predicted" => {
                "better than predicted: the noise is less than was said".to_owned()
            }
            verdict => verdict.to_owned(),
        };
        let is_good = matches!(&*self.verdict, "as predicted" | "better than predicted");
        lines.push(Line::judged("verdict", verdict, is_good));
        lines
    }
}

fn seen(verified: &Verified) -> Vec<Seen> {
    let radius_mm = Geometry::REFERENCE.radius_mm;
    let off = |[x, y, theta]: [f64; 3]| [x * radius_mm * 1e3, y * radius_mm * 1e3, theta * URAD];
    let errors = verified.now.visits.iter().zip(&verified.drawn.visits);
    (verified.commanded.iter().zip(errors))
        .map(|(&[x, y, theta], (now, drawn))| Seen {
            commanded_mm_deg: [x * radius_mm, y * radius_mm, theta.to_degrees()],
            off_um_urad: off(now.off),
            as_drawn_um_urad: off(drawn.off),
        })
        .collect()
}

//! A verification as it is told, and kept for a report.

use calibration::Instrument;
use calibration::judge::Errors;
use kinematics::Geometry;
use serde::{Deserialize, Serialize};

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

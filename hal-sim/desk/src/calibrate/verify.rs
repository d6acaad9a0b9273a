//! A calibration that is in force is judged by fresh poses, each gone to from both sides: what the instrument sees there is the commanded
//! pose, but for what was predicted and for noise, or the calibration is not this machine's.

use calibration::accuracy::DISK;
use calibration::file::Calibration;
use calibration::plan::{Stop, stops};
use calibration::{DRAWN, FitError, Instrument, Judged, Kit, Predicted, Seen, Visit, judge};
use core::ops::RangeInclusive;
use kinematics::Geometry;

use super::apply::{ApplyError, checksum, in_force};
use super::measure::{APPROACH, MeasureError, Measured, Reader, Way, measure};
use crate::commission::Machine;
use crate::record::RecordError;

/// So many poses of the sequence are a plan's.
const PLANNED: usize = 10_000;
/// What may be seen over what was to be seen; and where the machine does not repeat, whose scatter is known less well than a noise.
const AS_PREDICTED: RangeInclusive<f64> = 0.77..=1.3;
const WITH_SCATTER: RangeInclusive<f64> = 0.7..=1.4;
/// How far a scale may be off that nobody knows; a step of it, and how many.
const ANY_SCALE: f64 = 0.1;
const SCALE_STEP: f64 = 1e-4;
const SCALE_STEPS: usize = 2;

/// Why nothing is verified.
#[derive(Debug, thiserror::Error)]
pub enum VerifyError {
    /// The controller.
    #[error(transparent)]
    Controller(#[from] RecordError),
    /// The file is none that a controller takes.
    #[error(transparent)]
    Calibration(#[from] ApplyError),
    /// Another is in force, or none.
    #[error(
        "this calibration is not in force: the controller has {has}; `tripivot calibrate apply` gives it one"
    )]
    NotInForce {
        /// What is there.
        has: &'static str,
    },
    /// Nobody reads where ends of guides are.
    #[error("ends of guides see no pose: verify with another kit")]
    Ends,
    /// The measurement.
    #[error(transparent)]
    Measure(#[from] MeasureError),
    /// What was measured.
    #[error(transparent)]
    Judge(#[from] FitError),
}

/// What has come of it.
#[derive(Clone, PartialEq, Debug)]
pub struct Verified {
    /// With the calibration.
    pub now: Judged,
    /// The same visits, had the controller taken the machine for the drawn one.
    pub drawn: Judged,
    /// Where the stage was sent: x, y (track radii), theta (rad).
    pub commanded: Vec<[f64; 3]>,
    /// How far the errors of both sides are apart, rms, noise in it: x and y (track radii), and theta (rad).
    pub sides: [f64; 2],
    /// What may be seen over what was to be seen.
    pub as_predicted: RangeInclusive<f64>,
    /// What the stage calls a length over what the instrument does, taken out: of a calibration that does not know it, by an instrument that sees it in each reading.
    pub scale: Option<f64>,
}

/// How it stands.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Verdict {
    /// As predicted.
    Holds,
    /// So much better that the prediction or the noise was not what it is.
    Better,
    /// Worse than predicted.
    Worse,
    /// Worse than without it.
    WorseThanDrawn,
}

impl Verified {
    /// How it stands.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        let (now, drawn) = (&self.now, &self.drawn);
        let kinds = [(now.places, drawn.places), (now.turns, drawn.turns)];
        let kinds = || kinds.into_iter().filter_map(|(now, drawn)| now.zip(drawn));
        if kinds().any(|(now, drawn)| !(now.seen <= drawn.seen)) {
            return Verdict::WorseThanDrawn;
        }
        if kinds().any(|(now, _)| !(now.ratio() <= *self.as_predicted.end())) {
            return Verdict::Worse;
        }
        if kinds().all(|(now, _)| now.ratio() >= *self.as_predicted.start()) {
            return Verdict::Holds;
        }
        Verdict::Better
    }
}

/// Poses that no plan has, each twice.
fn fresh(instrument: &Instrument, poses: usize) -> Vec<Stop> {
    let inside = |stop: &Stop| stop.pose[0].hypot(stop.pose[1]) < DISK - APPROACH;
    (stops(instrument, PLANNED, 2 * poses).into_iter())
        .filter(inside)
        .take(poses)
        .flat_map(|stop| [stop, stop])
        .collect()
}

/// Goes to fresh poses with the calibration in force, and judges what is seen there. `progress` is told how many visits have been made, and of
/// how many.
///
/// # Errors
/// [`VerifyError`].
pub fn verify(
    machine: &mut dyn Machine,
    reader: &mut dyn Reader,
    calibration: &Calibration,
    instrument: &Instrument,
    poses: usize,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Verified, VerifyError> {
    if instrument.kit == Kit::Ends {
        return Err(VerifyError::Ends);
    }
    let has = match in_force(machine)? {
        Some(there) if there == checksum(calibration)? => None,
        Some(_) => Some("another one"),
        None => Some("none"),
    };
    if let Some(has) = has {
        return Err(VerifyError::NotInForce { has });
    }
    let stops = fresh(instrument, poses);
    let way = Way {
        stops: &stops,
        first: 0,
        radius_mm: Geometry::REFERENCE.radius_mm,
        ends: &[],
        is_from_both_sides: true,
    };
    let mut all: Vec<Measured> = Vec::new();
    measure(machine, reader, &way, &mut |measured| {
        all.push(*measured);
        progress(all.len(), stops.len());
        Ok(())
    })?;
    let commanded: Result<Vec<Visit>, _> = (all.iter().enumerate())
        .map(|(visit, measured)| {
            Visit::commanded(&measured.commanded, measured.visited.seen).map_err(|_| {
                let reason = "it was commanded where no pivot reaches its guide";
                FitError::Visit { visit, reason }
            })
        })
        .collect();
    let read: Vec<Visit> = all.iter().map(|measured| measured.visited).collect();
    let radius_nm = calibration.made.track_radius_mm * 1e6;
    let predicted = Predicted {
        place: calibration.made.expected_xy_nm / radius_nm,
        turn_rad: calibration.made.expected_theta_urad * 1e-6,
    };
    let scale_is_known = calibration.made.kit != Kit::Ends;
    let judged = |visits: &[Visit]| {
        if scale_is_known {
            return Ok((None, judge(instrument, &DRAWN, visits, &predicted)?));
        }
        without_scale(instrument, visits, &predicted)
    };
    let (scale, now) = judged(&commanded?)?;
    let (_, drawn) = judged(&read)?;
    Ok(Verified {
        commanded: all.iter().map(|measured| measured.commanded).collect(),
        sides: apart(&now),
        as_predicted: if calibration.made.scatter_nm > 0.0 {
            WITH_SCATTER
        } else {
            AS_PREDICTED
        },
        now,
        drawn,
        scale,
    })
}

/// Judged with the scale that fits best: ends of guides are angles, and tell of no length.
fn without_scale(
    instrument: &Instrument,
    visits: &[Visit],
    predicted: &Predicted,
) -> Result<(Option<f64>, Judged), FitError> {
    if !matches!(instrument.kit, Kit::Xyt | Kit::Xy) {
        // Cameras find it with their marks; theta has none.
        let free = Instrument {
            scale: ANY_SCALE,
            ..instrument.clone()
        };
        return Ok((None, judge(&free, &DRAWN, visits, predicted)?));
    }
    let judged = |by: f64| {
        let scaled: Vec<Visit> = visits.iter().map(|visit| scaled(visit, by)).collect();
        judge(instrument, &DRAWN, &scaled, predicted)
    };
    // Misses are straight in the scale, so their squares are a parabola.
    let mut by = 0.0;
    for _ in 0..SCALE_STEPS {
        let [less, now, more] =
            [by - SCALE_STEP, by, by + SCALE_STEP].map(|by| Ok::<f64, FitError>(judged(by)?.chi2));
        let (less, now, more) = (less?, now?, more?);
        by -= SCALE_STEP * (more - less) / (2.0 * (more - 2.0 * now + less));
    }
    Ok((Some(1.0 + by), judged(by)?))
}

/// What would have been seen with a scale that is larger by a share.
fn scaled(visit: &Visit, by: f64) -> Visit {
    let scaled = |place: f64| place * (1.0 + by);
    let seen = match visit.seen {
        Seen::Pose([x, y, theta]) => Seen::Pose([scaled(x), scaled(y), theta]),
        Seen::Place(place) => Seen::Place(place.map(scaled)),
        other => other,
    };
    Visit { seen, ..*visit }
}

/// How far the errors of visits that follow each other are apart.
fn apart(judged: &Judged) -> [f64; 2] {
    let (mut place, mut turn, mut count) = (0.0, 0.0, 0.0);
    for [one, other] in judged.visits.as_chunks::<2>().0 {
        let [x, y, theta] = [0, 1, 2].map(|k| one.off[k] - other.off[k]);
        place += x * x + y * y;
        turn += theta * theta;
        count += 1.0;
    }
    [place, turn].map(|square: f64| (square / count).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibration::Noise;
    use calibration::spread::over_disk;

    /// Poses as an instrument sees them whose lengths are another's.
    fn seen(kit: Kit, scale: f64) -> (Instrument, Vec<Visit>) {
        let noise = Noise {
            length: 5e-7,
            angle_rad: 1e-6,
            encoder_rad: Noise::ENCODER_RAD,
        };
        let visits = over_disk(DISK).take(60).map(|pose| {
            let [x, y, theta] = pose;
            let [x, y] = [x, y].map(|place| place / scale);
            let seen = match kit {
                Kit::Xyt => Seen::Pose([x, y, theta]),
                _ => Seen::Place([x, y]),
            };
            Visit::commanded(&pose, seen).expect("in reach")
        });
        (Instrument::new(kit, noise), visits.collect())
    }

    #[test]
    fn a_scale_that_nobody_knows_is_taken_out_and_told() -> Result<(), FitError> {
        for kit in [Kit::Xyt, Kit::Xy] {
            let (instrument, visits) = seen(kit, 1.0003);
            let predicted = Predicted::default();
            let known = judge(&instrument, &DRAWN, &visits, &predicted)?;
            let (scale, judged) = without_scale(&instrument, &visits, &predicted)?;
            println!(
                "{kit}: {scale:?}, {:e} beside {:e}",
                judged.chi2, known.chi2
            );
            assert!(known.chi2 > 1e3 && judged.chi2 < 1e-6);
            assert!(scale.is_some_and(|scale| (scale - 1.0003).abs() < 1e-9));
        }
        Ok(())
    }
}

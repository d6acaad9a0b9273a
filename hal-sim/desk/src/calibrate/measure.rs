//! A plan is driven, and an instrument read at each of its poses while the encoders are recorded.
//!
//! A camera is a null detector: the stage brings the mark under its cross-hair before the reading counts, so the camera's own scale, turn
//! and distortion do not.

use calibration::plan::{At, Stop};
use calibration::{Seen, Visit};

use crate::commission::{Bench, CommissionError, Machine};
use crate::record::RecordError;

/// Rows between two visits of the reference pose.
const REFERENCE_EVERY: usize = 20;
/// Ticks over which the encoders are averaged.
const TICKS: usize = 128;
/// Longest move, s.
const LONGEST_S: f64 = 30.0;
/// A mark that is so near the cross-hair is under it, track radii; and how often the stage may try.
const UNDER: f64 = 1e-5;
const MOST_LOOKS: usize = 8;
/// Measured angles of the three pivots, as `DRC` takes them.
const READINGS: [&str; 3] = ["1 2", "2 2", "3 2"];

/// A reading that is wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted {
    /// Place in the measurement, from 0.
    pub visit: usize,
    /// What is to be looked at.
    pub at: At,
    /// Where the stage was sent: x, y (track radii), theta (rad).
    pub pose: [f64; 3],
}

/// What reads the instrument.
pub trait Reader {
    /// Reads it.
    ///
    /// # Errors
    /// Why there is no reading.
    fn read(&mut self, wanted: &Wanted) -> Result<Seen, String>;
}

/// Why a measurement has ended early.
#[derive(Debug, thiserror::Error)]
pub enum MeasureError {
    /// The controller.
    #[error(transparent)]
    Controller(#[from] RecordError),
    /// The stage.
    #[error("{0}")]
    Stage(String),
    /// The instrument.
    #[error("pose {}: {reason}", .visit + 1)]
    Reading {
        /// Which, from 0.
        visit: usize,
        /// Why.
        reason: String,
    },
    /// The stage does not bring a mark under the camera.
    #[error(
        "pose {}: the mark is still {off_um:.1} um off the cross-hair after {MOST_LOOKS} looks: are the camera's axes those of the stage?",
        .visit + 1
    )]
    NotUnder {
        /// Which, from 0.
        visit: usize,
        /// How far it is off.
        off_um: f64,
    },
    /// What was measured cannot be kept.
    #[error("{0}")]
    Unwritten(#[from] std::io::Error),
}

impl From<CommissionError> for MeasureError {
    fn from(error: CommissionError) -> Self {
        match error {
            CommissionError::Controller(error) => Self::Controller(error),
            CommissionError::Failed(failure) => Self::Stage(failure.what),
        }
    }
}

/// Stops with the first of them visited again at intervals and at the end: what drifts shows there.
#[must_use]
pub fn with_references(stops: &[Stop]) -> Vec<Stop> {
    let mut all = Vec::new();
    for some in stops.chunks(REFERENCE_EVERY) {
        all.extend_from_slice(some);
        all.extend(stops.first());
    }
    all
}

/// The serial number of the controller.
///
/// # Errors
/// When it does not answer.
pub fn serial(machine: &mut dyn Machine) -> Result<String, RecordError> {
    Ok(machine.ask("SSN?")?.unwrap_or_default().trim().to_owned())
}

/// Visits the stops from `first` on, and has each visit kept, with the controller's clock in s, as it is made.
///
/// # Errors
/// [`MeasureError`]: those before it are kept. The stage holds where it is.
pub fn measure(
    machine: &mut dyn Machine,
    reader: &mut dyn Reader,
    stops: &[Stop],
    first: usize,
    radius_mm: f64,
    keep: &mut dyn FnMut(usize, &Visit, f64) -> Result<(), std::io::Error>,
) -> Result<(), MeasureError> {
    let mut stage = Stage {
        bench: Bench::new(machine)?,
        radius_mm,
    };
    stage.bench.hold()?;
    for (visit, stop) in stops.iter().enumerate().skip(first) {
        let seen = stage.seen(reader, visit, stop)?;
        let visited = Visit {
            readings_rad: stage.readings_rad()?,
            seen,
        };
        let clock_s = stage.bench.clock_s()?;
        keep(visit, &visited, clock_s)?;
    }
    Ok(())
}

struct Stage<'a> {
    bench: Bench<'a>,
    radius_mm: f64,
}

impl Stage<'_> {
    /// Goes there, and reads; over and over for a mark, until it is under the camera.
    fn seen(
        &mut self,
        reader: &mut dyn Reader,
        visit: usize,
        stop: &Stop,
    ) -> Result<Seen, MeasureError> {
        let Stop { mut pose, at } = *stop;
        let mut off_um = 0.0;
        for _ in 0..MOST_LOOKS {
            self.go(&pose)?;
            let wanted = Wanted { visit, at, pose };
            let seen =
                (reader.read(&wanted)).map_err(|reason| MeasureError::Reading { visit, reason })?;
            let Seen::Mark { off: [x, y], .. } = seen else {
                return Ok(seen);
            };
            if x.hypot(y) < UNDER {
                return Ok(seen);
            }
            off_um = x.hypot(y) * self.radius_mm * 1e3;
            pose[0] -= x;
            pose[1] -= y;
        }
        Err(MeasureError::NotUnder { visit, off_um })
    }

    fn go(&mut self, [x, y, theta_rad]: &[f64; 3]) -> Result<(), MeasureError> {
        let [x_mm, y_mm] = [x, y].map(|place| place * self.radius_mm);
        let theta_deg = theta_rad.to_degrees();
        let line = format!("MOV X {x_mm:.9} Y {y_mm:.9} W {theta_deg:.9}");
        self.bench.ask(&line)?;
        Ok(self.bench.wait_for_target(LONGEST_S)?)
    }

    /// What the encoders read, as the mean of some ticks.
    fn readings_rad(&mut self) -> Result<[f64; 3], MeasureError> {
        let record = (self.bench).record_tables(&READINGS.map(str::to_owned), TICKS, 1, None)?;
        let count = record.rows.len() as f64;
        Ok([0, 1, 2].map(|pivot| {
            let sum_deg: f64 = record.rows.iter().map(|row| row[pivot]).sum();
            (sum_deg / count).to_radians()
        }))
    }
}

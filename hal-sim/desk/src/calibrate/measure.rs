//! A plan is driven, and an instrument read at each of its poses while the encoders are recorded.
//!
//! A camera is a null detector: the stage brings the mark under its cross-hair before the reading counts, so the camera's own scale, turn
//! and distortion do not. Ends of guides need no instrument: rings are driven against them, one at a time, with the servo off.

use calibration::accuracy::DISK;
use calibration::contact::{Pressed, approach as approach_end, contact};
use calibration::plan::{At, Stop};
use calibration::{Seen, Visit};

use crate::commission::{
    Aside, Bench, CommissionError, EXCITATION_LIMITS, GUIDE_STIFFNESS, Machine, Touch,
};
use crate::record::RecordError;

/// Rows between two visits of the reference pose.
const REFERENCE_EVERY: usize = 20;
/// Ticks over which the encoders are averaged.
const TICKS: usize = 128;
/// Longest move, s.
const LONGEST_S: f64 = 30.0;
/// A mark that is so near the cross-hair is under it, track radii; and how often the stage may try.
const UNDER: f64 = 1e-5;
/// How far away a move begins that is to come from one side, track radii and rad: further than guides lose of a motion.
pub(super) const APPROACH: f64 = 0.01;
/// Between the directions of two approaches, rad: the golden angle spreads them.
const APPROACH_STEP_RAD: f64 = 2.399_963;
const MOST_LOOKS: usize = 8;
/// So much further than it is drawn an end is looked for, mrad.
const FURTHER_MRAD: f64 = 60.0;
/// Until a stage that was let go is at rest, s.
const LET_GO_S: f64 = 0.3;
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

/// Where to go.
#[derive(Clone, Copy, Debug)]
pub struct Way<'a> {
    /// The stops.
    pub stops: &'a [Stop],
    /// The first that is gone to.
    pub first: usize,
    /// Radius of the track, mm.
    pub radius_mm: f64,
    /// Ends of guides, for stops at one: which guide, and where on it.
    pub ends: &'a [(usize, f64)],
    /// Whether the stops come in pairs, which are gone to from opposite sides.
    pub is_from_both_sides: bool,
}

/// What was measured at a stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Which, from 0.
    pub visit: usize,
    /// What the encoders read, and what was seen.
    pub visited: Visit,
    /// Where the stage was sent: x, y (track radii), theta (rad).
    pub commanded: [f64; 3],
    /// The controller's clock, s.
    pub clock_s: f64,
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

/// Visits stops, and has each visit kept as it is made.
///
/// # Errors
/// [`MeasureError`]: those before it are kept. The stage holds where it is; after ends were touched the motors are off.
pub fn measure(
    machine: &mut dyn Machine,
    reader: &mut dyn Reader,
    way: &Way<'_>,
    keep: &mut dyn FnMut(&Measured) -> Result<(), std::io::Error>,
) -> Result<(), MeasureError> {
    let mut stage = Stage {
        bench: Bench::in_base_frame(machine)?,
        radius_mm: way.radius_mm,
    };
    if let Err(error) = stage.bench.hold() {
        return Err(match stage.bench.fault()? {
            fault if fault.is_empty() => error.into(),
            fault => MeasureError::Stage(format!("the stage does not hold{fault}")),
        });
    }
    // Made up for, how guides give way is in what the encoders read, and in no pose: a fit would take it for scatter.
    let give = Aside::set(&mut stage.bench, &[(GUIDE_STIFFNESS, 0.0)])?;
    let visited = visits_or_touches(&mut stage, reader, way, keep);
    let given_back = give.give_back(&mut stage.bench);
    visited.and(given_back.map_err(MeasureError::from))
}

fn visits_or_touches(
    stage: &mut Stage<'_>,
    reader: &mut dyn Reader,
    way: &Way<'_>,
    keep: &mut dyn FnMut(&Measured) -> Result<(), std::io::Error>,
) -> Result<(), MeasureError> {
    let touches = way
        .stops
        .iter()
        .any(|stop| matches!(stop.at, At::End { .. }));
    let before = match touches {
        true => Some(widened(&mut stage.bench)?),
        false => None,
    };
    let visited = visits(stage, reader, way, keep);
    if let Some(before) = before {
        let given_back = stage
            .let_go()
            .and_then(|()| Ok(before.give_back(&mut stage.bench)?));
        return visited.and(given_back);
    }
    visited
}

/// Limits of excitations as rings need them that go against ends. The servo is off then, and on again with the first visit.
fn widened(bench: &mut Bench<'_>) -> Result<Aside, MeasureError> {
    bench.ask("CCL 1 ADVANCED")?;
    bench.ask("SVO X 0")?;
    bench.delay(LET_GO_S)?;
    let before = Aside::set(bench, &EXCITATION_LIMITS)?;
    bench.hold()?;
    Ok(before)
}

fn visits(
    stage: &mut Stage<'_>,
    reader: &mut dyn Reader,
    way: &Way<'_>,
    keep: &mut dyn FnMut(&Measured) -> Result<(), std::io::Error>,
) -> Result<(), MeasureError> {
    for (visit, stop) in way.stops.iter().enumerate().skip(way.first) {
        let (visited, commanded) = if let At::End { end } = stop.at {
            let touched = stage.touched(visit, stop, end, way.ends)?;
            (touched, stop.pose)
        } else {
            let (seen, commanded) = stage.seen(reader, visit, stop, way.is_from_both_sides)?;
            let readings_rad = stage.readings_rad()?;
            (Visit { readings_rad, seen }, commanded)
        };
        keep(&Measured {
            visit,
            visited,
            commanded,
            clock_s: stage.bench.clock_s()?,
        })?;
    }
    Ok(())
}

/// From where a stop is gone to, beside it; of a pair the second from the side opposite to the first's.
fn approach(visit: usize) -> [f64; 3] {
    let side = if visit.is_multiple_of(2) { 1.0 } else { -1.0 };
    let (sin, cos) = ((visit / 2) as f64 * APPROACH_STEP_RAD).sin_cos();
    [cos, sin, 1.0].map(|part| side * APPROACH * part)
}

/// A pose beside another: on the other side, where that one is out of the disk.
fn beside(pose: &[f64; 3], from: &[f64; 3]) -> [f64; 3] {
    let there = [0, 1, 2].map(|k| pose[k] + from[k]);
    if there[0].hypot(there[1]) < DISK {
        return there;
    }
    [0, 1, 2].map(|k| pose[k] - from[k])
}

struct Stage<'a> {
    bench: Bench<'a>,
    radius_mm: f64,
}

impl Stage<'_> {
    /// Goes there, and reads; over and over for a mark, until it is under the camera. Also where that has sent it.
    fn seen(
        &mut self,
        reader: &mut dyn Reader,
        visit: usize,
        stop: &Stop,
        is_approached: bool,
    ) -> Result<(Seen, [f64; 3]), MeasureError> {
        let Stop { mut pose, at } = *stop;
        let mut off_um = 0.0;
        let from = approach(visit);
        for look in 0..MOST_LOOKS {
            // A short correction would leave guides with what they have lost of the motion before it, and their scatter unseen.
            if is_approached || look > 0 {
                self.go(&beside(&pose, &from))?;
            }
            self.go(&pose)?;
            let wanted = Wanted { visit, at, pose };
            let seen =
                (reader.read(&wanted)).map_err(|reason| MeasureError::Reading { visit, reason })?;
            let Seen::Mark { off: [x, y], .. } = seen else {
                return Ok((seen, pose));
            };
            if x.hypot(y) < UNDER {
                return Ok((seen, pose));
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

    /// Goes to where one ring alone brings a pivot to an end of its guide, has that done with the servo off, and comes back.
    fn touched(
        &mut self,
        visit: usize,
        stop: &Stop,
        end: usize,
        ends: &[(usize, f64)],
    ) -> Result<Visit, MeasureError> {
        let failed = |reason: String| MeasureError::Reading { visit, reason };
        let way = approach_end(&stop.pose)
            .ok_or_else(|| failed("no ring alone comes to this end".to_owned()))?;
        let &(guide, drawn) = ends
            .get(end)
            .ok_or_else(|| failed("there is no such end".to_owned()))?;
        self.go(&way.from)?;
        self.let_go()?;
        let touch = Touch {
            ring: way.ring,
            sign: way.by_rad.signum(),
        };
        let within_mrad = way.by_rad.abs() * 1e3 + FURTHER_MRAD;
        let signals = touch.recorded(&mut self.bench, within_mrad)?;
        Touch::go(&mut self.bench, way.ring, -way.by_rad)?;
        self.bench.hold()?;
        let rows: Vec<Pressed> = (0..signals[0].angle_rad.len())
            .map(|row| Pressed {
                readings_rad: signals.each_ref().map(|pivot| pivot.angle_rad[row]),
                current_a: touch.sign * signals[way.ring].current_a[row],
            })
            .collect();
        let side = usize::from(drawn > 1.0);
        let readings_rad =
            contact(&rows, (guide, side), way.ring).map_err(|error| failed(error.to_string()))?;
        Ok(Visit {
            readings_rad,
            seen: Seen::End { end },
        })
    }

    /// Motors off.
    fn let_go(&mut self) -> Result<(), MeasureError> {
        self.bench.ask("SVO X 0")?;
        Ok(self.bench.delay(LET_GO_S)?)
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

//! A calibration is sent to the controller it was made for: all of it, or nothing; and only where it explains what was measured no worse
//! than what is in force, was fitted so that it holds at poses that were held out, and nothing has moved meanwhile.

use calibration::file::{Calibration, Made};
use calibration::{DRAWN, Drift, FitError, Instrument, Judged, Predicted, Visit, judge};
use firmware::calibration::{CalibrationText, MachineCalibration};
use kinematics::Geometry;
use std::fmt::Write;

use super::measure::serial;
use crate::commission::Machine;
use crate::record::RecordError;
use crate::record::desk::strange;

/// Numbers in a line.
const LINE_NUMBERS: usize = 8;
/// What level the controller wants, and its word for it.
const LEVEL: &str = "CCL 1 ADVANCED";

/// Why a calibration is not sent.
#[derive(Debug, thiserror::Error)]
pub enum ApplyError {
    /// The controller.
    #[error(transparent)]
    Controller(#[from] RecordError),
    /// It is of another machine.
    #[error("the calibration is of machine '{of}', and this one is '{here}'")]
    AnotherMachine {
        /// Whose it is.
        of: String,
        /// What the controller says.
        here: String,
    },
    /// It was fitted to a machine of another size.
    #[error("the calibration is for a track radius of {of_mm} mm, and this one has {here_mm} mm")]
    AnotherSize {
        /// What it is for.
        of_mm: f64,
        /// What this is.
        here_mm: f64,
    },
    /// A text is longer than the controller keeps, empty, or of several words.
    #[error("the calibration's {what} '{text}' is no word of at most 32 characters")]
    Word {
        /// What it is.
        what: &'static str,
        /// How it reads.
        text: String,
    },
    /// No controller takes it.
    #[error(
        "the calibration moves a pivot further than a controller corrects: is an encoder's zero not the one it was measured with?"
    )]
    BeyondLimits,
    /// Nothing tells what the calibration that is there is worth.
    #[error(
        "another calibration is in force: name its file with --over, or take it out of force with `tripivot calibrate undo`"
    )]
    Unknown,
    /// What is there explains the measurement better.
    #[error(
        "this calibration leaves {} of what was measured, and what is in force {}: it is not applied",
        left(.new), left(.old)
    )]
    Worse {
        /// With it.
        new: Box<Judged>,
        /// With what is in force.
        old: Box<Judged>,
    },
    /// The fit does not hold at poses that were held out of it.
    #[error(
        "poses that were held out of its fit miss by {:.2} times what is expected of them (square, a row), and chance brings no more than {most:.2}: \
         measure at more poses, or with less noise", .found
    )]
    HeldOut {
        /// Square misses over what is expected of them.
        found: f64,
        /// What chance brings.
        most: f64,
    },
    /// Something has moved while was measured.
    #[error(
        "the reference pose has moved by {} in the {:.0} minutes of the measurement, with {} by noise: the stage or the instrument was warming up; \
         measure again when it is warm",
        moved(&.0.moved), .0.seconds / 60.0, moved(&.0.noise)
    )]
    Drift(Box<Drift>),
    /// The measurement.
    #[error("the measurement: {0}")]
    Measurement(#[from] FitError),
}

/// x, y and theta in words.
fn moved([x, y, theta]: &[f64; 3]) -> String {
    let nm = Geometry::REFERENCE.radius_mm * 1e6;
    let (x, y, theta) = (x * nm, y * nm, theta * 1e6);
    format!("{x:.0} nm, {y:.0} nm, {theta:.2} urad")
}

/// What a calibration is judged by before it is applied.
#[derive(Clone, Debug)]
pub struct Evidence {
    /// What has measured.
    pub instrument: Instrument,
    /// What was measured.
    pub visits: Vec<Visit>,
    /// Visits of the reference pose, and when they were made, s.
    pub references: Vec<(usize, f64)>,
    /// What is said to be in force.
    pub over: Option<Calibration>,
}

/// What is left, in words.
fn left(judged: &Judged) -> String {
    let um = Geometry::REFERENCE.radius_mm * 1e3;
    let places = (judged.places).map(|errors| format!("{:.3} um", errors.seen * um));
    let turns = (judged.turns).map(|errors| format!("{:.3} urad", errors.seen * 1e6));
    let words: Vec<String> = places.into_iter().chain(turns).collect();
    words.join(" and ") + " rms"
}

/// Checksum of the calibration that is in force.
///
/// # Errors
/// When the controller does not answer as it should.
pub(super) fn in_force(machine: &mut dyn Machine) -> Result<Option<u32>, RecordError> {
    let told = machine.ask("CAL?")?.unwrap_or_default();
    let value = |key: &str| told.lines().find_map(|line| line.trim().strip_prefix(key));
    match value("STATE=") {
        Some("ON") => {
            let checksum = value("CHECKSUM=").and_then(|text| text.parse().ok());
            checksum.map(Some).ok_or_else(|| strange("CAL?", &told))
        }
        Some("OFF" | "NONE") => Ok(None),
        _ => Err(strange("CAL?", &told)),
    }
}

/// The checksum that a controller tells of a calibration.
///
/// # Errors
/// [`ApplyError::Word`].
pub(super) fn checksum(calibration: &Calibration) -> Result<u32, ApplyError> {
    Ok(for_controller(calibration)?.checksum())
}

/// Refuses a calibration that leaves more of what was measured than what is in force.
fn no_worse(
    machine: &mut dyn Machine,
    calibration: &Calibration,
    evidence: &Evidence,
) -> Result<Judged, ApplyError> {
    let there = in_force(machine)?;
    let mut old = DRAWN;
    if let Some(there) = there {
        let known = evidence.over.iter().chain([calibration]);
        let known = known.map(|known| Ok((checksum(known)?, known)));
        let known: Vec<(u32, &Calibration)> = known.collect::<Result<_, ApplyError>>()?;
        let found = known.iter().find(|(checksum, _)| *checksum == there);
        old = found.ok_or(ApplyError::Unknown)?.1.machine();
    }
    let of = |machine| {
        let Evidence {
            instrument, visits, ..
        } = evidence;
        judge(instrument, machine, visits, &Predicted::default()).map(Box::new)
    };
    let (new, old) = (of(&calibration.machine())?, of(&old)?);
    if new.chi2 <= old.chi2 {
        return Ok(*new);
    }
    Err(ApplyError::Worse { new, old })
}

/// Refuses one whose fit did not hold where it was not made, and a measurement in which something has moved.
fn is_sound(made: &Made, evidence: &Evidence, judged: &Judged) -> Result<(), ApplyError> {
    let (found, most) = (made.chi2_held_out, most_held_out(made));
    if !(found <= most) {
        return Err(ApplyError::HeldOut { found, most });
    }
    let noise = made.instrument_noise();
    match Drift::of(&evidence.references, &judged.visits, &noise) {
        Some(drift) if drift.is_significant() => Err(ApplyError::Drift(Box::new(drift))),
        _ => Ok(()),
    }
}

/// What chance brings of the square misses of poses that were held out.
fn most_held_out(made: &Made) -> f64 {
    const CHANCES: f64 = 4.0;
    let rows = 0.15 * made.visits as f64 * made.kit.rows() as f64;
    1.0 + CHANCES * (2.0 / rows).sqrt()
}

/// Sends it, with the servo off; what the controller says of it afterwards.
///
/// # Errors
/// [`ApplyError`]: what was in force before still is.
pub fn apply(
    machine: &mut dyn Machine,
    calibration: &Calibration,
    evidence: &Evidence,
) -> Result<String, ApplyError> {
    let sent = for_controller(calibration)?;
    let here = serial(machine)?;
    if !here.eq_ignore_ascii_case(&sent.serial) {
        let of = sent.serial.to_string();
        return Err(ApplyError::AnotherMachine { of, here });
    }
    let here_mm = Geometry::REFERENCE.radius_mm;
    let of_mm = calibration.made.track_radius_mm;
    if (of_mm - here_mm).abs() > 1e-6 * here_mm {
        return Err(ApplyError::AnotherSize { of_mm, here_mm });
    }
    (sent.for_tick(&Geometry::REFERENCE)).map_err(|_| ApplyError::BeyondLimits)?;
    let judged = no_worse(machine, calibration, evidence)?;
    is_sound(&calibration.made, evidence, &judged)?;
    rest(machine)?;
    for line in lines(&sent) {
        machine.ask(&line)?;
    }
    let told = machine.ask("CAL?")?.unwrap_or_default();
    let wanted = format!("CHECKSUM={}", sent.checksum());
    if !told.lines().any(|line| line.trim() == wanted) {
        return Err(strange("CAL?", &told).into());
    }
    Ok(told)
}

/// Takes the calibration that is in force out of it: the geometry is the drawing's again. The controller keeps the numbers.
///
/// # Errors
/// What the controller refuses.
pub fn switch_off(machine: &mut dyn Machine) -> Result<String, RecordError> {
    rest(machine)?;
    machine.ask("CAL OFF")?;
    Ok(machine.ask("CAL?")?.unwrap_or_default())
}

/// Servo off, and the level that calibrations need.
fn rest(machine: &mut dyn Machine) -> Result<(), RecordError> {
    /// Longest that a stage takes to come to rest.
    const RESTING_S: f64 = 0.5;
    machine.ask("SVO X 0")?;
    machine.delay(RESTING_S)?;
    machine.ask(LEVEL)?;
    Ok(())
}

/// As the controller keeps it.
fn for_controller(calibration: &Calibration) -> Result<MachineCalibration, ApplyError> {
    let word = |what, text: &str| match CalibrationText::try_from(text) {
        Ok(word) if !text.is_empty() && !text.contains(char::is_whitespace) => Ok(word),
        _ => Err(ApplyError::Word {
            what,
            text: text.to_owned(),
        }),
    };
    let made = &calibration.made;
    Ok(MachineCalibration {
        serial: word("serial number", &made.serial)?,
        date: word("date", &made.date)?,
        temperature_c: made.temperature_c.map(|celsius| celsius as f32),
        numbers: (calibration.machine()).map(|pivot| pivot.to_list().map(|number| number as f32)),
        is_on: true,
    })
}

/// The lines that send a calibration, for a connection of command level 1.
#[must_use]
pub fn lines(calibration: &MachineCalibration) -> Vec<String> {
    let celsius =
        (calibration.temperature_c).map_or(String::new(), |celsius| format!(" {celsius}"));
    let mut lines = vec![format!(
        "CAL BEG {} {}{celsius}",
        calibration.serial, calibration.date
    )];
    for (i, pivot) in calibration.numbers.iter().enumerate() {
        for (part, numbers) in pivot.chunks(LINE_NUMBERS).enumerate() {
            let mut line = format!("CAL SET {} {}", i + 1, part * LINE_NUMBERS + 1);
            for number in numbers {
                // Writing to a text does not fail.
                let _ = write!(line, " {number:e}");
            }
            lines.push(line);
        }
    }
    lines.push(format!("CAL END {}", calibration.checksum()));
    lines
}

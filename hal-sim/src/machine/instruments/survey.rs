//! A whole measurement, and its proof: visits at the stops of a plan, and where the machine goes when fitted numbers command it.

use calibration::frames::Pair;
use calibration::plan::{At, Stop};
use calibration::{Instrument, Kit, Machine, Seen, Visit};
use firmware::calibration::{CalibrationText, MachineCalibration};
use firmware::control::CalibrationInForce;
use firmware::motion::Position;
use kinematics::Geometry;

use super::camera::Camera;
use super::ends::Ends;
use super::interferometer::Interferometer;
use super::quasi_static::QuasiStatic;
use super::target::Target;
use crate::machine::plant::OffGuide;
use crate::random::Random;

/// Visits of a machine, with an instrument that somebody has set up by hand. Stops that are none of its own are passed over.
///
/// # Errors
/// [`OffGuide`]: the machine cannot be at a stop.
pub fn survey(
    machine: &QuasiStatic,
    instrument: &Instrument,
    stops: &[Stop],
    random: &mut Random,
) -> Result<Vec<Visit>, OffGuide> {
    let radius_m = machine.track_radius_m();
    let in_m = |[x, y, theta]: [f64; 3]| [x * radius_m, y * radius_m, theta];
    let noise = instrument.noise;
    match instrument.kit {
        Kit::Xyt | Kit::Theta => {
            let beams = Interferometer::set_up(noise, random);
            let visit = |stop: &Stop| {
                let visit = beams.visit(machine, in_m(stop.pose), random)?;
                Ok(match (instrument.kit, visit.seen) {
                    (Kit::Theta, Seen::Pose([_, _, theta])) => Visit {
                        seen: Seen::Turn(theta),
                        ..visit
                    },
                    _ => visit,
                })
            };
            stops.iter().map(visit).collect()
        }
        Kit::Xy => {
            let target = Target::set_up(noise, random);
            let visit = |stop: &Stop| target.visit(machine, in_m(stop.pose), random);
            stops.iter().map(visit).collect()
        }
        Kit::Camera | Kit::Camera2 | Kit::Balls => {
            let camera = Camera::set_up(instrument, radius_m, random);
            let visit = |stop: &Stop| {
                let At::Mark {
                    mark,
                    camera: place,
                } = stop.at
                else {
                    return None;
                };
                Some(camera.visit(machine, (mark, place), stop.pose[2], random))
            };
            stops.iter().filter_map(visit).collect()
        }
        Kit::Ends => {
            let ends = Ends::set_up(instrument, radius_m, random);
            let visit = |stop: &Stop| {
                let At::End { end } = stop.at else {
                    return None;
                };
                Some(ends.visit(machine, end, in_m(stop.pose), random))
            };
            stops.iter().filter_map(visit).collect()
        }
    }
}

/// Why a pose could not be commanded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CommandedError {
    /// The controller does not take such numbers.
    #[error("the numbers are beyond what a controller takes")]
    BeyondLimits,
    /// The controller knows no such pose.
    #[error("no pose of the mechanism")]
    NoPose,
    /// The machine cannot be there.
    #[error(transparent)]
    OffGuide(#[from] OffGuide),
}

/// Poses (track radii, rad) that a controller commands with fitted numbers, and where the machine goes, from any side. The controller has
/// the numbers as it is sent them, in floats of 32 bits, and reckons as its tick does: what either costs is in the errors.
///
/// # Errors
/// [`CommandedError`].
pub fn commanded(
    truth: &QuasiStatic,
    fitted: &Machine,
    poses: impl Iterator<Item = [f64; 3]>,
    random: &mut Random,
) -> Result<Vec<Pair>, CommandedError> {
    let radius_m = truth.track_radius_m();
    let in_force = in_force(fitted)?;
    poses
        .map(|asked| {
            let held = in_force.held_encoders(&position(asked));
            let encoders = held.ok_or(CommandedError::NoPose)?;
            let readings_rad = encoders.map(|encoder| encoder.radians());
            let [x, y, theta] = truth.reached(readings_rad, random)?;
            Ok(Pair {
                asked,
                reached: [x / radius_m, y / radius_m, theta],
            })
        })
        .collect()
}

/// Fitted numbers as a controller's tick has them.
fn in_force(fitted: &Machine) -> Result<CalibrationInForce, CommandedError> {
    let sent = MachineCalibration {
        serial: CalibrationText::new(),
        date: CalibrationText::new(),
        temperature_c: None,
        numbers: fitted.map(|pivot| pivot.to_list().map(|number| number as f32)),
        is_on: true,
    };
    let (calibration, margins) =
        (sent.for_tick(&Geometry::REFERENCE)).map_err(|_| CommandedError::BeyondLimits)?;
    Ok(CalibrationInForce {
        is_on: !calibration.are_zero(),
        calibration,
        margins,
    })
}

/// A pose (track radii, rad) as the tick has it.
fn position([x, y, theta_rad]: [f64; 3]) -> Position {
    const UNITS: f64 = 4_294_967_296.0;
    let length = |radii: f64| (radii * UNITS).round() as i64;
    let turn = (theta_rad / core::f64::consts::TAU * UNITS).round() as i64;
    [length(x), length(y), turn]
}

//! A whole measurement, and its proof: visits at the stops of a plan, and where the machine goes when fitted numbers command it.

use calibration::frames::Pair;
use calibration::plan::{At, Stop};
use calibration::position::readings_rad;
use calibration::{Instrument, Kit, Machine, Seen, Visit};

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
        Kit::Camera | Kit::Camera2 => {
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

/// Poses (track radii, rad) that a controller commands with fitted numbers, and where the machine goes, from any side.
///
/// # Errors
/// [`OffGuide`]: the machine cannot be there.
pub fn commanded(
    truth: &QuasiStatic,
    fitted: &Machine,
    poses: impl Iterator<Item = [f64; 3]>,
    random: &mut Random,
) -> Result<Vec<Pair>, OffGuide> {
    let radius_m = truth.track_radius_m();
    poses
        .map(|asked| {
            let readings = readings_rad(fitted, &asked).map_err(|_| OffGuide { guide: 0 })?;
            let [x, y, theta] = truth.reached(readings, random)?;
            Ok(Pair {
                asked,
                reached: [x / radius_m, y / radius_m, theta],
            })
        })
        .collect()
}

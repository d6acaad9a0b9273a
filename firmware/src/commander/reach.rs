//! Whether the pose that the encoders show is one that the stage can take: the one free hint at wrong wiring and wrong zeros.

use super::coordinates::{DEGREES_A_TURN, UNITS_PER_RADIUS, shown_pose};
use crate::calibration::MachineCalibration;
use crate::parameters::Parameters;
use crate::queues::Snapshot;
use core::f64::consts::TAU;
use kinematics::{Angle, Geometry, Pose, margins};

/// How far out of its reach the stage may be taken over: as far as the supervisor lets it go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ReachMargins {
    geometry: Geometry,
    disk: f64,
    guide: f64,
    separation_rad: f64,
}

impl ReachMargins {
    /// With these parameters.
    pub const fn new(parameters: &Parameters) -> Self {
        let supervision = &parameters.supervision;
        Self {
            geometry: parameters.geometry,
            disk: supervision.disk_margin_mm / parameters.geometry.radius_mm,
            guide: supervision.guide_margin,
            separation_rad: supervision.separation_margin_rad,
        }
    }

    /// The pose that the encoders show, mm, mm and deg, if all of them answer and it is none that the stage can take.
    pub fn pose_outside(
        &self,
        snapshot: &Snapshot,
        built: Option<&MachineCalibration>,
    ) -> Option<[f64; 3]> {
        let pose = pose_of(snapshot, built)?;
        let is_inside = margins(&self.geometry, &pose).is_ok_and(|room| {
            room.disk >= -self.disk
                && room.guide_start.min(room.guide_end) >= -self.guide
                && room.separation_rad >= -self.separation_rad
        });
        let mm = |radii: f64| radii * self.geometry.radius_mm;
        let turns = pose.theta / TAU;
        let w_deg = (turns - libm::rint(turns)) * DEGREES_A_TURN;
        (!is_inside).then(|| [mm(pose.x), mm(pose.y), w_deg])
    }
}

/// The pose that the encoders show, within one turn, if all of them answer and it is one.
fn pose_of(snapshot: &Snapshot, built: Option<&MachineCalibration>) -> Option<Pose<f64>> {
    if snapshot.encoder_faults != [None; 3] {
        return None;
    }
    let single_turn = |angle: Angle| f64::from(angle.units() as u32) / UNITS_PER_RADIUS * TAU;
    shown_pose(&snapshot.pivots.map(single_turn), built)
}

/// The smallest angle between two pivots, rad.
pub(super) fn closest_pivots_rad(snapshot: &Snapshot) -> f64 {
    let [one, two, three] = snapshot.pivots;
    let apart = [two - one, three - two, one - three].map(Angle::fraction);
    let closest = apart.into_iter().min().unwrap_or(0);
    f64::from(closest) / UNITS_PER_RADIUS * TAU
}

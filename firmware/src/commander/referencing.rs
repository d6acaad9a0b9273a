//! Referencing: absolute encoders are given a moment to answer, then the tick takes theta and the turns from them.

use super::coordinates::UNITS_PER_RADIUS;
use super::error::CommandError;
use super::in_flight::InFlight;
use super::state::Commander;
use crate::mode::Mode;
use crate::parameters::Supervision;
use crate::queues::{Command, CommandQueues, Snapshot};
use core::f64::consts::TAU;
use kinematics::{Angle, direct, margins};

/// Ticks that referencing waits for encoders that do not answer yet: they need some good frames in a row.
const REFERENCING_TIMEOUT_TICKS: u64 = 40;

/// How far referencing has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Referencing {
    /// Not at its end yet.
    Waiting,
    /// Theta and the turns are known.
    Done,
    /// They are not.
    Failed(CommandError),
}

impl Commander {
    /// Begins to reference: whether there is something to wait for.
    pub fn begin_referencing(
        &mut self,
        queues: &mut CommandQueues<'_>,
    ) -> Result<bool, CommandError> {
        let Some(snapshot) = self.current_snapshot() else {
            return Err(CommandError::Busy);
        };
        if self.is_faulted() {
            return Err(CommandError::Faulted);
        }
        self.check_commissioned()?;
        if snapshot.referenced {
            self.set_servo(true, queues)?;
            return Ok(false);
        }
        if self.is_referencing() {
            return Err(CommandError::Busy);
        }
        self.referencing_deadline = self.tick() + REFERENCING_TIMEOUT_TICKS;
        Ok(true)
    }

    /// Goes on with it: encoders are given a moment to answer, then the tick references.
    pub fn poll_referencing(&mut self, queues: &mut CommandQueues<'_>) -> Referencing {
        let Some(snapshot) = self.current_snapshot() else {
            return Referencing::Waiting;
        };
        let result = if matches!(snapshot.mode, Mode::Fault | Mode::Stopping) {
            Referencing::Failed(CommandError::Faulted)
        } else if snapshot.referenced {
            Referencing::Done
        } else if let Some(pose) = self.pose_out_of_reach(snapshot) {
            Referencing::Failed(CommandError::ReferenceOutside(pose))
        } else if snapshot.tick >= self.referencing_deadline {
            Referencing::Failed(CommandError::ReferencingFailed)
        } else {
            Referencing::Waiting
        };
        if result != Referencing::Waiting {
            self.referencing_deadline = 0;
        } else if snapshot.encoder_faults == [None; 3] {
            // A full queue, or pivots that are no pose yet: again at the next snapshot.
            let _ = self.send(Command::Reference, InFlight::Reference, queues);
        }
        result
    }

    /// The pose that the encoders show, mm, mm and deg, if all of them answer and it is none that the stage can take: the one free
    /// hint at wrong wiring and wrong zeros.
    fn pose_out_of_reach(&self, snapshot: &Snapshot) -> Option<[f64; 3]> {
        if snapshot.encoder_faults != [None; 3] {
            return None;
        }
        let geometry = &self.base_constraints.geometry;
        let single_turn = |angle: Angle| f64::from(angle.units() as u32) / UNITS_PER_RADIUS * TAU;
        let pose = direct::<f64>(&snapshot.pivots.map(single_turn)).ok()?;
        let most = &self.reach_margins;
        let is_inside = margins(geometry, &pose).is_ok_and(|room| {
            room.disk >= -most.disk_mm / geometry.radius_mm
                && room.guide_start.min(room.guide_end) >= -most.guide
                && room.separation_rad >= -most.separation_rad
        });
        let mm = |radii: f64| radii * geometry.radius_mm;
        let turns = pose.theta / TAU;
        let w_deg = (turns - libm::rint(turns)) * 360.0;
        (!is_inside).then(|| [mm(pose.x), mm(pose.y), w_deg])
    }
}

/// How far out of its reach the stage may be referenced: as far as the supervisor lets it go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ReachMargins {
    disk_mm: f64,
    guide: f64,
    separation_rad: f64,
}

impl ReachMargins {
    pub const fn new(supervision: &Supervision) -> Self {
        Self {
            disk_mm: supervision.disk_margin_mm,
            guide: supervision.guide_margin,
            separation_rad: supervision.separation_margin_rad,
        }
    }
}

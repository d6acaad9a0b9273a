//! The servos, as the snapshots tell of them.

use crate::control::ServoReport;
use crate::parameters::{Learnt, Parameters};
use crate::queues::Snapshot;

/// The servos, as they were told last.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::gcs) struct ServoReports {
    pub servos: [Option<ServoReport>; 3],
    /// Whether the stage was held when it was looked at last.
    pub was_held: bool,
    /// Tick at which it was kept last, or tried.
    pub kept_tick: u64,
}

impl ServoReports {
    /// Takes the next snapshot.
    pub fn update(&mut self, snapshot: &Snapshot) {
        if let Some(servo) = self.servos.get_mut(snapshot.servo.pivot) {
            *servo = Some(snapshot.servo);
        }
    }

    /// What has been learnt; what is kept of a pivot that has not been told of yet.
    pub fn learnt(&self, parameters: &Parameters) -> [Learnt; 3] {
        let mut learnt = parameters.learnt;
        for (learnt, servo) in learnt.iter_mut().zip(&self.servos) {
            if let Some(servo) = servo {
                *learnt = servo.learnt.to_keep();
            }
        }
        learnt
    }
}

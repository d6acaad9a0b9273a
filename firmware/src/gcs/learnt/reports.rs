//! The servos, as the snapshots tell of them.

use crate::control::ServoReport;
use crate::parameters::{Learnt, Parameters};

/// The servos, as they were told last.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::gcs) struct ServoReports {
    pub servos: [Option<ServoReport>; 3],
    /// Those that were told of before the parameters said otherwise.
    is_stale: [bool; 3],
    /// Whether the stage was held when it was looked at last.
    pub was_held: bool,
    /// Tick at which it was kept last, or tried.
    pub kept_tick: u64,
}

impl ServoReports {
    /// Takes the next, of one of them; `is_configuring`: the tick may not know the parameters yet.
    pub fn update(&mut self, report: ServoReport, is_configuring: bool) {
        let pivot = report.pivot;
        if let (Some(servo), Some(is_stale)) =
            (self.servos.get_mut(pivot), self.is_stale.get_mut(pivot))
        {
            *servo = Some(report);
            *is_stale &= is_configuring;
        }
    }

    /// The parameters say something else from now on.
    pub fn outdate(&mut self) {
        self.is_stale = [true; 3];
    }

    /// What has been learnt; what is kept of a pivot that has not been told of since.
    pub fn learnt(&self, parameters: &Parameters) -> [Learnt; 3] {
        let mut learnt = parameters.learnt;
        for ((learnt, servo), is_stale) in learnt.iter_mut().zip(&self.servos).zip(self.is_stale) {
            if let (Some(servo), false) = (servo, is_stale) {
                *learnt = servo.learnt.to_keep();
            }
        }
        learnt
    }
}

//! Referencing: absolute encoders are given a moment to answer, then the tick takes theta and the turns from them.

use super::error::CommandError;
use super::in_flight::InFlight;
use super::state::Commander;
use crate::mode::Mode;
use crate::queues::{Command, CommandQueues};

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
        self.check_may_drive()?;
        if self.is_recovering() {
            return Err(CommandError::InMotion);
        }
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
        } else if let Some(pose) = self.reach_margins.pose_outside(snapshot, self.built()) {
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
}

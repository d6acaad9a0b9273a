//! Referencing: absolute encoders are given a moment to answer, then the tick takes theta and the turns from them.

use super::{Flight, Stage};
use crate::gcs::error::ErrorCode;
use crate::mode::Mode;
use crate::queues::{Command, CommandQueues};

/// Ticks that referencing waits for encoders that do not answer yet: they need some good frames in a row.
const REFERENCE_PATIENCE: u64 = 40;

/// How far referencing has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Referencing {
    Waiting,
    Done,
    Failed(ErrorCode),
}

impl Stage {
    /// `FRF` begins: whether there is something to wait for.
    pub fn begin_reference(&mut self, queues: &mut CommandQueues<'_>) -> Result<bool, ErrorCode> {
        let Some(snapshot) = self.present() else {
            return Err(ErrorCode::Busy);
        };
        if self.is_faulted() {
            return Err(ErrorCode::MotionError);
        }
        if snapshot.referenced {
            self.set_servo(true, queues)?;
            return Ok(false);
        }
        if self.is_referencing() {
            return Err(ErrorCode::Busy);
        }
        self.reference_until = self.tick() + REFERENCE_PATIENCE;
        Ok(true)
    }

    /// `FRF` goes on: encoders are given a moment to answer, then the tick references.
    pub fn reference(&mut self, queues: &mut CommandQueues<'_>) -> Referencing {
        let Some(snapshot) = self.present() else {
            return Referencing::Waiting;
        };
        let result = if matches!(snapshot.mode, Mode::Fault | Mode::Stopping) {
            Referencing::Failed(ErrorCode::MotionError)
        } else if snapshot.referenced {
            Referencing::Done
        } else if snapshot.tick >= self.reference_until {
            Referencing::Failed(ErrorCode::ReferencingFailed)
        } else {
            Referencing::Waiting
        };
        if result != Referencing::Waiting {
            self.reference_until = 0;
        } else if snapshot.encoder_faults == [None; 3] {
            // A full queue, or pivots that are no pose yet: again at the next snapshot.
            let _ = self.send(Command::Reference, Flight::Reference, queues);
        }
        result
    }
}

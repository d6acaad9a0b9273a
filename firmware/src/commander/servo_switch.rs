//! The servo on and off. A stage in motion is stopped on its path before it is let go, and taken over only at rest.

use super::error::CommandError;
use super::state::Commander;
use crate::mode::Mode;
use crate::motion::Stop;
use crate::queues::CommandQueues;

impl Commander {
    /// Servo on or off. Before referencing there is no pose to hold: on is accepted, as clients send it first, and
    /// comes about with referencing.
    ///
    /// # Errors
    /// [`CommandError::Faulted`], [`CommandError::NotCommissioned`], [`CommandError::Debugged`], and [`CommandError::InMotion`] for a stage
    /// that has been let go and has not come to rest: the servo would try to stop it within a tick; [`CommandError::ReferenceOutside`] for one
    /// that is out of its reach, where the supervisor would end it at once.
    pub fn set_servo(
        &mut self,
        on: bool,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        let Some(snapshot) = self.current_snapshot() else {
            return Err(CommandError::Busy);
        };
        if self.is_recovering() {
            return match on {
                true => Err(CommandError::InMotion),
                false => {
                    self.stop(Stop::Urgent, queues);
                    Ok(())
                }
            };
        }
        match (on, snapshot.mode) {
            (true, Mode::Fault | Mode::Stopping) => Err(CommandError::Faulted),
            (true, Mode::Exciting) => Err(CommandError::InMotion),
            (false, Mode::Exciting) => {
                self.end_excitation(queues);
                Ok(())
            }
            (true, Mode::Off) if snapshot.referenced => {
                self.check_may_drive()?;
                if self.rest.is_fast {
                    return Err(CommandError::InMotion);
                }
                if let Some(pose) = self.reach_margins.pose_outside(snapshot, self.built()) {
                    return Err(CommandError::ReferenceOutside(pose));
                }
                self.send_servo(true, queues)
            }
            (true, _) => {
                self.check_may_drive()?;
                self.off_at_rest = false;
                Ok(())
            }
            (false, Mode::Holding) if !self.is_motion_pending() => self.send_servo(false, queues),
            (false, Mode::Holding | Mode::Moving) => {
                self.off_at_rest = true;
                self.stop(Stop::Urgent, queues);
                Ok(())
            }
            (false, _) => Ok(()),
        }
    }

    /// Switches the servo off that is to go off, once the motion has come to its end.
    pub(super) fn switch_off_at_rest(&mut self, queues: &mut CommandQueues<'_>) {
        if !self.off_at_rest {
            return;
        }
        match self.mode() {
            Mode::Moving => {}
            Mode::Holding if self.is_motion_pending() || self.current_snapshot().is_none() => {}
            Mode::Holding => {
                // A full queue: again at the next snapshot.
                let sent = self.send_servo(false, queues);
                self.off_at_rest = sent.is_err();
            }
            Mode::Off | Mode::Stopping | Mode::Fault | Mode::Exciting => self.off_at_rest = false,
        }
    }
}

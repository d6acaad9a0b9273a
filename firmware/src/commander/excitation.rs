//! Excitations: a known voltage on a motor, to see what the machine is.

use super::error::CommandError;
use super::in_flight::InFlight;
use super::state::Commander;
use crate::control::excitation::{Excitation, ExcitationReport};
use crate::mode::Mode;
use crate::queues::{Command, CommandQueues};

impl Commander {
    /// Begins an excitation. With the servo off it needs no commissioned machine: it is how one becomes that.
    ///
    /// # Errors
    /// [`CommandError::Busy`], [`CommandError::Faulted`], [`CommandError::Debugged`], [`CommandError::StopUntested`]; [`CommandError::InMotion`] while one is under way, a
    /// recovery is, or a stage that was let go has not come to rest; [`CommandError::ServoOn`] for one that
    /// [needs the servo off](Excitation::needs_servo_off).
    pub fn begin_excitation(
        &mut self,
        excitation: Excitation,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        let Some(snapshot) = self.current_snapshot() else {
            return Err(CommandError::Busy);
        };
        let (mode, runs) = (snapshot.mode, snapshot.excitation.runs);
        if self.is_faulted() {
            return Err(CommandError::Faulted);
        }
        self.check_may_excite()?;
        if runs || self.is_recovering() || self.is_referencing() {
            return Err(CommandError::InMotion);
        }
        match mode {
            Mode::Off if self.rest.is_fast => return Err(CommandError::InMotion),
            Mode::Holding | Mode::Moving if excitation.needs_servo_off() => {
                return Err(CommandError::ServoOn);
            }
            _ => {}
        }
        self.ends_excitation = false;
        self.send(Command::Excite(excitation), InFlight::Excitation, queues)
    }

    /// The excitation under way, or the last one.
    pub fn excitation(&self) -> ExcitationReport {
        self.snapshot
            .as_ref()
            .map_or_else(Default::default, |snapshot| snapshot.excitation)
    }

    /// Whether one is under way, or on its way to the tick.
    pub fn is_exciting(&self) -> bool {
        self.excitation().runs || matches!(self.in_flight, Some(InFlight::Excitation))
    }

    /// Ends the one under way, as soon as the tick can be told.
    pub(super) fn end_excitation(&mut self, queues: &mut CommandQueues<'_>) {
        self.ends_excitation |= self.is_exciting();
        self.advance_end_of_excitation(queues);
    }

    /// Again, if the tick could not be told.
    pub(super) fn advance_end_of_excitation(&mut self, queues: &mut CommandQueues<'_>) {
        if !self.ends_excitation {
            return;
        }
        // What is in flight may be the excitation itself.
        if self.current_snapshot().is_some() {
            self.ends_excitation = self.excitation().runs
                && self
                    .send(Command::EndExcitation, InFlight::Other, queues)
                    .is_err();
        }
    }
}

//! The calibration of a built machine: sent to the tick, and taken into account wherever encoders become a pose.

use super::error::CommandError;
use super::in_flight::InFlight;
use super::state::Commander;
use crate::calibration::MachineCalibration;
use crate::control::CalibrationInForce;
use crate::mode::Mode;
use crate::queues::{Command, CommandQueues};

impl Commander {
    /// The calibration that there is, whether it counts or not.
    pub fn calibration(&self) -> Option<&MachineCalibration> {
        self.calibrating.kept.as_ref()
    }

    /// What the machine is off the drawing; `None` where nothing is corrected.
    pub(crate) fn built(&self) -> Option<&MachineCalibration> {
        self.calibration().filter(|calibration| calibration.is_on)
    }

    /// Another calibration from now on, or none: all of it or, with an error, nothing.
    ///
    /// # Errors
    /// [`CommandError::ServoOn`], [`CommandError::InMotion`]; [`CommandError::CalibrationBeyondLimits`];
    /// [`CommandError::RadiusWithToolFrame`], where its temperature makes the track another size; [`CommandError::Busy`] when the tick cannot
    /// be told.
    pub fn calibrate(
        &mut self,
        wanted: Option<MachineCalibration>,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        let mode = self.current_snapshot().map(|snapshot| snapshot.mode);
        match mode {
            None => return Err(CommandError::Busy),
            Some(Mode::Off | Mode::Fault) => {}
            Some(Mode::Holding) => return Err(CommandError::ServoOn),
            Some(Mode::Moving | Mode::Stopping | Mode::Exciting) => {
                return Err(CommandError::InMotion);
            }
        }
        self.check_calibrated_growth(wanted.as_ref())?;
        self.send_calibration(wanted.as_ref(), queues)?;
        self.keep_calibration(wanted);
        Ok(())
    }

    /// The calibration that was kept over a restart.
    pub fn restore_calibration(&mut self, kept: Option<MachineCalibration>) {
        self.calibrating.is_due = kept.as_ref().is_some_and(|kept| kept.is_on);
        self.keep_calibration(kept);
    }

    fn keep_calibration(&mut self, wanted: Option<MachineCalibration>) {
        self.calibrating.keep(wanted);
        self.grow_track();
    }

    /// Tells the tick of one that was kept, as soon as that can be told anything: before any line does.
    // In a frame of its own, see `send_calibration`.
    #[inline(never)]
    pub(crate) fn send_due_calibration(&mut self, queues: &mut CommandQueues<'_>) {
        if !self.calibrating.is_due || self.current_snapshot().is_none() {
            return;
        }
        self.calibrating.is_due = false;
        let kept = self.calibrating.kept.take();
        if let Err(error) = self.calibrate(kept.clone(), queues) {
            // It is there, and does not count.
            self.keep_calibration(kept.map(|kept| MachineCalibration {
                is_on: false,
                ..kept
            }));
            self.report_late(error);
        }
    }

    // In a frame of its own: what is made there is not on the stack while a line is planned.
    #[inline(never)]
    fn send_calibration(
        &mut self,
        wanted: Option<&MachineCalibration>,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), CommandError> {
        let mut in_force = CalibrationInForce::OFF;
        if let Some(wanted) = wanted {
            // One that does not count must be such that it can.
            let (calibration, margins) = (wanted.for_tick(&self.base_constraints.geometry))
                .map_err(|_| CommandError::CalibrationBeyondLimits)?;
            // One that corrects nothing is none.
            if wanted.is_on && !calibration.are_zero() {
                in_force = CalibrationInForce {
                    is_on: true,
                    calibration,
                    margins,
                };
            }
        }
        self.send(Command::Calibrate(in_force), InFlight::Other, queues)
    }
}

//! `WPA` and `RPA`.

use super::state::{Keeping, KeptParameters};
use crate::calibration::MachineCalibration;
use crate::gcs::error::ErrorCode;
use crate::gcs::events::Event;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::parameter::{Addresses, Parameter};
use crate::gcs::text::Name;
use crate::iterative_learning::{TableName, TableReport};
use crate::parameters::{MAX_RECORD_ROWS, Parameters};
use crate::queues::CommandQueues;
use crate::settings_store::StoreError;

impl Interpreter {
    /// `WPA`: those named, or all parameters, as they are now, what the servos have learnt among them, and the macros.
    pub(in crate::gcs) fn store_parameters(
        &mut self,
        addresses: &Addresses,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        self.check_store()?;
        if self.persistence.is_pending() {
            return Err(ErrorCode::Busy);
        }
        self.take_over_learnt(queues)?;
        let wanted = replaced(&self.persistence.stored, &self.parameters, addresses)?;
        let before = core::mem::replace(&mut self.persistence.stored, wanted);
        self.persistence.before = Some(before);
        self.persistence.drops_unusable = true;
        Ok(())
    }

    /// `RPA`: those named, or all parameters, as they are stored.
    pub(in crate::gcs) fn recall(
        &mut self,
        addresses: &Addresses,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        self.check_store()?;
        let wanted = replaced(&self.parameters, &self.persistence.stored, addresses)?;
        self.check_change_allowed(&wanted)?;
        self.apply_parameters(wanted, queues)?;
        self.events.add(self.commander.tick(), Event::Recalled);
        Ok(())
    }

    /// `ILC KEEP`: a table of a repeated move is stored, with those that are kept already; and what the servos have learnt, since a table
    /// is what lacks besides that.
    pub(in crate::gcs) fn store_move(
        &mut self,
        name: TableName,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        self.check_store()?;
        // Settings that could not be used are overwritten by `WPA` alone.
        if self.persistence.is_pending() || self.persistence.stored_is_invalid {
            return Err(ErrorCode::Busy);
        }
        let was_kept = self.commander.is_move_kept(Some(&name));
        self.commander.keep_move(&name, true)?;
        if let Err(error) = self.take_over_learnt(queues) {
            self.commander.keep_move(&name, was_kept)?;
            return Err(error);
        }
        self.store_learnt();
        self.persistence.keeping = Some(Keeping { name, was_kept });
        Ok(())
    }

    /// Whether something may be stored that nobody has asked for.
    pub(in crate::gcs) fn may_store_by_itself(&self) -> bool {
        let persistence = &self.persistence;
        !persistence.stored_is_invalid && !persistence.is_pending() && self.check_store().is_ok()
    }

    /// What was learnt, beside what is stored as it is.
    pub(in crate::gcs) fn store_learnt(&mut self) {
        let before = self.persistence.stored.clone();
        self.persistence.stored.learnt = self.parameters.learnt;
        self.persistence.before = Some(before);
    }

    fn check_store(&self) -> Result<(), ErrorCode> {
        if !self.persistence.has_store {
            return Err(ErrorCode::NotForStage);
        }
        if self.commander.is_motion_commanded() {
            return Err(ErrorCode::InMotion);
        }
        Ok(())
    }

    /// What came of it.
    pub(super) fn storing_finished(&mut self, result: Result<(), StoreError>) {
        let persistence = &mut self.persistence;
        let before = persistence.before.take();
        let drops_unusable = core::mem::take(&mut persistence.drops_unusable);
        let keeping = persistence.keeping.take();
        persistence.has_changed = false;
        persistence.result = result.map_err(ErrorCode::from);
        let code = persistence.result.err();
        match (code, before) {
            (None, _) => {
                persistence.stored_is_invalid = false;
                if drops_unusable {
                    persistence.unusable.clear();
                }
            }
            (Some(_), Some(before)) => persistence.stored = before,
            // Who recorded the macro does not wait for it.
            (Some(code), None) => self.report_to_all(code),
        }
        if let (Some(_), Some(Keeping { name, was_kept })) = (code, keeping) {
            // It may be gone meanwhile, and is not kept then either.
            let _ = self.commander.keep_move(&name, was_kept);
        }
        let event = code.map_or(Event::Stored, |code| Event::StoreFailed(code.number()));
        self.events.add(self.commander.tick(), event);
    }

    /// The parameters in force.
    pub const fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The parameters that are stored, or about to be.
    pub const fn parameters_to_store(&self) -> &Parameters {
        &self.persistence.stored
    }

    /// The parameters that the controller has when nothing is stored.
    pub const fn default_parameters(&self) -> &Parameters {
        &self.persistence.defaults
    }

    /// All macros, with their lines, each ended by LF.
    pub fn macros(&self) -> impl Iterator<Item = (Name, &[u8])> {
        self.macros.all()
    }

    /// What is told of repeated moves that have tables.
    pub fn repeated_moves(&self) -> impl Iterator<Item = &TableReport> {
        self.commander.repeated_moves()
    }

    /// Starts with these parameters and this calibration, as if they had been stored: the settings that a machine comes with. To be
    /// called before anything else is.
    pub fn start_with(&mut self, parameters: Parameters, calibration: Option<MachineCalibration>) {
        self.commander.restore_calibration(calibration);
        self.restore_parameters(KeptParameters {
            parameters,
            unknown: 0,
            unusable: Default::default(),
        });
    }

    /// Values that are not in force and stay stored all the same, as long as nobody asks for others.
    pub(super) fn unusable_to_store(&self) -> &[(u32, f64)] {
        if self.persistence.drops_unusable {
            &[]
        } else {
            &self.persistence.unusable
        }
    }

    /// Starts with these parameters.
    pub(super) fn restore_parameters(&mut self, kept: KeptParameters) {
        let KeptParameters {
            mut parameters,
            unknown,
            unusable,
        } = kept;
        // As many as any choice of signals leaves room for: which they were is not kept.
        let recorder = &mut parameters.recorder;
        recorder.points = recorder.points.min(MAX_RECORD_ROWS as u32);
        recorder.before = recorder.before.min(recorder.points - 1);
        self.rated_limits = parameters.limits;
        self.commander.use_parameters(&parameters);
        self.commander.reset_velocity();
        self.parameters.clone_from(&parameters);
        self.previous_parameters.clone_from(&parameters);
        self.persistence.stored = parameters;
        self.note_looseness();
        self.note_limits_in_force();
        if unknown > 0 {
            self.events.add(0, Event::UnknownParameters(unknown));
        }
        for &(id, value) in &unusable {
            self.events.add(0, Event::UnusableParameter(id, value));
        }
        self.persistence.unusable = unusable;
    }

    /// Adds to the text of a macro that is stored; false when it is none, or there is no room.
    pub(super) fn add_macro_text(&mut self, text: &[u8]) -> bool {
        self.macros.add_text(text)
    }

    /// The text belongs to a macro of this name; false when there are too many.
    pub(super) fn end_macro_text(&mut self, name: Name) -> bool {
        self.macros.end_text(name)
    }

    /// Has no macros, and no text of one.
    pub(super) fn forget_macros(&mut self) {
        self.macros.clear();
    }
}

/// `parameters` with those named from `others`, or all of `others` when none is.
fn replaced(
    parameters: &Parameters,
    others: &Parameters,
    addresses: &Addresses,
) -> Result<Parameters, ErrorCode> {
    if addresses[0].is_none() {
        return Ok(others.clone());
    }
    let mut replaced = parameters.clone();
    for address in addresses.iter().flatten() {
        let parameter = Parameter::find(address.id).ok_or(ErrorCode::UnknownParameter)?;
        parameter.copy(others, &mut replaced)?;
    }
    if replaced.are_sound() {
        Ok(replaced)
    } else {
        Err(ErrorCode::OutOfRange)
    }
}

//! Settings over a restart: `WPA`, `RPA`, and macros, which are kept as they are recorded and deleted.
//!
//! The panel says what is to be kept, [`Keeper`](crate::settings_store::Keeper) does it while the stage is at rest. `WPA` waits for it
//! and tells the sender what came of it. Without a keeper, `WPA` and `RPA` are refused.

use super::Panel;
use super::error::ErrorCode;
use super::events::Event;
use super::parameter::{Addresses, Parameter};
use super::text::Name;
use crate::parameters::Parameters;
use crate::parameters::RECORD_ROWS;
use crate::queues::PanelLink;
use crate::settings_store::StoreError;

/// What `WPA` has to be given, so that nothing is overwritten by a slip.
pub(super) const STORE_PASSWORD: &[u8] = b"100";

/// What is kept, and what is to be.
pub(super) struct Persistence {
    /// The parameters that the controller has when nothing is kept.
    defaults: Parameters,
    /// Those that are kept, or about to be.
    stored: Parameters,
    /// Somebody keeps settings.
    has_store: bool,
    /// What was kept could not be used: `WPA` alone may overwrite it.
    stored_is_invalid: bool,
    /// `WPA` waits for its end, and what to go back to if it fails.
    before: Option<Parameters>,
    /// Macros have changed since they were kept.
    macros_changed: bool,
    /// What came of the last `WPA`.
    result: Result<(), ErrorCode>,
}

impl Persistence {
    /// Nothing is kept.
    pub fn new(own: &Parameters) -> Self {
        Self {
            defaults: own.clone(),
            stored: own.clone(),
            has_store: false,
            stored_is_invalid: false,
            before: None,
            macros_changed: false,
            result: Ok(()),
        }
    }

    /// The macros have changed.
    pub const fn mark_macros_changed(&mut self) {
        self.macros_changed = true;
    }

    /// What came of `WPA`; nothing as long as it is under way.
    pub const fn result(&self) -> Option<Result<(), ErrorCode>> {
        match self.before {
            Some(_) => None,
            None => Some(self.result),
        }
    }
}

impl Panel {
    /// `WPA`: those named, or all parameters, as they are now, and the macros.
    pub(super) fn store_parameters(&mut self, addresses: &Addresses) -> Result<(), ErrorCode> {
        self.check_store()?;
        if self.persistence.before.is_some() {
            return Err(ErrorCode::Busy);
        }
        let wanted = replaced(&self.persistence.stored, &self.parameters, addresses)?;
        let before = core::mem::replace(&mut self.persistence.stored, wanted);
        self.persistence.before = Some(before);
        Ok(())
    }

    /// `RPA`: those named, or all parameters, as they are kept.
    pub(super) fn recall(
        &mut self,
        addresses: &Addresses,
        queues: &mut PanelLink<'_>,
    ) -> Result<(), ErrorCode> {
        self.check_store()?;
        let wanted = replaced(&self.parameters, &self.persistence.stored, addresses)?;
        self.check_change_allowed(&wanted)?;
        self.apply_parameters(wanted, queues)?;
        self.events.add(self.commander.tick(), Event::Recalled);
        Ok(())
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

    /// Somebody keeps settings from now on; `usable` says whether what was kept could be used.
    pub(crate) const fn keeps_settings(&mut self, usable: bool) {
        self.persistence.has_store = true;
        self.persistence.stored_is_invalid = !usable;
    }

    /// Whether something waits to be kept, and can be.
    pub(crate) fn wants_to_be_kept(&self) -> bool {
        let persistence = &self.persistence;
        let macros = persistence.macros_changed && !persistence.stored_is_invalid;
        persistence.has_store
            && (persistence.before.is_some() || macros)
            && !self.commander.is_motion_commanded()
    }

    /// What came of it.
    pub(crate) fn was_kept(&mut self, result: Result<(), StoreError>) {
        let persistence = &mut self.persistence;
        let asked_for = persistence.before.take();
        persistence.macros_changed = false;
        persistence.result = result.map_err(ErrorCode::from);
        let code = persistence.result.err();
        match (code, asked_for) {
            (None, _) => persistence.stored_is_invalid = false,
            (Some(_), Some(before)) => persistence.stored = before,
            // Who recorded the macro does not wait for it.
            (Some(code), None) => self.report_to_all(code),
        }
        let event = code.map_or(Event::Stored, |code| Event::StoreFailed(code.number()));
        self.events.add(self.commander.tick(), event);
    }

    /// The parameters in force.
    pub const fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The parameters that are kept, or about to be.
    pub const fn parameters_to_keep(&self) -> &Parameters {
        &self.persistence.stored
    }

    /// The parameters that the controller has when nothing is kept.
    pub const fn own_parameters(&self) -> &Parameters {
        &self.persistence.defaults
    }

    /// All macros, with their lines, each ended by LF.
    pub fn macros(&self) -> impl Iterator<Item = (Name, &[u8])> {
        self.macros.all()
    }

    /// Starts with these parameters; `unknown` ones were kept besides.
    pub(crate) fn restore_parameters(&mut self, mut parameters: Parameters, unknown: u16) {
        // As many as any choice of signals leaves room for: which they were is not kept.
        let recorder = &mut parameters.recorder;
        recorder.points = recorder.points.min(RECORD_ROWS as u32);
        recorder.before = recorder.before.min(recorder.points - 1);
        self.rated_limits = parameters.limits;
        self.commander.use_parameters(&parameters);
        // Not refused: it is their own.
        let _ = self.commander.set_velocity(parameters.limits.speed_mm_s);
        self.parameters.clone_from(&parameters);
        self.previous_parameters.clone_from(&parameters);
        self.persistence.stored = parameters;
        if unknown > 0 {
            self.events.add(0, Event::UnknownParameters(unknown));
        }
    }

    /// Adds to the text of a macro that is kept; false when it is none, or there is no room.
    pub(crate) fn add_macro_text(&mut self, text: &[u8]) -> bool {
        self.macros.add_text(text)
    }

    /// The text belongs to a macro of this name; false when there are too many.
    pub(crate) fn end_macro_text(&mut self, name: Name) -> bool {
        self.macros.end_text(name)
    }

    /// Has no macros, and no text of one.
    pub(crate) fn forget_macros(&mut self) {
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
        let value = parameter.number(others).ok_or(ErrorCode::ReadOnly)?;
        parameter.set(value, &mut replaced)?;
    }
    if replaced.are_sound() {
        Ok(replaced)
    } else {
        Err(ErrorCode::OutOfRange)
    }
}

//! Settings over a restart: `WPA`, `RPA`, and macros, which are kept as they are recorded and deleted.
//!
//! The panel says what is to be kept, [`Keeper`](crate::settings_store::Keeper) does it while the stage is at rest. `WPA` waits for it
//! and tells the sender what came of it. Without a keeper, `WPA` and `RPA` are refused.

use super::Panel;
use super::error::ErrorCode;
use super::events::Event;
use super::parameter::{Addresses, Parameter};
use super::text::Name;
use crate::gcs::StoreError;
use crate::parameters::MAX_RECORD_ROWS;
use crate::parameters::Parameters;
use crate::queues::CommandQueues;

/// What `WPA` has to be given, so that nothing is overwritten by a slip.
pub(super) const PASSWORD: &[u8] = b"100";

/// What is kept, and what is to be.
pub(super) struct Keeping {
    /// The parameters that the controller has when nothing is kept.
    own: Parameters,
    /// Those that are kept, or about to be.
    kept: Parameters,
    /// Somebody keeps settings.
    has_keeper: bool,
    /// What was kept could not be used: `WPA` alone may overwrite it.
    is_spoilt: bool,
    /// `WPA` waits for its end, and what to go back to if it fails.
    before: Option<Parameters>,
    /// Macros have changed since they were kept.
    macros: bool,
    /// What came of the last `WPA`.
    result: Result<(), ErrorCode>,
}

impl Keeping {
    /// Nothing is kept.
    pub fn new(own: &Parameters) -> Self {
        Self {
            own: own.clone(),
            kept: own.clone(),
            has_keeper: false,
            is_spoilt: false,
            before: None,
            macros: false,
            result: Ok(()),
        }
    }

    /// The macros have changed.
    pub const fn note_macros(&mut self) {
        self.macros = true;
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
    pub(super) fn keep(&mut self, addresses: &Addresses) -> Result<(), ErrorCode> {
        self.check_keeper()?;
        if self.keeping.before.is_some() {
            return Err(ErrorCode::Busy);
        }
        let wanted = replaced(&self.keeping.kept, &self.parameters, addresses)?;
        let before = core::mem::replace(&mut self.keeping.kept, wanted);
        self.keeping.before = Some(before);
        Ok(())
    }

    /// `RPA`: those named, or all parameters, as they are kept.
    pub(super) fn recall(
        &mut self,
        addresses: &Addresses,
        queues: &mut CommandQueues<'_>,
    ) -> Result<(), ErrorCode> {
        self.check_keeper()?;
        let wanted = replaced(&self.parameters, &self.keeping.kept, addresses)?;
        self.permit_change(&wanted)?;
        self.put_in_force(wanted, queues)?;
        self.events.add(self.stage.tick(), Event::Recalled);
        Ok(())
    }

    fn check_keeper(&self) -> Result<(), ErrorCode> {
        if !self.keeping.has_keeper {
            return Err(ErrorCode::NotForStage);
        }
        if self.stage.is_under_way() {
            return Err(ErrorCode::InMotion);
        }
        Ok(())
    }

    /// Somebody keeps settings from now on; `usable` says whether what was kept could be used.
    pub(crate) const fn keeps_settings(&mut self, usable: bool) {
        self.keeping.has_keeper = true;
        self.keeping.is_spoilt = !usable;
    }

    /// Whether something waits to be kept, and can be.
    pub(crate) fn wants_to_be_kept(&self) -> bool {
        let keeping = &self.keeping;
        let macros = keeping.macros && !keeping.is_spoilt;
        keeping.has_keeper && (keeping.before.is_some() || macros) && !self.stage.is_under_way()
    }

    /// What came of it.
    pub(crate) fn was_kept(&mut self, result: Result<(), StoreError>) {
        let keeping = &mut self.keeping;
        let asked_for = keeping.before.take();
        keeping.macros = false;
        keeping.result = match result {
            Ok(()) => Ok(()),
            Err(StoreError::TooLong) => Err(ErrorCode::NoMemory),
            Err(StoreError::Flash) => Err(ErrorCode::FlashFailed),
        };
        let code = keeping.result.err();
        match (code, asked_for) {
            (None, _) => keeping.is_spoilt = false,
            (Some(_), Some(before)) => keeping.kept = before,
            // Who recorded the macro does not wait for it.
            (Some(code), None) => self.stage.tell_all(code),
        }
        let event = code.map_or(Event::Kept, |code| Event::NotKept(code.number()));
        self.events.add(self.stage.tick(), event);
    }

    /// The parameters in force.
    pub const fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The parameters that are kept, or about to be.
    pub const fn parameters_to_keep(&self) -> &Parameters {
        &self.keeping.kept
    }

    /// The parameters that the controller has when nothing is kept.
    pub const fn own_parameters(&self) -> &Parameters {
        &self.keeping.own
    }

    /// All macros, with their lines, each ended by LF.
    pub fn macros(&self) -> impl Iterator<Item = (Name, &[u8])> {
        self.macros.all()
    }

    /// Starts with these parameters; `unknown` ones were kept besides.
    pub(crate) fn take_kept_parameters(&mut self, mut parameters: Parameters, unknown: u16) {
        // As many as any choice of signals leaves room for: which they were is not kept.
        let recorder = &mut parameters.recorder;
        recorder.points = recorder.points.min(MAX_RECORD_ROWS as u32);
        recorder.before = recorder.before.min(recorder.points - 1);
        self.rated = parameters.limits;
        self.stage.use_parameters(&parameters);
        // Not refused: it is their own.
        let _ = self.stage.set_velocity(parameters.limits.speed_mm_s);
        self.parameters.clone_from(&parameters);
        self.parameters_before.clone_from(&parameters);
        self.keeping.kept = parameters;
        if unknown > 0 {
            self.events.add(0, Event::Unknown(unknown));
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
        parameter.put(value, &mut replaced)?;
    }
    if replaced.are_sound() {
        Ok(replaced)
    } else {
        Err(ErrorCode::OutOfRange)
    }
}

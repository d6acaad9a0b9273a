//! What is stored, and what is to be.

use crate::gcs::error::ErrorCode;
use crate::parameters::Parameters;

/// What is stored, and what is to be.
pub(in crate::gcs) struct Persistence {
    /// The parameters that the controller has when nothing is stored.
    pub(super) defaults: Parameters,
    /// Those that are stored, or about to be.
    pub(super) stored: Parameters,
    /// Somebody keeps settings.
    pub(super) has_store: bool,
    /// What was stored could not be used: `WPA` alone may overwrite it.
    pub(super) stored_is_invalid: bool,
    /// `WPA` waits for its end, and what to go back to if it fails.
    pub(super) before: Option<Parameters>,
    /// Macros have changed since they were stored.
    pub(super) macros_changed: bool,
    /// What came of the last `WPA`.
    pub(super) result: Result<(), ErrorCode>,
}

impl Persistence {
    /// Nothing is stored.
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

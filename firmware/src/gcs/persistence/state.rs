//! What is stored, and what is to be.

use crate::gcs::error::ErrorCode;
use crate::parameters::Parameters;
use heapless::Vec;

/// Values that are stored and that this firmware does not allow, with their parameters' numbers.
pub(in crate::gcs) type UnusableValues = Vec<(u32, f64), MAX_UNUSABLE>;
/// More of them are no settings of this stage.
const MAX_UNUSABLE: usize = 8;

/// What was read of the parameters that are stored.
pub(super) struct KeptParameters {
    pub parameters: Parameters,
    /// So many are unknown here.
    pub unknown: u16,
    pub unusable: UnusableValues,
}

/// What is stored, and what is to be.
pub(in crate::gcs) struct Persistence {
    /// The parameters that the controller has when nothing is stored.
    pub(super) defaults: Parameters,
    /// Those that are stored, or about to be.
    pub(super) stored: Parameters,
    /// Stored values that are not in force, because this firmware does not allow them: they stay stored until `WPA`.
    pub(in crate::gcs) unusable: UnusableValues,
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
            unusable: UnusableValues::new(),
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

//! What is stored, and what is to be.

use crate::gcs::error::ErrorCode;
use crate::iterative_learning::TableName;
use crate::parameters::Parameters;
use heapless::Vec;

/// Values that are stored and that this firmware does not allow, with their parameters' numbers.
pub(in crate::gcs) type UnusableValues = Vec<(u32, f64), MAX_UNUSABLE>;
/// More of them are no settings of this stage.
pub(super) const MAX_UNUSABLE: usize = 8;

/// What was read of the parameters that are stored.
pub(super) struct KeptParameters {
    pub parameters: Parameters,
    /// So many are unknown here.
    pub unknown: u16,
    pub unusable: UnusableValues,
}

/// A table of a repeated move that is to be kept.
pub(super) struct Keeping {
    pub name: TableName,
    /// It was before: what is stored of it stays when nothing can be stored now.
    pub was_kept: bool,
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
    /// Parameters are about to be stored: what to go back to if that fails.
    pub(super) before: Option<Parameters>,
    /// `WPA` waits for its end: what is not allowed is stored no more.
    pub(super) drops_unusable: bool,
    /// The table of a repeated move that somebody wants kept, and waits for.
    pub(super) keeping: Option<Keeping>,
    /// Macros have changed since they were stored, or a table that is stored was forgotten.
    pub(super) has_changed: bool,
    /// What came of the last `WPA` or `ILC KEEP`.
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
            drops_unusable: false,
            keeping: None,
            has_changed: false,
            result: Ok(()),
        }
    }

    /// Something is to be stored that nobody waits for: a macro, or that a table is no more.
    pub const fn mark_changed(&mut self) {
        self.has_changed = true;
    }

    /// Whether parameters are about to be stored.
    pub const fn is_pending(&self) -> bool {
        self.before.is_some()
    }

    /// What came of `WPA` or `ILC KEEP`; nothing as long as it is under way.
    pub const fn result(&self) -> Option<Result<(), ErrorCode>> {
        if self.is_pending() {
            None
        } else {
            Some(self.result)
        }
    }
}

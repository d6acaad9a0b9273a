//! Why settings could not be stored.

use core::fmt;

/// Why settings could not be written. What was stored before is stored still.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StoreError {
    /// They are longer than a sector of the flash.
    TooLong,
    /// The flash refuses, or does not show what was written.
    Flash,
}

impl fmt::Display for StoreError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TooLong => "the settings are longer than a sector of the flash",
            Self::Flash => "the flash does not take what is written",
        })
    }
}

//! Settings that survive: parameters and macros in flash, as `WPA` and the macro commands leave them.
//!
//! Everything that is kept is one image, written whole behind the last one: a power cut leaves all of the old settings or all
//! of the new ones, never a set of parameters of which only some were changed. [`Keeper`] reads it before anything can
//! move and writes it while the stage is at rest; it runs on the command side, and the tick never waits for it.
//!
//! | file | idea |
//! |---|---|
//! | here | when the image is read and written |
//! | `journal` | where it lies, and which of several is the newest; power cuts, damage |
//! | `record` | an image's envelope, and whether it is whole |
//! | `image` | what stands in it |
//!
//! Why no key-value store of the crates there are: the flash's contract ([`NorFlash`]) leaves a page whose erase was cut off with
//! undefined contents, and a store that tells a page's state by one byte of it can then take an old page for the one in
//! use. And such a store passes over an item whose checksum is wrong, which is right after a power cut and
//! wrong after damage: an encoder's offset would silently be the default again.

mod envelope;
mod error;
mod image;
mod journal;

use crate::fault::FaultKind;
use crate::gcs::Panel;
use embedded_storage::nor_flash::NorFlash;
use envelope::Head;
pub use error::StoreError;
use journal::{Condition, Journal};

/// Bytes that the longest settings take: a sector must have them.
pub const RECORD_BYTES: usize = Head {
    generation: 0,
    length: image::MOST_BYTES as u32,
}
.record_bytes() as usize;

/// Keeps the settings of a [`Panel`] in flash, which is used from its first byte to its last: two sectors at least, written in
/// words of 4 bytes.
pub struct Keeper<F> {
    journal: Journal<F>,
}

impl<F: NorFlash> Keeper<F> {
    /// With this flash, which is not looked at yet.
    pub const fn new(flash: F) -> Self {
        Self {
            journal: Journal::new(flash),
        }
    }

    /// Gives a panel that has just been made what is kept; it keeps what is to be kept here from now on.
    ///
    /// When that cannot be used the panel has its own parameters and no macros, and the answer is the fault that the tick has
    /// to start with ([`State::with_fault`](crate::control::State::with_fault)).
    pub fn restore(&mut self, panel: &mut Panel) -> Option<FaultKind> {
        let problem = match self.journal.open() {
            Condition::Empty => None,
            Condition::Damaged => Some(FaultKind::SettingsDamaged),
            Condition::Good => {
                let read = match self.journal.newest() {
                    Some(mut reader) => image::read(&mut reader, panel),
                    None => Err(image::Unusable::Damaged),
                };
                match read {
                    Ok(()) => None,
                    Err(image::Unusable::Newer) => Some(FaultKind::SettingsNewer),
                    Err(image::Unusable::Damaged) => Some(FaultKind::SettingsDamaged),
                }
            }
        };
        panel.keeps_settings(problem.is_none());
        problem
    }

    /// Writes what the panel wants to be kept, if it does and the stage is at rest. To be called after every
    /// [`Panel::service`]. Takes as long as the flash does: an erased sector is needed now and then.
    pub fn carry_on(&mut self, panel: &mut Panel) {
        if panel.wants_to_be_kept() {
            let result = self.write(panel);
            panel.was_kept(result);
        }
    }

    /// Writes what the panel wants to be kept.
    ///
    /// # Errors
    /// [`StoreError`]
    pub fn write(&mut self, panel: &Panel) -> Result<(), StoreError> {
        let mut length = image::Length::default();
        // Counting does not fail.
        let _ = image::write(panel, &mut length);
        (self.journal).append(length.bytes(), |writer| image::write(panel, writer))
    }

    /// The flash.
    pub const fn flash(&mut self) -> &mut F {
        self.journal.flash()
    }
}

//! When contents are read and written.

use super::byte_counter::ByteCounter;
use super::error::StoreError;
use super::journal::{FlashState, Journal};
use super::stored_settings::{StoredSettings, Unusable};
use crate::fault::FaultKind;
use embedded_storage::nor_flash::NorFlash;

/// Stores settings in flash, which is used from its first byte to its last: two sectors at least, written in words of 4
/// bytes.
pub struct SettingsStore<F> {
    journal: Journal<F>,
}

impl<F: NorFlash> SettingsStore<F> {
    /// With this flash, which is not looked at yet.
    pub const fn new(flash: F) -> Self {
        Self {
            journal: Journal::new(flash),
        }
    }

    /// Gives settings that have just been made what is stored; they are stored here from now on.
    ///
    /// When what is stored cannot be used the settings stay the defaults, and the answer is the fault that the tick has
    /// to start with ([`State::with_fault`](crate::control::State::with_fault)).
    pub fn restore(&mut self, settings: &mut impl StoredSettings) -> Option<FaultKind> {
        let problem = match self.journal.open() {
            FlashState::Empty => None,
            FlashState::Damaged => Some(FaultKind::SettingsDamaged),
            FlashState::Good => {
                let read = match self.journal.newest() {
                    Some(mut reader) => settings.read(&mut reader),
                    None => Err(Unusable::Damaged),
                };
                match read {
                    Ok(()) => None,
                    Err(Unusable::Newer) => Some(FaultKind::SettingsNewer),
                    Err(Unusable::Damaged) => Some(FaultKind::SettingsDamaged),
                }
            }
        };
        settings.attach_store(problem.is_none());
        problem
    }

    /// Stores the settings if they wait for it and can be stored now. To be called after every
    /// [`service`](crate::gcs::Interpreter::service). Takes as long as the flash does: an erased sector is needed now
    /// and then.
    // A frame of its own: the caller never ends.
    #[inline(never)]
    pub fn store_pending(&mut self, settings: &mut impl StoredSettings) {
        if settings.needs_storing() {
            let result = self.write(settings);
            settings.finish_storing(result);
        }
    }

    /// Writes the settings.
    ///
    /// # Errors
    /// [`StoreError`]
    pub fn write(&mut self, settings: &impl StoredSettings) -> Result<(), StoreError> {
        let mut length = ByteCounter::default();
        // Counting does not fail.
        let _ = settings.write(&mut length);
        (self.journal).append(length.bytes(), |writer| settings.write(writer))
    }

    /// The flash, in which nothing is stored any more.
    pub fn into_flash(self) -> F {
        self.journal.into_flash()
    }

    /// The flash.
    pub const fn flash(&mut self) -> &mut F {
        self.journal.flash()
    }
}

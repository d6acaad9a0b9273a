//! Whoever has settings that survive.

use super::envelope::{Reader, Sink};
use super::error::StoreError;
use embedded_storage::nor_flash::NorFlash;

/// Why contents that are whole cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unusable {
    /// A newer firmware wrote it.
    Newer,
    /// It is not what any firmware writes, or not for this stage.
    Damaged,
}

/// What a [`SettingsStore`](super::SettingsStore) asks of the owner of the settings.
pub trait StoredSettings {
    /// Whether something waits to be stored, and can be now: storing takes long, so the stage has to be at rest.
    fn needs_storing(&self) -> bool;

    /// Writes all that is to be stored; the same each time until something changes.
    ///
    /// # Errors
    /// Those of `sink`.
    fn write<S: Sink>(&self, sink: &mut S) -> Result<(), S::Error>;

    /// Takes what is stored, which is whole.
    ///
    /// # Errors
    /// [`Unusable`]; the settings are then the defaults.
    fn read<F: NorFlash>(&mut self, reader: &mut Reader<'_, F>) -> Result<(), Unusable>;

    /// There is a store from now on; `usable` says whether what was stored could be used.
    fn attach_store(&mut self, usable: bool);

    /// What came of storing.
    fn finish_storing(&mut self, result: Result<(), StoreError>);
}

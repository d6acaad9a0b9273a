//! Names in the store.

use crate::gcs::text::{NAME_BYTES, Name};
use crate::settings_store::{Reader, Sink};
use embedded_storage::nor_flash::NorFlash;

/// A name with its length.
pub(super) fn write_name<S: Sink>(name: &str, sink: &mut S) -> Result<(), S::Error> {
    sink.put(&[name.len() as u8])?;
    sink.put(name.as_bytes())
}

/// What [`write_name`] has written.
pub(super) fn read_name<F: NorFlash>(reader: &mut Reader<'_, F>) -> Option<Name> {
    let [length] = reader.take()?;
    let mut name = [0; NAME_BYTES];
    let name = name.get_mut(..usize::from(length))?;
    reader.fill(name)?;
    Name::named(name)
}

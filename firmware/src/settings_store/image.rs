//! What is kept: the parameters that are not what the controller has by itself, and all macros.
//!
//! | bytes | what |
//! |---|---|
//! | 2 | version of this table |
//! | 2 | number of parameters |
//! | each 4, 8 | id, value as a 64-bit float |
//! | 1 | number of macros |
//! | each 1, n, 2, n | length of the name, name, length of the text, text |
//!
//! Numbers begin with their lowest byte.

use super::envelope::{Reader, Sink};
use crate::gcs::{MACRO_BYTES, MAX_MACROS, NAME_BYTES, Name, PARAMETERS, Panel, Parameter};
use crate::parameters::Parameters;
use core::convert::Infallible;
use embedded_storage::nor_flash::NorFlash;

/// Version of the table above.
const VERSION: u16 = 1;
/// Bytes of a macro read at a time.
const PIECE: usize = 64;

/// Bytes of the longest image.
pub(super) const MOST_BYTES: usize =
    5 + PARAMETERS.len() * 12 + MAX_MACROS * (3 + NAME_BYTES) + MACRO_BYTES;

/// Why an image that is whole cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unusable {
    /// A newer firmware wrote it.
    Newer,
    /// It is not what any firmware writes, or not for this stage.
    Damaged,
}

/// Counts instead of writing.
#[derive(Default)]
pub(super) struct Length(u32);

impl Length {
    pub const fn bytes(&self) -> u32 {
        self.0
    }
}

impl Sink for Length {
    type Error = Infallible;

    fn put(&mut self, bytes: &[u8]) -> Result<(), Infallible> {
        self.0 += bytes.len() as u32;
        Ok(())
    }
}

/// Writes what a panel wants to be kept.
pub(super) fn write<S: Sink>(panel: &Panel, sink: &mut S) -> Result<(), S::Error> {
    sink.put(&VERSION.to_le_bytes())?;
    let (kept, own) = (panel.parameters_to_keep(), panel.own_parameters());
    let count = settings(kept, own).count();
    sink.put(&(count as u16).to_le_bytes())?;
    for (id, value) in settings(kept, own) {
        sink.put(&id.to_le_bytes())?;
        sink.put(&value.to_le_bytes())?;
    }
    sink.put(&[panel.macros().count() as u8])?;
    for (name, text) in panel.macros() {
        let name = name.as_bytes();
        sink.put(&[name.len() as u8])?;
        sink.put(name)?;
        sink.put(&(text.len() as u16).to_le_bytes())?;
        sink.put(text)?;
    }
    Ok(())
}

/// The parameters in which `kept` is not what the controller has by itself.
fn settings(kept: &Parameters, own: &Parameters) -> impl Iterator<Item = (u32, f64)> {
    let settable = PARAMETERS.iter().filter(|p| !p.is_read_only());
    settable.filter_map(|parameter| {
        let (kept, own) = (parameter.number(kept)?, parameter.number(own)?);
        (kept != own).then_some((parameter.id, kept))
    })
}

/// Gives a panel what is kept. With an error it has its own parameters and no macros.
pub(super) fn read<F: NorFlash>(
    reader: &mut Reader<'_, F>,
    panel: &mut Panel,
) -> Result<(), Unusable> {
    let version = u16::from_le_bytes(reader.take().ok_or(Unusable::Damaged)?);
    if version > VERSION {
        return Err(Unusable::Newer);
    }
    let (parameters, unknown) = read_parameters(reader, panel).ok_or(Unusable::Damaged)?;
    if read_macros(reader, panel).is_none() || !reader.is_at_end() {
        panel.forget_macros();
        return Err(Unusable::Damaged);
    }
    panel.restore_parameters(parameters, unknown);
    Ok(())
}

/// The parameters, and how many there are that this firmware does not know: they are left alone. A value that is out of its
/// range is no such thing: `None`, as when they do not go together.
fn read_parameters<F: NorFlash>(
    reader: &mut Reader<'_, F>,
    panel: &Panel,
) -> Option<(Parameters, u16)> {
    let mut parameters = panel.own_parameters().clone();
    let mut unknown = 0;
    for _ in 0..u16::from_le_bytes(reader.take()?) {
        let id = u32::from_le_bytes(reader.take()?);
        let value = f64::from_le_bytes(reader.take()?);
        match Parameter::find(id) {
            Some(parameter) => parameter.set(value, &mut parameters).ok()?,
            None => unknown += 1,
        }
    }
    parameters.are_sound().then_some((parameters, unknown))
}

fn read_macros<F: NorFlash>(reader: &mut Reader<'_, F>, panel: &mut Panel) -> Option<()> {
    let [count] = reader.take()?;
    for _ in 0..count {
        let [length] = reader.take()?;
        let mut name = [0; NAME_BYTES];
        let name = name.get_mut(..usize::from(length))?;
        reader.fill(name)?;
        let name = Name::named(name)?;
        let mut left = usize::from(u16::from_le_bytes(reader.take()?));
        while left > 0 {
            let mut piece = [0; PIECE];
            let piece = &mut piece[..PIECE.min(left)];
            reader.fill(piece)?;
            panel.add_macro_text(piece).then_some(())?;
            left -= piece.len();
        }
        panel.end_macro_text(name).then_some(())?;
    }
    Some(())
}

//! What is stored: the parameters that are not what the controller has by itself, all macros, and the tables of repeated moves that are
//! to be kept.
//!
//! | bytes | what |
//! |---|---|
//! | 2 | version of this table |
//! | 2 | number of parameters |
//! | each 4, 8 | id, value as a 64-bit float |
//! | 1 | number of macros |
//! | each 1, n, 2, n | length of the name, name, length of the text, text |
//! | from version 3 on | tables, see `stored_moves` |
//! | from version 4 on | the calibration, see `stored_calibration` |
//!
//! Numbers begin with their lowest byte.

use super::names::{read_name, write_name};
use super::state::{KeptParameters, MAX_UNUSABLE, UnusableValues};
use super::stored_calibration::{self, CALIBRATION_BYTES};
use super::stored_moves::{self, MOVES_BYTES};
use crate::gcs::error::ErrorCode;
use crate::gcs::interpreter::Interpreter;
use crate::gcs::macros::{MACRO_BYTES, MAX_MACROS};
use crate::gcs::parameter::{PARAMETERS, Parameter};
use crate::gcs::text::NAME_BYTES;
use crate::iterative_learning::TrialControl;
use crate::parameters::Parameters;
use crate::settings_store::{Reader, Sink, StoreError, StoredSettings, Unusable, envelope_bytes};
use embedded_storage::nor_flash::NorFlash;

/// Newest version of the table above, and of what it leaves out: since 2 the controller by itself knows no zeros, so that an older firmware
/// would take its own for those of a machine whose zeros are 0; since 3 there are tables of repeated moves; since 4 there is a calibration.
const VERSION: u16 = 4;
/// The newest without a calibration.
const VERSION_WITHOUT_CALIBRATION: u16 = 3;
/// The newest without tables.
const VERSION_WITHOUT_MOVES: u16 = 2;
/// Bytes of a macro read at a time.
const CHUNK_BYTES: usize = 64;

/// Bytes that the longest settings take in the flash: a sector must have them. Macros of older firmware, which had more room for them, can
/// leave too little for a calibration: that is refused then as too long.
pub const STORED_BYTES: usize = envelope_bytes(MAX_CONTENTS_BYTES as u32) as usize;
/// Bytes of the longest contents.
const MAX_CONTENTS_BYTES: usize = 5
    + MOST_SETTINGS * 12
    + MAX_MACROS * (3 + NAME_BYTES)
    + MACRO_BYTES
    + MOVES_BYTES
    + CALIBRATION_BYTES;
/// Parameters that can be stored, and stored values that are no such ones.
const MOST_SETTINGS: usize = {
    let (mut count, mut i) = (MAX_UNUSABLE, 0);
    while i < PARAMETERS.len() {
        if PARAMETERS[i].is_stored() {
            count += 1;
        }
        i += 1;
    }
    count
};

/// All that is stored: of the command side, and the points of the tables, which lie with those of the trial.
pub struct Contents<'a, 't> {
    interpreter: &'a mut Interpreter,
    trial: &'a mut TrialControl<'t>,
}

impl Interpreter {
    /// What a [`SettingsStore`](crate::settings_store::SettingsStore) stores; the memory of trials is [`CommandQueues::trial`].
    pub const fn contents<'a, 't>(
        &'a mut self,
        trial: &'a mut TrialControl<'t>,
    ) -> Contents<'a, 't> {
        Contents {
            interpreter: self,
            trial,
        }
    }
}

/// Writes what is to be stored.
fn write<S: Sink>(
    interpreter: &Interpreter,
    trial: &TrialControl<'_>,
    sink: &mut S,
) -> Result<(), S::Error> {
    // An older firmware can read what has no tables and no calibration.
    let calibration = interpreter.commander.calibration();
    let has_moves = interpreter.commander.is_move_kept(None);
    let version = if calibration.is_some() {
        VERSION
    } else if has_moves {
        VERSION_WITHOUT_CALIBRATION
    } else {
        VERSION_WITHOUT_MOVES
    };
    sink.put(&version.to_le_bytes())?;
    let (stored, defaults) = (
        interpreter.parameters_to_store(),
        interpreter.default_parameters(),
    );
    let unusable = interpreter.unusable_to_store();
    let kept = || settings(stored, defaults).chain(unusable.iter().copied());
    sink.put(&(kept().count() as u16).to_le_bytes())?;
    for (id, value) in kept() {
        sink.put(&id.to_le_bytes())?;
        sink.put(&value.to_le_bytes())?;
    }
    sink.put(&[interpreter.macros().count() as u8])?;
    for (name, text) in interpreter.macros() {
        write_name(name.as_str(), sink)?;
        sink.put(&(text.len() as u16).to_le_bytes())?;
        sink.put(text)?;
    }
    if version > VERSION_WITHOUT_MOVES {
        stored_moves::write(&interpreter.commander, trial, sink)?;
    }
    if let Some(calibration) = calibration {
        stored_calibration::write(calibration, sink)?;
    }
    Ok(())
}

/// The parameters in which `stored` is not what the controller has by itself.
fn settings(stored: &Parameters, defaults: &Parameters) -> impl Iterator<Item = (u32, f64)> {
    let stored_ones = PARAMETERS.iter().filter(|p| p.is_stored());
    stored_ones.filter_map(|parameter| {
        let (stored, defaults) = (parameter.number(stored)?, parameter.number(defaults)?);
        (stored != defaults).then_some((parameter.id, stored))
    })
}

/// Takes what is stored. With an error it has the default parameters, no macros and no tables.
fn read<F: NorFlash>(
    reader: &mut Reader<'_, F>,
    interpreter: &mut Interpreter,
    trial: &mut TrialControl<'_>,
) -> Result<(), Unusable> {
    let version = u16::from_le_bytes(reader.take().ok_or(Unusable::Damaged)?);
    if version > VERSION {
        return Err(Unusable::Newer);
    }
    let kept = read_parameters(reader, interpreter).ok_or(Unusable::Damaged)?;
    let mut rest = || {
        read_macros(reader, interpreter)?;
        if version > VERSION_WITHOUT_MOVES {
            stored_moves::read(reader, &mut interpreter.commander, trial)?;
        }
        if version > VERSION_WITHOUT_CALIBRATION {
            let calibration = stored_calibration::read(reader)?;
            interpreter.commander.restore_calibration(Some(calibration));
        }
        reader.is_at_end().then_some(())
    };
    if rest().is_none() {
        interpreter.forget_macros();
        interpreter.commander.restore_calibration(None);
        // All of them can be forgotten, whatever there is.
        let _ = interpreter.commander.forget_move(None, trial);
        return Err(Unusable::Damaged);
    }
    interpreter.restore_parameters(kept);
    Ok(())
}

/// What is stored of the parameters. One that this firmware does not know is left alone; a value that it does not allow is told,
/// and the controller's own stands in its place. `None` when they do not go together, or are none that a firmware writes.
fn read_parameters<F: NorFlash>(
    reader: &mut Reader<'_, F>,
    interpreter: &Interpreter,
) -> Option<KeptParameters> {
    let mut kept = KeptParameters {
        parameters: interpreter.default_parameters().clone(),
        unknown: 0,
        unusable: UnusableValues::new(),
    };
    for _ in 0..u16::from_le_bytes(reader.take()?) {
        let id = u32::from_le_bytes(reader.take()?);
        let value = f64::from_le_bytes(reader.take()?);
        match Parameter::find(id) {
            None => kept.unknown += 1,
            Some(parameter) => match parameter.set(value, &mut kept.parameters) {
                Ok(()) => {}
                Err(ErrorCode::OutOfRange) if value.is_finite() => {
                    kept.unusable.push((id, value)).ok()?;
                }
                Err(_) => return None,
            },
        }
    }
    kept.parameters.are_sound().then_some(kept)
}

fn read_macros<F: NorFlash>(
    reader: &mut Reader<'_, F>,
    interpreter: &mut Interpreter,
) -> Option<()> {
    let [count] = reader.take()?;
    for _ in 0..count {
        let name = read_name(reader)?;
        let mut left = usize::from(u16::from_le_bytes(reader.take()?));
        while left > 0 {
            let mut piece = [0; CHUNK_BYTES];
            let piece = &mut piece[..CHUNK_BYTES.min(left)];
            reader.fill(piece)?;
            interpreter.add_macro_text(piece).then_some(())?;
            left -= piece.len();
        }
        interpreter.end_macro_text(name).then_some(())?;
    }
    Some(())
}

impl StoredSettings for Contents<'_, '_> {
    fn needs_storing(&self) -> bool {
        let persistence = &self.interpreter.persistence;
        let unasked = persistence.has_changed && !persistence.stored_is_invalid;
        persistence.has_store
            && (persistence.is_pending() || unasked)
            && !self.interpreter.commander.is_motion_commanded()
    }

    fn write<S: Sink>(&self, sink: &mut S) -> Result<(), S::Error> {
        write(self.interpreter, self.trial, sink)
    }

    fn read<F: NorFlash>(&mut self, reader: &mut Reader<'_, F>) -> Result<(), Unusable> {
        read(reader, self.interpreter, self.trial)
    }

    fn attach_store(&mut self, usable: bool) {
        let persistence = &mut self.interpreter.persistence;
        persistence.has_store = true;
        persistence.stored_is_invalid = !usable;
    }

    fn finish_storing(&mut self, result: Result<(), StoreError>) {
        self.interpreter.storing_finished(result);
    }
}

//! The text of all macros: one block of bytes in which each has a range, line after line, each ended by LF, as it
//! was sent. A range is all that has to be written to store a macro somewhere else, and to be sent to have it
//! again.

use crate::gcs::error::ErrorCode;
use crate::gcs::text::Name;
use heapless::Vec;

/// Bytes for the text of all macros, a line's LF included: what a sector of the flash has besides parameters, tables and a calibration.
pub const MACRO_BYTES: usize = 7232;
/// Older firmware stored as many: they are taken, and with less text there can be new ones.
const MOST_STORED_BYTES: usize = 8192;
/// Macros that can be stored.
pub const MAX_MACROS: usize = 16;

/// See the module. Stretches lie behind one another in no order; what is being recorded comes last.
#[derive(Default)]
pub(super) struct MacroTexts {
    text: Vec<u8, MOST_STORED_BYTES>,
    macros: [Option<TextRange>; MAX_MACROS],
}

#[derive(Clone, Copy)]
struct TextRange {
    name: Name,
    start: u16,
    length: u16,
}

impl MacroTexts {
    /// Bytes left.
    pub fn free(&self) -> usize {
        MACRO_BYTES.saturating_sub(self.text.len())
    }

    /// Names of all macros.
    pub fn names(&self) -> impl Iterator<Item = &Name> {
        self.macros
            .iter()
            .flatten()
            .map(|text_range| &text_range.name)
    }

    /// The place of the macro of this name: it stays the same as long as there is one.
    pub fn find(&self, name: &Name) -> Option<usize> {
        let is_it = |text_range: &Option<TextRange>| text_range.is_some_and(|s| s.name == *name);
        self.macros.iter().position(is_it)
    }

    /// The name of the macro at a place.
    pub fn name(&self, place: usize) -> Name {
        self.text_range(place)
            .map_or(Name::EMPTY, |text_range| text_range.name)
    }

    /// The text of the macro at a place.
    pub fn text(&self, place: usize) -> &[u8] {
        let text_range = self.text_range(place);
        let text = text_range.and_then(|s| {
            let start = usize::from(s.start);
            self.text.get(start..start + usize::from(s.length))
        });
        text.unwrap_or_default()
    }

    /// Adds a line to what is being recorded; false, and nothing is added, when there is no room.
    pub fn append(&mut self, line: &[u8]) -> bool {
        if line.len() >= self.free() {
            return false;
        }
        self.text.extend_from_slice(line).is_ok() && self.text.push(b'\n').is_ok()
    }

    /// Adds text as it was stored; false, and nothing is added, when there is no room.
    pub fn extend(&mut self, text: &[u8]) -> bool {
        self.text.extend_from_slice(text).is_ok()
    }

    /// Names and texts of all macros.
    pub fn all(&self) -> impl Iterator<Item = (Name, &[u8])> {
        let places = (0..MAX_MACROS).filter(|&place| self.text_range(place).is_some());
        places.map(|place| (self.name(place), self.text(place)))
    }

    /// Takes what was recorded as the macro of this name; one that had it is gone. With an error nothing of it is left.
    pub fn commit(&mut self, name: Name) -> Result<(), ErrorCode> {
        let old = self.find(&name);
        let Some(place) = old.or_else(|| self.macros.iter().position(Option::is_none)) else {
            self.discard_recording();
            return Err(ErrorCode::NoMemory);
        };
        self.remove(place);
        let start = self.committed_bytes();
        self.macros[place] = Some(TextRange {
            name,
            start: start as u16,
            length: (self.text.len() - start) as u16,
        });
        Ok(())
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.text.clear();
        self.macros = [None; MAX_MACROS];
    }

    /// Forgets what was recorded.
    pub fn discard_recording(&mut self) {
        self.text.truncate(self.committed_bytes());
    }

    /// Removes the macro at a place, if there is one; the text behind it moves up.
    pub fn remove(&mut self, place: usize) {
        let Some(gone) = self.macros.get_mut(place).and_then(Option::take) else {
            return;
        };
        let end = usize::from(gone.start + gone.length);
        self.text.copy_within(end.., usize::from(gone.start));
        self.text
            .truncate(self.text.len() - usize::from(gone.length));
        for text_range in self.macros.iter_mut().flatten() {
            if text_range.start > gone.start {
                text_range.start -= gone.length;
            }
        }
    }

    /// Bytes of the macros that are stored: what is being recorded starts behind them.
    fn committed_bytes(&self) -> usize {
        let lengths = self.macros.iter().flatten().map(|s| usize::from(s.length));
        lengths.sum()
    }

    fn text_range(&self, place: usize) -> Option<&TextRange> {
        self.macros.get(place)?.as_ref()
    }
}

/// The lines of a macro's text.
pub(super) fn lines(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split_inclusive(|&byte| byte == b'\n')
        .map(|line| line.strip_suffix(b"\n").unwrap_or(line))
}

#[cfg(test)]
mod tests {
    use super::{MOST_STORED_BYTES, MacroTexts};
    use crate::gcs::text::Name;

    /// As many as there could be before there was room for a calibration: they are taken, and nothing new besides.
    #[test]
    fn what_older_firmware_has_stored_is_taken() {
        let mut texts = MacroTexts::default();
        let line = b"VAR A 1\n";
        for _ in 0..MOST_STORED_BYTES / line.len() {
            assert!(texts.extend(line));
        }
        let name = Name::new(b"old").expect("a short name");
        assert_eq!(texts.commit(name), Ok(()));
        assert_eq!(texts.free(), 0);
        assert!(!texts.append(b"VAR A 1"));
        texts.remove(0);
        assert!(texts.append(b"VAR A 1"));
    }
}

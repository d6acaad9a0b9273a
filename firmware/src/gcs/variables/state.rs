//! The variables there are, and their places in a line.

use crate::gcs::error::ErrorCode;
use crate::gcs::text::{LINE_BYTES, Name, Text, is_name_byte};
use core::fmt::Write;
use heapless::Vec;

/// Variables that a connection can have, and that macros can have together, besides their local ones.
pub const MAX_VARIABLES: usize = 32;

/// Variables 0 to 9 of a running macro.
pub(in crate::gcs) type Locals = [Option<Text>; 10];

/// Variables of a connection, or of all macros.
#[derive(Default)]
pub(in crate::gcs) struct Variables {
    entries: Vec<(Name, Text), MAX_VARIABLES>,
}

impl Variables {
    /// All of them, in the order in which they were first set.
    pub fn iter(&self) -> impl Iterator<Item = &(Name, Text)> {
        self.entries.iter()
    }

    /// The value of one.
    pub fn get(&self, name: &Name) -> Option<&Text> {
        (self.entries.iter().find(|(other, _)| other == name)).map(|(_, value)| value)
    }

    /// Sets one, or forgets it.
    pub fn set(&mut self, name: &Name, value: Option<Text>) -> Result<(), ErrorCode> {
        let place = self.entries.iter().position(|(other, _)| other == name);
        match (place, value) {
            (Some(place), Some(value)) => self.entries[place].1 = value,
            (Some(place), None) => {
                self.entries.remove(place);
            }
            (None, Some(value)) => {
                let pair = (*name, value);
                self.entries.push(pair).map_err(|_| ErrorCode::NoMemory)?;
            }
            (None, None) => return Err(ErrorCode::UnknownVariable),
        }
        Ok(())
    }

    /// Takes all of another's, or none where there is no room for them.
    pub fn take(&mut self, others: &mut Self) -> Result<(), ErrorCode> {
        let new = (others.iter()).filter(|(name, _)| self.get(name).is_none());
        if self.entries.len() + new.count() > self.entries.capacity() {
            return Err(ErrorCode::NoMemory);
        }
        for (name, value) in core::mem::take(&mut others.entries) {
            self.set(&name, Some(value))?;
        }
        Ok(())
    }
}

/// The line with the values of its variables in their places.
pub(in crate::gcs) fn expand<'a>(
    line: &[u8],
    value: impl Fn(&Name) -> Option<&'a Text>,
) -> Result<Vec<u8, LINE_BYTES>, ErrorCode> {
    let mut expanded = Vec::new();
    let mut rest = line;
    while let Some(at) = rest.iter().position(|&byte| byte == b'$') {
        append(&mut expanded, &rest[..at])?;
        let (name, rest_of_line) = reference(&rest[at + 1..])?;
        let value = value(&name).ok_or(ErrorCode::UnknownVariable)?;
        append(&mut expanded, value.as_bytes())?;
        rest = rest_of_line;
    }
    append(&mut expanded, rest)?;
    Ok(expanded)
}

fn append(line: &mut Vec<u8, LINE_BYTES>, bytes: &[u8]) -> Result<(), ErrorCode> {
    line.extend_from_slice(bytes)
        .map_err(|_| ErrorCode::LineTooLong)
}

/// The name behind a `$`, and what follows it.
fn reference(text: &[u8]) -> Result<(Name, &[u8]), ErrorCode> {
    let (name, rest_of_line) = match text.strip_prefix(b"{") {
        Some(inside) => {
            let end = inside.iter().position(|&byte| byte == b'}');
            let end = end.ok_or(ErrorCode::InvalidIdentifier)?;
            (&inside[..end], &inside[end + 1..])
        }
        None => {
            let end = text.iter().position(|&byte| !is_name_byte(byte));
            text.split_at(end.unwrap_or(text.len()))
        }
    };
    let name = Name::named(name).ok_or(ErrorCode::InvalidIdentifier)?;
    Ok((name, rest_of_line))
}

/// A number as the value of a variable: in full where that fits, which it does for all but the largest and the
/// smallest.
pub(in crate::gcs) fn number_text(number: f64) -> Result<Text, ErrorCode> {
    if !number.is_finite() {
        return Err(ErrorCode::OutOfRange);
    }
    let mut text = Text::EMPTY;
    if write!(text, "{number}").is_ok() {
        return Ok(text);
    }
    text = Text::EMPTY;
    write!(text, "{number:e}").map_err(|_| ErrorCode::NoMemory)?;
    Ok(text)
}

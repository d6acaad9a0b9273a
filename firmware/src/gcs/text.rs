//! Names and short texts, without a heap.

use core::fmt;

/// Longest line, without its LF.
pub const LINE_BYTES: usize = 256;
/// Longest name of a macro or a variable.
pub const NAME_BYTES: usize = 16;
/// Longest value of a variable, and longest argument of a macro.
pub const TEXT_BYTES: usize = 32;

/// Up to `N` printable characters.
#[derive(Clone, Copy)]
pub struct FixedText<const N: usize> {
    bytes: [u8; N],
    length: u8,
}

/// Of a macro or a variable: letters, digits and underscores.
pub type Name = FixedText<NAME_BYTES>;
/// Value of a variable, or argument of a macro.
pub type Text = FixedText<TEXT_BYTES>;

impl<const N: usize> FixedText<N> {
    /// No character.
    pub const EMPTY: Self = Self {
        bytes: [0; N],
        length: 0,
    };

    /// These characters; `None` when they are too many, or one cannot be printed.
    pub fn new(text: &[u8]) -> Option<Self> {
        let mut fixed = Self::EMPTY;
        fixed.bytes.get_mut(..text.len())?.copy_from_slice(text);
        fixed.length = u8::try_from(text.len()).ok()?;
        text.iter()
            .all(|byte| matches!(byte, b' '..=b'~'))
            .then_some(fixed)
    }

    /// The characters.
    pub fn as_bytes(&self) -> &[u8] {
        self.bytes
            .get(..usize::from(self.length))
            .unwrap_or_default()
    }

    /// The characters.
    pub fn as_str(&self) -> &str {
        // They are ASCII by construction.
        core::str::from_utf8(self.as_bytes()).unwrap_or_default()
    }
}

impl Name {
    /// A name: letters, digits and underscores, one at least.
    pub fn named(text: &[u8]) -> Option<Self> {
        let good = |byte: &u8| is_name_byte(*byte);
        (!text.is_empty() && text.iter().all(good))
            .then(|| Self::new(text))
            .flatten()
    }

    /// The digit of which a name consists, if it does: the name of a local variable.
    pub fn digit(&self) -> Option<usize> {
        match *self.as_bytes() {
            [digit @ b'0'..=b'9'] => Some(usize::from(digit - b'0')),
            _ => None,
        }
    }
}

/// Whether a byte can be part of a name.
pub(super) const fn is_name_byte(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

impl<const N: usize> Default for FixedText<N> {
    fn default() -> Self {
        Self::EMPTY
    }
}

/// In either case, as everything of the language.
impl<const N: usize> PartialEq for FixedText<N> {
    fn eq(&self, other: &Self) -> bool {
        self.as_bytes().eq_ignore_ascii_case(other.as_bytes())
    }
}

impl<const N: usize> fmt::Display for FixedText<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

impl<const N: usize> fmt::Debug for FixedText<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.as_str())
    }
}

/// What is formatted into it: an error when it does not fit.
impl<const N: usize> fmt::Write for FixedText<N> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        let start = usize::from(self.length);
        let end = start + text.len();
        let room = self.bytes.get_mut(start..end).ok_or(fmt::Error)?;
        room.copy_from_slice(text.as_bytes());
        self.length = end as u8;
        Ok(())
    }
}

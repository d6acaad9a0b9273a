//! Names of frames.

use core::fmt;

/// Longest name.
pub const FRAME_NAME_BYTES: usize = 16;

/// A name: a letter, then letters, digits and underscores, at most [`FRAME_NAME_BYTES`] of them. Either case is the
/// same name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameName {
    letters: [u8; FRAME_NAME_BYTES],
    length: u8,
}

impl FrameName {
    /// The name of the frame that is always there: the base frame of the stage.
    pub const ZERO: Self = Self {
        letters: *b"ZERO\0\0\0\0\0\0\0\0\0\0\0\0",
        length: 4,
    };

    /// The name that a word spells; `0` spells `ZERO`.
    pub fn new(word: &[u8]) -> Option<Self> {
        if word == b"0" {
            return Some(Self::ZERO);
        }
        let belongs = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
        let good = word.first().is_some_and(u8::is_ascii_alphabetic) && word.iter().all(belongs);
        if !good || word.len() > FRAME_NAME_BYTES {
            return None;
        }
        let mut letters = [0; FRAME_NAME_BYTES];
        for (letter, byte) in letters.iter_mut().zip(word) {
            *letter = byte.to_ascii_uppercase();
        }
        Some(Self {
            letters,
            length: word.len() as u8,
        })
    }
}

impl fmt::Display for FrameName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let letters = self.letters.iter().take(usize::from(self.length));
        for &letter in letters {
            fmt::Write::write_char(f, char::from(letter))?;
        }
        Ok(())
    }
}

//! Replies, streamed: every line but the last ends in space LF, the last in LF alone.

use core::fmt;
use embedded_io::{Write, WriteFmtError};

/// A reply under way, of one line or several.
pub(super) struct Reply<'w, W> {
    out: &'w mut W,
    started: bool,
}

impl<'w, W: Write> Reply<'w, W> {
    pub const fn new(out: &'w mut W) -> Self {
        Self {
            out,
            started: false,
        }
    }

    /// One more line.
    pub fn line(&mut self, text: fmt::Arguments<'_>) -> Result<(), W::Error> {
        if self.started {
            self.out.write_all(b" \n")?;
        }
        self.started = true;
        self.more(text)
    }

    /// More of the last line.
    pub fn more(&mut self, text: fmt::Arguments<'_>) -> Result<(), W::Error> {
        match self.out.write_fmt(text) {
            Err(WriteFmtError::Other(error)) => Err(error),
            // Nothing that is formatted here fails by itself.
            Ok(()) | Err(WriteFmtError::FmtError) => Ok(()),
        }
    }

    /// The end of the last line.
    pub fn end(self) -> Result<(), W::Error> {
        self.out.write_all(b"\n")
    }
}

/// A reply of one line.
pub(super) fn one_line<W: Write>(out: &mut W, text: fmt::Arguments<'_>) -> Result<(), W::Error> {
    let mut reply = Reply::new(out);
    reply.line(text)?;
    reply.end()
}

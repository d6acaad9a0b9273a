//! Replies, streamed: every line but the last ends in space LF, the last in LF alone.

use super::output::{Output, WriteFailed};
use core::fmt;
use embedded_io::WriteFmtError;

/// A reply under way, of one line or several.
pub(super) struct ReplyWriter<'w> {
    out: &'w mut Output<'w>,
    started: bool,
}

impl<'w> ReplyWriter<'w> {
    pub const fn new(out: &'w mut Output<'_>) -> Self {
        Self {
            out,
            started: false,
        }
    }

    /// One more line.
    pub fn line(&mut self, text: fmt::Arguments<'_>) -> Result<(), WriteFailed> {
        if self.started {
            self.out.write_all(b" \n")?;
        }
        self.started = true;
        self.continue_line(text)
    }

    /// More of the last line.
    pub fn continue_line(&mut self, text: fmt::Arguments<'_>) -> Result<(), WriteFailed> {
        match self.out.write_fmt(text) {
            Err(WriteFmtError::Other(error)) => Err(error),
            // Nothing that is formatted here fails by itself.
            Ok(()) | Err(WriteFmtError::FmtError) => Ok(()),
        }
    }

    /// The end of the last line.
    pub fn end(self) -> Result<(), WriteFailed> {
        self.out.write_all(b"\n")
    }
}

/// A reply of one line.
pub(super) fn one_line(out: &mut Output<'_>, text: fmt::Arguments<'_>) -> Result<(), WriteFailed> {
    let mut reply = ReplyWriter::new(out);
    reply.line(text)?;
    reply.end()
}

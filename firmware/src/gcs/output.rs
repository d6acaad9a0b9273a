//! Where replies go. What writes them is in the image once, whatever the connection is made of: everything below
//! [`Interpreter::service`](super::Interpreter::service) knows an [`Output`] only.

use core::fmt;
use embedded_io::{ErrorType, Write};

/// The connection does not take what is written; [`Connected::error`] has the reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct WriteFailed;

impl fmt::Display for WriteFailed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the connection does not take what is written")
    }
}

impl core::error::Error for WriteFailed {}

impl embedded_io::Error for WriteFailed {
    fn kind(&self) -> embedded_io::ErrorKind {
        embedded_io::ErrorKind::Other
    }
}

/// Where replies are written to.
pub(super) type Output<'w> = dyn Write<Error = WriteFailed> + 'w;

/// The writer of a connection, and its error once it has failed.
pub(super) struct Connected<'w, W: Write> {
    writer: &'w mut W,
    /// Why the writer has failed.
    pub error: Option<W::Error>,
}

impl<'w, W: Write> Connected<'w, W> {
    pub const fn new(writer: &'w mut W) -> Self {
        Self {
            writer,
            error: None,
        }
    }

    fn noted<T>(&mut self, result: Result<T, W::Error>) -> Result<T, WriteFailed> {
        result.map_err(|error| {
            self.error = Some(error);
            WriteFailed
        })
    }
}

impl<W: Write> ErrorType for Connected<'_, W> {
    type Error = WriteFailed;
}

impl<W: Write> Write for Connected<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, WriteFailed> {
        let result = self.writer.write(bytes);
        self.noted(result)
    }

    fn flush(&mut self) -> Result<(), WriteFailed> {
        let result = self.writer.flush();
        self.noted(result)
    }

    // The writer's own, which may do more at a time than the trait's.
    fn write_all(&mut self, bytes: &[u8]) -> Result<(), WriteFailed> {
        let result = self.writer.write_all(bytes);
        self.noted(result)
    }
}

/// Takes everything and keeps nothing: where the replies to a macro's queries go.
pub(super) struct Discard;

impl ErrorType for Discard {
    type Error = WriteFailed;
}

impl Write for Discard {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, WriteFailed> {
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<(), WriteFailed> {
        Ok(())
    }
}

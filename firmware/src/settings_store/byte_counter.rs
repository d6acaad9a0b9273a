//! How long contents are, before they are written.

use super::envelope::Sink;
use core::convert::Infallible;

/// Counts instead of writing.
#[derive(Default)]
pub(super) struct ByteCounter(u32);

impl ByteCounter {
    pub const fn bytes(&self) -> u32 {
        self.0
    }
}

impl Sink for ByteCounter {
    type Error = Infallible;

    fn put(&mut self, bytes: &[u8]) -> Result<(), Infallible> {
        self.0 += bytes.len() as u32;
        Ok(())
    }
}

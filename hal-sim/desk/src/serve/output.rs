//! Replies that wait to be read by their client.

use std::io::{self, Write};

use embedded_io::{Error, ErrorKind, ErrorType};

/// Bytes that may wait: more than any client that reads will ever see waiting.
const LIMIT_BYTES: usize = 4 << 20;

/// Bytes on their way to a client.
#[derive(Debug, Default)]
pub(super) struct Output {
    bytes: Vec<u8>,
    /// How many of them are gone already.
    gone: usize,
}

/// There are more replies waiting than a client that reads leaves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Overflow;

impl core::fmt::Display for Overflow {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("too many replies are waiting to be read")
    }
}

impl core::error::Error for Overflow {}

impl Error for Overflow {
    fn kind(&self) -> ErrorKind {
        ErrorKind::OutOfMemory
    }
}

impl ErrorType for Output {
    type Error = Overflow;
}

impl embedded_io::Write for Output {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Overflow> {
        if self.len() + bytes.len() > LIMIT_BYTES {
            return Err(Overflow);
        }
        self.bytes.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<(), Overflow> {
        Ok(())
    }
}

impl Output {
    /// Bytes waiting.
    pub fn len(&self) -> usize {
        self.bytes.len() - self.gone
    }

    /// Writes what `to` takes without blocking; says whether it took anything.
    pub fn write_to(&mut self, to: &mut impl Write) -> io::Result<bool> {
        let before = self.len();
        while self.len() > 0 {
            match to.write(&self.bytes[self.gone..]) {
                Ok(0) => return Err(io::ErrorKind::WriteZero.into()),
                Ok(count) => self.gone += count,
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => break,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        let taken = before > self.len();
        if self.len() == 0 {
            self.bytes.clear();
            self.gone = 0;
        } else if self.gone > self.len() {
            self.bytes.drain(..self.gone);
            self.gone = 0;
        }
        Ok(taken)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_io::Write as _;

    /// Takes so many bytes, then no more.
    struct Narrow(usize, Vec<u8>);

    impl Write for Narrow {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            let count = bytes.len().min(self.0).min(3);
            if count == 0 {
                return Err(io::ErrorKind::WouldBlock.into());
            }
            self.0 -= count;
            self.1.extend_from_slice(&bytes[..count]);
            Ok(count)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn nothing_is_lost_or_doubled_whatever_is_taken_at_a_time() {
        let mut output = Output::default();
        let mut to = Narrow(0, Vec::new());
        let mut expected = Vec::new();
        for round in 0..100_usize {
            let text = format!("reply {round}\n");
            output.write_all(text.as_bytes()).unwrap();
            expected.extend(text.bytes());
            to.0 = round % 17;
            let taken = output.write_to(&mut to).unwrap();
            assert_eq!(taken, round % 17 > 0, "{round}");
        }
        to.0 = usize::MAX;
        output.write_to(&mut to).unwrap();
        assert_eq!((to.1, output.len()), (expected, 0));
    }

    #[test]
    fn what_is_not_read_is_bounded() {
        let mut output = Output::default();
        let block = [0; 4096];
        let blocks = (0..10_000)
            .take_while(|_| output.write_all(&block).is_ok())
            .count();
        assert_eq!(blocks * block.len(), LIMIT_BYTES);
    }
}

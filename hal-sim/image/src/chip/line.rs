//! The far end of the command interface: bytes in, bytes out.

use rigless::chip::Timeline;
use rigless::chip::uart::Peer;
use rigless::snapshot::Store;
use rigless::time::VirtualNanos;
use std::collections::VecDeque;

/// The host's end of the serial line.
#[derive(Debug, Default)]
pub struct HostLine {
    to_chip: VecDeque<u8>,
    from_chip: Vec<u8>,
    sent: Vec<(u64, u8)>,
}

impl HostLine {
    /// Queues bytes; they go out at the rate of the line.
    pub fn send(&mut self, bytes: &[u8]) {
        self.to_chip.extend(bytes);
    }

    /// How many bytes have not gone out yet.
    pub fn waiting(&self) -> usize {
        self.to_chip.len()
    }

    /// The bytes that have gone out to the chip since the last call, each with the instant at which it began.
    pub fn take_sent(&mut self) -> Vec<(u64, u8)> {
        std::mem::take(&mut self.sent)
    }

    /// What the chip has sent since the last call.
    pub fn take_received(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.from_chip)
    }
}

impl Store for HostLine {}

impl Peer for HostLine {
    fn receive(&mut self, word: u16, _context: &mut Timeline<'_, '_>) {
        self.from_chip.push(word.to_le_bytes()[0]);
    }

    fn transmit(&mut self, now: VirtualNanos) -> Option<u16> {
        let byte = self.to_chip.pop_front()?;
        self.sent.push((now.0, byte));
        Some(u16::from(byte))
    }
}

//! The encoder's end of an SPI port: it answers the frame it was given, byte by byte.

use rigless::chip::Timeline;
use rigless::chip::spi::Peer;
use rigless::snapshot::Store;
use rigless::time::VirtualNanos;

/// What an idle line reads.
const IDLE: u32 = 0xFF;

/// One encoder's line.
#[derive(Debug, Default)]
pub struct EncoderLine {
    frame: [u8; 8],
    next: usize,
    clocked_at: Option<(VirtualNanos, VirtualNanos)>,
}

impl EncoderLine {
    /// Latches a frame for the transfer to come.
    pub fn latch(&mut self, frame: [u8; 8]) {
        self.frame = frame;
        self.next = 0;
    }

    /// When the first and the last byte of the last frame were clocked.
    pub fn clocked_at(&self) -> Option<(VirtualNanos, VirtualNanos)> {
        self.clocked_at
    }
}

impl Store for EncoderLine {}

impl Peer for EncoderLine {
    fn transfer(&mut self, _mosi: u32, bits: u8, context: &mut Timeline<'_, '_>) -> u32 {
        // Whoever clocks other than bytes has the port set up wrongly, and is answered by a line without life.
        if bits != 8 {
            return 0;
        }
        let byte = self
            .frame
            .get(self.next)
            .map_or(IDLE, |byte| u32::from(*byte));
        let now = context.now();
        let first = self
            .clocked_at
            .filter(|_| self.next > 0)
            .map_or(now, |(first, _)| first);
        self.clocked_at = Some((first, now));
        self.next += 1;
        byte
    }
}

//! The encoder's end of an SPI port: it answers the frame it was given, byte by byte.

use rigless::chip::Timeline;
use rigless::chip::spi::Peer;
use rigless::snapshot::Store;

/// What an idle line reads.
const IDLE: u32 = 0xFF;

/// One encoder's line.
#[derive(Debug, Default)]
pub struct EncoderLine {
    frame: [u8; 8],
    next: usize,
    crossed_ns: [u64; 8],
}

impl EncoderLine {
    /// When the first byte of the last frame crossed, and the last, ns.
    pub fn crossed_ns(&self) -> [u64; 2] {
        let [first, .., last] = self.crossed_ns;
        [first, last]
    }

    /// Latches a frame for the transfer to come.
    pub fn latch(&mut self, frame: [u8; 8]) {
        self.frame = frame;
        self.next = 0;
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
        if let Some(crossed_ns) = self.crossed_ns.get_mut(self.next) {
            *crossed_ns = context.now().0;
        }
        self.next += 1;
        byte
    }
}

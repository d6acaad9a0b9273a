//! BiSS-C absolute encoder, read as 64 bits over an SPI bus.
//!
//! ```text
//! MA  _|~|_|~|_ ...                                            clocks of one SPI transfer
//! SLO ~~~~~\______/~~\__/ 26 bit position /e/w/ CRC-6 /~~~     most significant bit first
//!      idle  ack   1   0                  low: error, warning
//! ```
//!
//! The acknowledge is as long as the encoder needs, so the frame is aligned on the bits themselves. The CRC (polynomial
//! 0x43, start value 0, sent inverted) covers position and flags.

use embedded_hal::spi::SpiBus;

/// Position bits.
pub const POSITION_BITS: u32 = 26;
/// Position, error, warning, CRC.
const PAYLOAD_BITS: u32 = POSITION_BITS + 2 + 6;
/// Start bit and the zero bit after it.
const HEAD_BITS: u32 = 2;
/// The zero bit, where the start bit is bit 31.
const ZERO_BIT: u32 = 1 << 30;

const CRC_MASK: u32 = 0x3F;

/// CRC of position and flags, not inverted, in the lowest six bits; what lies above them means nothing.
///
/// It is what they leave, times x^6, over the polynomial x^6 + x + 1. There x^6 is as good as x + 1, and its square x^12
/// as good as x^2 + 1: two folds of 12 bits and one of 6 do without a table, which would have to be read from flash.
#[inline]
fn crc(covered: u32) -> u32 {
    let high = covered >> 12;
    let folded = high ^ high << 2;
    let above = folded >> 12;
    let low = covered ^ folded ^ above ^ above << 2;
    let (six, rest) = (low >> 6 & CRC_MASK, low & CRC_MASK);
    let times = six ^ six << 2 ^ rest ^ rest << 1;
    let above = times >> 6;
    times ^ above ^ above << 1
}

/// The eight bytes of a transfer, as they came.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RawFrame(pub [u8; 8]);

impl RawFrame {
    /// What an idle line gives; stands for a frame that did not come.
    pub const MISSING: Self = Self([0xFF; 8]);

    /// Bits before the start bit of a frame whose CRC fits: what the encoder takes to answer. More than
    /// [`MOST_BITS_BEFORE_START`] there can not be.
    pub fn bits_before_start(&self) -> Option<u32> {
        check_frame(self).ok()?;
        let bits = u64::from_be_bytes(self.0);
        let idle = bits.leading_ones();
        Some(idle + bits.wrapping_shl(idle).leading_zeros())
    }
}

/// A frame that begins later does not end within the 64 bits.
pub const MOST_BITS_BEFORE_START: u32 = 64 - HEAD_BITS - PAYLOAD_BITS;

/// A frame that can be believed, as far as the frame alone can tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reading {
    /// Position, 26 bits.
    pub counts: u32,
    /// The encoder warns (dirt, end of life); the position is good.
    pub warning: bool,
}

/// Why a frame is no position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameError {
    /// The line never answered, or not in time.
    Silent,
    /// The CRC does not fit, or the bit after the start bit is not zero.
    Crc,
    /// The encoder reports an error of its own.
    Error,
}

/// Decodes one frame.
#[inline]
pub fn decode(frame: &RawFrame) -> Result<Reading, FrameError> {
    check_frame(frame).and_then(CheckedFrame::reading)
}

/// What the CRC of a frame covers, and fits: position, error and warning, 28 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CheckedFrame(u32);

impl CheckedFrame {
    /// Error and warning, both active low.
    const FLAGS: u32 = 0b11;

    /// The position, if the encoder has nothing else to say.
    #[inline]
    pub fn plain_position(self) -> Option<u32> {
        (self.0 & Self::FLAGS == Self::FLAGS).then_some(self.0 >> 2)
    }

    /// All of it.
    #[inline]
    pub fn reading(self) -> Result<Reading, FrameError> {
        if self.0 & 0b10 == 0 {
            return Err(FrameError::Error);
        }
        Ok(Reading {
            counts: self.0 >> 2,
            warning: self.0 & 0b01 == 0,
        })
    }
}

/// Finds a frame in the bits and checks its CRC. One that is whole starts in the first 28 bits, so the chip looks for
/// it in one register.
#[inline]
pub fn check_frame(frame: &RawFrame) -> Result<CheckedFrame, FrameError> {
    let [a, b, c, d, e, f, g, h] = frame.0;
    let (first, second) = (
        u32::from_be_bytes([a, b, c, d]),
        u32::from_be_bytes([e, f, g, h]),
    );
    let idle = first.leading_ones();
    let acknowledge = first.wrapping_shl(idle).leading_zeros();
    // At least one: the first bit is either idle or acknowledge.
    let start = idle + acknowledge;
    if start > MOST_BITS_BEFORE_START {
        return Err(FrameError::Silent);
    }
    // Start bit, zero bit, position, flags and two bits of the CRC; then its other four.
    let head = first.wrapping_shl(start) | second.wrapping_shr(32 - start);
    let tail = second.wrapping_shl(start) >> 28;
    let covered = head << HEAD_BITS >> 4;
    let sent = head << 4 | tail;
    if head & ZERO_BIT != 0 || (crc(covered) ^ sent) & CRC_MASK != CRC_MASK {
        return Err(FrameError::Crc);
    }
    Ok(CheckedFrame(covered))
}

/// Reads a frame over a blocking bus: the host's way, and that of boards that have no DMA to spare.
pub fn read<B: SpiBus<u8>>(bus: &mut B) -> Result<RawFrame, B::Error> {
    let mut bytes = RawFrame::MISSING.0;
    bus.read(&mut bytes)?;
    Ok(RawFrame(bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The CRC bit by bit, as the standard writes it.
    fn crc_by_hand(covered: u32) -> u8 {
        let mut remainder = 0u8;
        for i in (0..28).rev() {
            let bit = (covered >> i) as u8 & 1;
            let out = remainder >> 5 & 1;
            remainder = (remainder << 1) & 0x3F;
            if out ^ bit == 1 {
                remainder ^= 0x03;
            }
        }
        !remainder & 0x3F
    }

    fn frame(counts: u32, flags: u32, idle: u32, acknowledge: u32) -> RawFrame {
        let covered = counts << 2 | flags;
        let payload = u64::from(covered) << 6 | u64::from(crc_by_hand(covered));
        let body = 0b10 << PAYLOAD_BITS | payload;
        let used = idle + acknowledge + HEAD_BITS + PAYLOAD_BITS;
        let bits = body << (64 - used) | !(u64::MAX >> idle);
        RawFrame(bits.to_be_bytes())
    }

    #[test]
    fn finds_the_position_behind_any_acknowledge() {
        for counts in [0, 1, 0x2AA_AAAA, 0x3FF_FFFF, 12_345_678] {
            for idle in 1..4 {
                for acknowledge in 1..25 {
                    let came = frame(counts, 0b11, idle, acknowledge);
                    assert_eq!(came.bits_before_start(), Some(idle + acknowledge));
                    let reading = decode(&came);
                    let expected = Reading {
                        counts,
                        warning: false,
                    };
                    assert_eq!(reading, Ok(expected), "{idle} {acknowledge}");
                }
            }
        }
    }

    #[test]
    fn flags_are_active_low() {
        assert_eq!(decode(&frame(5, 0b01, 1, 3)), Err(FrameError::Error));
        let reading = decode(&frame(5, 0b10, 1, 3)).unwrap();
        assert!(reading.warning && reading.counts == 5);
    }

    #[test]
    fn any_flipped_payload_bit_is_caught() {
        let good = u64::from_be_bytes(frame(0x155_5555, 0b11, 2, 5).0);
        let first = 64 - 2 - 5 - HEAD_BITS - PAYLOAD_BITS;
        for bit in first..first + PAYLOAD_BITS {
            let bad = RawFrame((good ^ 1 << bit).to_be_bytes());
            assert_eq!(decode(&bad), Err(FrameError::Crc), "bit {bit}");
        }
    }

    #[test]
    fn a_line_stuck_at_either_level_is_silent() {
        for byte in [0x00, 0xFF] {
            assert_eq!(decode(&RawFrame([byte; 8])), Err(FrameError::Silent));
        }
    }
}

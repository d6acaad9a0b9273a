//! BiSS-C absolute encoder, read as 64 bits over an SPI bus.
//!
//! ```text
//! MA  _|~|_|~|_ ...                                            clocks of one SPI transfer
//! SLO ~~~~~\______/~~\__/ 26 bit position /e/w/ CRC-6 /~~~     most significant bit first
//!      idle  ack   1   0                  low: error, warning
//! ```
//!
//! The acknowledge is as long as the encoder needs, so the frame is aligned on the bits themselves. The CRC (polynomial 0x43,
//! start value 0, sent inverted) covers position and flags.

use crc::{Algorithm, Crc, Table};
use embedded_hal::spi::SpiBus;

/// Position bits.
pub const POSITION_BITS: u32 = 26;
/// Position, error, warning, CRC.
const PAYLOAD_BITS: u32 = POSITION_BITS + 2 + 6;
/// Start bit and the zero bit after it.
const HEAD_BITS: u32 = 2;

const CRC_6: Algorithm<u8> = Algorithm {
    width: 6,
    poly: 0x03,
    init: 0,
    refin: false,
    refout: false,
    xorout: 0x3F,
    check: 0,
    residue: 0,
};
static CRC: Crc<u8, Table<1>> = Crc::<u8, Table<1>>::new(&CRC_6);

/// The eight bytes of a transfer, as they came.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RawFrame(pub [u8; 8]);

impl RawFrame {
    /// What an idle line gives; stands for a frame that did not come.
    pub const MISSING: Self = Self([0xFF; 8]);
}

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
    let bits = u64::from_be_bytes(frame.0);
    let idle = bits.leading_ones();
    let answer = bits.wrapping_shl(idle);
    let acknowledge = answer.leading_zeros();
    let start = idle + acknowledge;
    if start + HEAD_BITS + PAYLOAD_BITS > 64 {
        return Err(FrameError::Silent);
    }
    let head = bits.wrapping_shl(start);
    let payload = head.wrapping_shl(HEAD_BITS) >> (64 - PAYLOAD_BITS);
    let covered = (payload >> 6) as u32;
    let zero_bit_set = head & (1 << 62) != 0;
    // Four zero bits in front make whole bytes and, with start value 0, do not change the CRC.
    if zero_bit_set || CRC.checksum(&covered.to_be_bytes()) != payload as u8 & 0x3F {
        return Err(FrameError::Crc);
    }
    if covered & 0b10 == 0 {
        return Err(FrameError::Error);
    }
    Ok(Reading {
        counts: covered >> 2,
        warning: covered & 0b01 == 0,
    })
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
                    let reading = decode(&frame(counts, 0b11, idle, acknowledge));
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

//! The bits of one BiSS-C frame as an SPI master sees them: 64 clocks, first bit on the line is bit 63.
//!
//! ```text
//! 1..1  0 ... 0   1      0     pppp....p   e      w     cccccc     0 ...
//! idle  acknow-  start  zero   position  error warning  CRC-6     time-out: the
//!       ledge           bit    26 bits   (0 = raised)   inverted  line stays low
//! ```
//!
//! The CRC has the polynomial 0x43 (x^6 + x + 1) and start value 0 and covers position, error and warning.

use serde::{Deserialize, Serialize};

/// Bits of position in a frame.
pub const POSITION_BITS: u32 = 26;

/// Counts in a turn.
pub const COUNTS_PER_TURN: u32 = 1 << POSITION_BITS;

/// Bits between start bit and time-out: start, zero, position, error, warning, CRC.
const BODY_BITS: u32 = 2 + POSITION_BITS + 2 + 6;

/// How long the line idles and acknowledges before the start bit, in clocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Preamble {
    /// Clocks until the encoder pulls the line low.
    pub idle_bits: u32,
    /// Clocks that it takes to have the position ready; longer lines and slower heads take more.
    pub acknowledge_bits: u32,
}

impl Preamble {
    /// Two clocks until the acknowledge (as BiSS-C has it) and eight of processing, 1.5 us at 5.25 MHz.
    pub const DEFAULT: Self = Self {
        idle_bits: 2,
        acknowledge_bits: 8,
    };

    /// Most clocks of idle and acknowledge together that leave room for the rest in 64.
    pub const MAX_BITS: u32 = 64 - BODY_BITS;
}

/// Encodes a frame. Flags are given as meant: `error` true puts a 0 on the line. A preamble over
/// [`Preamble::MAX_BITS`] pushes the end of the frame past the last clock, as on a real line.
#[must_use]
pub fn encode(position: u32, error: bool, warning: bool, preamble: Preamble) -> u64 {
    let payload = (u64::from(position & (COUNTS_PER_TURN - 1)) << 2)
        | (u64::from(!error) << 1)
        | u64::from(!warning);
    let inverted_crc = u64::from(!crc6(payload) & 0x3f);
    let body = (0b10 << (BODY_BITS - 2)) | (payload << 6) | inverted_crc;
    let lead_bits = preamble.idle_bits + preamble.acknowledge_bits;
    let aligned = (body << (64 - BODY_BITS))
        .checked_shr(lead_bits)
        .unwrap_or(0);
    let idle = !u64::MAX.checked_shr(preamble.idle_bits).unwrap_or(0);
    idle | aligned
}

/// CRC-6 over the 28 bits of position and flags, by long division; not inverted.
const fn crc6(payload: u64) -> u8 {
    let mut remainder = payload << 6;
    let mut bit = 2 + POSITION_BITS + 6 - 1;
    while bit >= 6 {
        if remainder >> bit & 1 == 1 {
            remainder ^= 0x43 << (bit - 6);
        }
        bit -= 1;
    }
    remainder as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same CRC by shift register, as a textbook draws it.
    fn crc6_by_register(payload: u64) -> u8 {
        let mut register = 0u8;
        for bit in (0..28).rev() {
            let feedback = (register >> 5) ^ (payload >> bit & 1) as u8;
            register = (register << 1) & 0x3f;
            if feedback & 1 == 1 {
                register ^= 0x03;
            }
        }
        register
    }

    #[test]
    fn crc_agrees_with_the_shift_register() {
        let mut noise = crate::random::Random::new(7);
        for _ in 0..1000 {
            let payload = noise.bits() >> 36;
            assert_eq!(crc6(payload), crc6_by_register(payload), "{payload:#x}");
        }
    }

    #[test]
    fn frame_has_its_fields_in_place() {
        let preamble = Preamble {
            idle_bits: 2,
            acknowledge_bits: 3,
        };
        let frame = encode(0x2aa_aaaa, true, false, preamble);
        assert_eq!(frame >> 62, 0b11, "idle");
        assert_eq!(frame >> 59 & 0b111, 0, "acknowledge");
        assert_eq!(frame >> 57 & 0b11, 0b10, "start and zero");
        assert_eq!(frame >> 31 & 0x3ff_ffff, 0x2aa_aaaa, "position");
        assert_eq!(frame >> 29 & 0b11, 0b01, "error raised, warning not");
        let payload = frame >> 29 & 0xfff_ffff;
        assert_eq!(
            !(frame >> 23) as u8 & 0x3f,
            crc6_by_register(payload),
            "CRC"
        );
        assert_eq!(frame & 0x7f_ffff, 0, "time-out");
    }

    #[test]
    fn too_long_a_preamble_loses_the_end_without_a_panic() {
        let endless = Preamble {
            idle_bits: 70,
            acknowledge_bits: 70,
        };
        assert_eq!(encode(5, false, false, endless), u64::MAX);
        let fits = Preamble {
            idle_bits: 0,
            acknowledge_bits: Preamble::MAX_BITS,
        };
        assert_eq!(encode(0, false, false, fits) >> 34, 0b10);
    }
}

//! Encoder decoding with 64-bit shifts and the crate `crc`.

use super::super::control::Rings;
use crate::bench::Bench;
use crate::table::Came;
use crc::{Algorithm, Crc, Table};
use firmware::drivers::biss::RawFrame;

const BISS: Algorithm<u8> = Algorithm {
    width: 6,
    poly: 0x03,
    init: 0,
    refin: false,
    refout: false,
    xorout: 0x3F,
    check: 0,
    residue: 0,
};
static CRC: Crc<u8, Table<1>> = Crc::<u8, Table<1>>::new(&BISS);

/// Counts frames to positions: no plausibility, no bridging, no turns.
#[inline(never)]
pub fn run(bench: &mut Bench) {
    bench.part_with(
        "beside: encoder decoding, three, crate crc",
        1,
        &mut Rings::default(),
        Rings::turned,
        |_, frames| [0, 1, 2].map(|i| position(&frames[i])),
        |_, positions| Came {
            refused: positions.iter().any(Option::is_none),
            ticks: 0,
        },
    );
}

fn position(frame: &RawFrame) -> Option<u32> {
    let bits = u64::from_be_bytes(frame.0);
    let bits = bits.checked_shl(bits.leading_ones())?;
    let bits = bits.checked_shl(bits.leading_zeros())?;
    // Start bit, zero bit, 26 bits of position, two flags, six of the checksum.
    let covered = ((bits << 2) >> 36) as u32;
    let sent = (bits >> 28 & 0x3F) as u8;
    (CRC.checksum(&covered.to_be_bytes()) == sent).then_some(covered >> 2)
}

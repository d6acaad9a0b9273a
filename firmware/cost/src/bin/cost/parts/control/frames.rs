//! Frames as the encoders send them. The checksum is the one of 64 that the library's own decoder believes: there is no
//! second one that could differ.

use firmware::drivers::biss::{POSITION_BITS, RawFrame, decode};
use firmware::parameters::{EncoderMounting, Parameters};
use kinematics::Angle;

/// Start and zero bit, position, flags, checksum.
const FRAME_BITS: u32 = 2 + POSITION_BITS + 2 + 6;
/// Clocks before the start bit: one idle, four of acknowledge.
const IDLE: u32 = 1;
const ACKNOWLEDGE: u32 = 4;

/// The frames of the reference stage's encoders, without error or warning.
pub fn frames(pivots: &[Angle; 3]) -> [RawFrame; 3] {
    let setups = &Parameters::REFERENCE.encoders;
    [0, 1, 2].map(|i| frame(pivots[i], &setups[i]))
}

fn frame(pivot: Angle, setup: &EncoderMounting) -> RawFrame {
    let turned = pivot.fraction() >> (32 - POSITION_BITS);
    let turned = if setup.reversed {
        turned.wrapping_neg()
    } else {
        turned
    };
    let counts = turned.wrapping_add(setup.zero_counts) & ((1 << POSITION_BITS) - 1);
    let body = 1 << (FRAME_BITS - 1) | u64::from(counts) << 8 | 0b11 << 6;
    let left = 64 - IDLE - ACKNOWLEDGE - FRAME_BITS;
    let idle = !(u64::MAX >> IDLE);
    (0..64)
        .map(|checksum| RawFrame((idle | (body | checksum) << left).to_be_bytes()))
        .find(|frame| decode(frame).is_ok())
        .unwrap_or(RawFrame::MISSING)
}

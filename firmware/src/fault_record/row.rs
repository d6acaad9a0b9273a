//! What the fault record holds of a tick.

use crate::recorder::Sample;

/// Words of a row, with its check.
pub(super) const WORDS: usize = 12;
/// Bits of a current that are left out.
const CURRENT_CUT: u32 = 2;

/// A tick of the fault record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FaultRecordRow {
    /// The tick, its low 32 bits.
    pub tick: u32,
    /// The supervisor's [`Mode`](crate::mode::Mode), as a number.
    pub mode: u8,
    /// The latched [`FaultKind`](crate::fault::FaultKind), counted from 1; 0 for none.
    pub fault: u8,
    /// Measured pivots, 2^-32 turns, without whole turns.
    pub pivots: [u32; 3],
    /// Measured minus setpoint, 2^-32 turns.
    pub errors: [i32; 3],
    /// Duties, PWM counts.
    pub duty: [i16; 3],
    /// Motor currents, ADC counts with their sign; the lowest two bits are left out.
    pub current_counts: [i16; 3],
    /// Supply, ADC counts.
    pub supply_counts: u16,
    /// What the tick before cost, cycles, as far as 16 bits hold it.
    pub tick_cycles: u16,
}

/// The words of a tick; the last is for the check.
#[inline]
pub(super) fn words(sample: &Sample, start: u32) -> [u32; WORDS] {
    let fault = sample.fault.map_or(0, |kind| kind as u32 + 1);
    let supply = u32::from(sample.supply_counts) & 0xFFF;
    let [a, b, c] = sample.duty.map(|duty| u32::from(duty.0 as u16));
    let [i, j, k] = (sample.current_counts).map(|counts| (counts >> CURRENT_CUT) as u32 & 0x3FF);
    let [p, q, r] = sample.pivots;
    let errors = [0, 1, 2].map(|i| (sample.pivots[i] - sample.pivot_setpoints[i]).units() as u32);
    [
        sample.tick as u32,
        start << 24 | (sample.mode as u32) << 20 | (fault & 0xFF) << 12 | supply,
        p.fraction(),
        q.fraction(),
        r.fraction(),
        errors[0],
        errors[1],
        errors[2],
        a << 16 | b,
        c << 16 | sample.tick_cycles.min(0xFFFF),
        i << 20 | j << 10 | k,
        0,
    ]
}

/// The low byte of the start that a row belongs to.
pub(super) const fn start_number(words: &[u32; WORDS]) -> u8 {
    (words[1] >> 24) as u8
}

/// The row in its words.
pub(super) fn row(words: &[u32; WORDS]) -> FaultRecordRow {
    // The sign is the highest of the ten bits.
    let counts = |shift: u32| ((words[10] >> shift << 22) as i32 >> (22 - CURRENT_CUT)) as i16;
    FaultRecordRow {
        tick: words[0],
        mode: (words[1] >> 20 & 0xF) as u8,
        fault: (words[1] >> 12) as u8,
        pivots: [words[2], words[3], words[4]],
        errors: [words[5], words[6], words[7]].map(|word| word as i32),
        duty: [
            (words[8] >> 16) as i16,
            words[8] as i16,
            (words[9] >> 16) as i16,
        ],
        current_counts: [counts(20), counts(10), counts(0)],
        supply_counts: (words[1] & 0xFFF) as u16,
        tick_cycles: words[9] as u16,
    }
}

//! What the controller's 12 bit ADC (3.3 V) reads of the bridges.

/// Largest count.
pub const FULL_SCALE_COUNTS: u16 = 4095;

/// Volts at the input for each ampere of motor current: 450 uA/A out of the bridge's current mirror into 1 kohm. The
/// mirror gives the size of the current, not its sign; full scale is 7.33 A.
pub const CURRENT_V_A: f64 = 0.45;

/// Volts at the input for each volt of supply: 19 kohm over 1 kohm. Full scale is 66 V.
pub const SUPPLY_V_V: f64 = 1.0 / 20.0;

const REFERENCE_V: f64 = 3.3;

/// Counts of a motor current.
#[must_use]
pub fn current_counts(current_a: f64) -> u16 {
    counts(current_a.abs() * CURRENT_V_A)
}

/// Counts of the supply voltage.
#[must_use]
pub fn supply_counts(supply_v: f64) -> u16 {
    counts(supply_v * SUPPLY_V_V)
}

fn counts(input_v: f64) -> u16 {
    let scaled = input_v / REFERENCE_V * f64::from(FULL_SCALE_COUNTS);
    // The cast saturates, and takes NaN for zero.
    (scaled.round() as u16).min(FULL_SCALE_COUNTS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_scale_and_saturate() {
        assert_eq!(supply_counts(48.0), 2978);
        assert_eq!(current_counts(-1.0), 558);
        assert_eq!(current_counts(22.9), FULL_SCALE_COUNTS);
        assert_eq!(supply_counts(-1.0), 0);
    }
}

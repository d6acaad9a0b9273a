//! Units of the tick: counts of the converter, and the integers that angles are.

/// Supply voltage of one count of the 12-bit ADC: 3.3 V full scale behind a divider of 20.
pub const SUPPLY_V_PER_COUNT: f64 = 66.0 / 4096.0;
/// Motor current of one count: DRV8874, 450 uA/A into 1 kohm, 3.3 V full scale.
pub const CURRENT_A_PER_COUNT: f64 = 3.3 / 4096.0 / (450e-6 * 1_000.0);

/// Units of an angle, 2^-32 turns, in a radian.
pub const UNITS_PER_RAD: f64 = 4_294_967_296.0 / core::f64::consts::TAU;

//! Units of the tick: counts of the converter, and the integers that angles are.

pub use crate::drivers::power_stage::{CURRENT_A_PER_COUNT, SUPPLY_V_PER_COUNT};

/// Units of an angle, 2^-32 turns, in a radian.
pub const UNITS_PER_RAD: f64 = 4_294_967_296.0 / core::f64::consts::TAU;

//! The units of a [`Position`] and of an [`AxisState`](super::axis_state::AxisState) as floats.

use super::piece::Position;

/// 2^32: units of a [`Position`] in a track radius or a turn.
pub const POSITION_UNITS: f32 = 4_294_967_296.0;
/// The inverse.
pub const PER_POSITION_UNIT: f32 = 1.0 / POSITION_UNITS;
/// 2^72: units of an [`AxisState`](super::axis_state::AxisState).
pub const AXIS_UNITS: f32 = 4_722_366_482_869_645_213_696.0;
/// The inverse.
pub const PER_AXIS_UNIT: f32 = 1.0 / AXIS_UNITS;

/// x and y of a position in track radii.
pub fn xy_radii(position: &Position) -> [f64; 2] {
    const UNIT: f64 = 1.0 / 4_294_967_296.0;
    [position[0] as f64 * UNIT, position[1] as f64 * UNIT]
}

//! What rsruckig is asked for: the same as the planners, under the limits of the axes by themselves.

use firmware::motion::{AxisState, Position};
use firmware_cost::states::ground;
use rsruckig::prelude::*;

/// A state, a target to rest at, and the limits, in track radii, turns and seconds.
pub fn asked(state: &[AxisState; 3], to: &Position) -> InputParameter<3> {
    let limits = ground().limits;
    let mm = ground().geometry.radius_mm;
    let each = |translation: f64, rotation_deg: f64| {
        let translation = translation / mm;
        DataArrayOrVec::Stack([translation, translation, rotation_deg / 360.0])
    };
    let mut input = InputParameter::new(None);
    input.current_position = stack(state, |axis| axis.rounded() as f64 * UNIT);
    input.current_velocity = stack(state, |axis| axis.velocity as f64 * SMALL * limits.rate_hz);
    input.current_acceleration = stack(state, |axis| {
        axis.acceleration as f64 * SMALL * limits.rate_hz * limits.rate_hz
    });
    input.target_position = target(to);
    input.max_velocity = each(limits.speed_mm_s, limits.turn_speed_deg_s);
    input.max_acceleration = each(limits.acceleration_mm_s2, limits.turn_acceleration_deg_s2);
    input.max_jerk = each(limits.jerk_mm_s3, limits.turn_jerk_deg_s3);
    input
}

/// 2^-32 and 2^-72.
const UNIT: f64 = 1.0 / 4_294_967_296.0;
const SMALL: f64 = 1.0 / 4_722_366_482_869_645_213_696.0;

fn stack(state: &[AxisState; 3], value: impl Fn(&AxisState) -> f64) -> DataArrayOrVec<f64, 3> {
    DataArrayOrVec::Stack(state.each_ref().map(value))
}

fn target(to: &Position) -> DataArrayOrVec<f64, 3> {
    DataArrayOrVec::Stack(to.map(|units| units as f64 * UNIT))
}

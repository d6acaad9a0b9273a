//! What the drives allow a motion: how fast their pivots may turn and be accelerated.

use super::config::MAX_DUTY;
use super::inertia::largest_carried_inertia;
use super::platform_torque::Body;
use crate::parameters::Parameters;

/// Share of a motor's largest current that planned motion may ask for: the rest is the feedback's.
const PLANNED: f64 = 0.9;

/// Largest rate (rad/s) and acceleration (rad/s^2) of a pivot with which no motor asks for more than its largest current, nor for more
/// than the nominal supply can give at that rate, anywhere in the disk and in an urgent stop.
///
/// `R i + K w = V` and `J s a + T = K i`, with i the planned part of the largest current, w and a what is looked for, s the stop factor, T
/// Coulomb friction, V what the bridge puts out at most and J what the pivot moves where that is most.
#[must_use]
pub fn pivot_limits(parameters: &Parameters) -> [f64; 2] {
    let Parameters { power, limits, .. } = parameters;
    let body = Body::new(parameters);
    let radius = parameters.geometry.usable_radius();
    let current_a = PLANNED * power.current_limit_a;
    let volts = (power.supply_v * MAX_DUTY).min(power.voltage_limit_v);
    let mut least = [f64::MAX; 2];
    for (pivot, drive) in parameters.drives.iter().enumerate() {
        let torque_per_ampere = drive.torque_constant_n_m_a * drive.gear_ratio;
        let inertia = drive.inertia_kg_m2 + largest_carried_inertia(&body, radius, pivot);
        let torque = torque_per_ampere * current_a - drive.coulomb_n_m;
        let rate = (volts - drive.resistance_ohm * current_a) / torque_per_ampere;
        let acceleration = torque / (inertia * limits.stop_factor);
        least = [least[0].min(rate), least[1].min(acceleration)];
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: 0.06 x 50 N m/A, 5.4 A, 48 x 0.98 V, 2.1 ohm; a ring of 0.02 kg m^2 and 3 kg at the edge.
    #[test]
    fn the_reference_stage_has_the_limits_that_its_motors_bear() {
        let parameters = Parameters::REFERENCE;
        let [rate, acceleration] = pivot_limits(&parameters);
        println!("{rate} rad/s, {acceleration} rad/s^2");
        let volts = parameters.power.supply_v * MAX_DUTY;
        assert!((rate - (volts - 2.1 * 5.4) / 3.0).abs() < 1e-9);
        let carried = acceleration.recip() * (3.0 * 5.4 - 0.1) / 2.0 - 0.02;
        assert!((0.015..0.06).contains(&carried), "{carried}");
    }

    /// Half the current is half the acceleration but for friction; a load takes from it.
    #[test]
    fn less_current_and_more_load_are_less_acceleration() {
        let mut parameters = Parameters::REFERENCE;
        parameters
            .drives
            .iter_mut()
            .for_each(|drive| drive.coulomb_n_m = 0.0);
        let [_, plain] = pivot_limits(&parameters);
        parameters.power.current_limit_a = 3.0;
        let [_, half] = pivot_limits(&parameters);
        assert!((half / plain - 0.5).abs() < 1e-12);
        parameters.platform.payload_kg = 5.0;
        let [_, loaded] = pivot_limits(&parameters);
        assert!(loaded < 0.7 * half, "{loaded} {half}");
    }
}

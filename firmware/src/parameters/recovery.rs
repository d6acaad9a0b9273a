//! What the tick computes with while a stage is recovered from out of its reach.

use super::Parameters;

/// What a pivot may be faster than that is recovered: this share of its largest rate.
const OVERSPEED: f64 = 0.1;
/// How much closer than they are found two pivots may come, rad: what the loop and the encoders' noise do.
const SEPARATION_TOLERANCE_RAD: f64 = 1e-3;

impl Parameters {
    /// The same with limited voltage, for a stage that is slow, and whose closest pivots are so far apart: nearer than that is a
    /// fault. Disk and guides need no more: outside, the supervisor lets a setpoint go back in only.
    pub(crate) fn for_recovery(&self, closest_rad: f64) -> Self {
        let mut recovery = self.clone();
        let power = &mut recovery.power;
        power.voltage_limit_v = power.voltage_limit_v.min(power.recovery_voltage_v);
        let supervision = &mut recovery.supervision;
        supervision.overspeed_factor = OVERSPEED;
        supervision.separation_margin_rad = (supervision.separation_margin_rad)
            .max(self.geometry.separation_rad - closest_rad + SEPARATION_TOLERANCE_RAD);
        recovery
    }
}

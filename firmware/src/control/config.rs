//! What the tick computes with, derived once from the parameters.

use crate::control::encoder::EncoderConfig;
use crate::control::servo::ServoConfig;
use crate::control::supervisor::TURN;
use crate::motion::{FaultStop, SetpointScale};
use crate::parameters::Parameters;

/// The tick's constants.
#[derive(Clone, Debug, PartialEq)]
pub struct Config {
    /// Encoders, pivot by pivot.
    pub encoders: [EncoderConfig; 3],
    /// Setpoint integers to rates.
    pub scale: SetpointScale,
    /// Servo.
    pub servo: ServoConfig,
    /// Supervision.
    pub limits: SupervisionConfig,
    /// The controlled stop of a fault.
    pub fault_stop: FaultStop,
}

/// Thresholds in the tick's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupervisionConfig {
    /// Largest following error at rest, 2^-32 turns.
    pub following_error: i32,
    /// What is allowed besides for each rad/s of the setpoint, 2^-32 turns.
    pub following_per_rate: f32,
    /// Window of a settled pivot, 2^-32 turns.
    pub window: i32,
    /// Ticks inside the window that count as settled.
    pub dwell: u32,
    /// Lowest supply in ADC counts.
    pub supply_min: u16,
    /// Ticks that may be late, one in a hundred forgiven.
    pub late_ticks: u32,
    /// Largest step of a pivot in a tick, 2^-32 turns.
    pub overspeed: u32,
    /// Smallest angle between two pivots, 2^-32 turns.
    pub separation: u32,
    /// Range of a pivot's place on its guide, track radii.
    pub guide: [f32; 2],
    /// Square of the largest distance of the platform's centre from the track's, track radii.
    pub reach_square: f32,
    /// Longest time at the largest duty, ticks.
    pub at_end: u32,
    /// Square of the current that a motor bears, ADC counts.
    pub heat: f32,
    /// Part of the way to a new temperature from one look at a motor to the next.
    pub heating: f32,
    /// Way of a setpoint in which a reading must change, 2^-32 turns.
    pub frozen_way: u64,
    /// Change of a duty that must change a reading, PWM counts.
    pub frozen_duty: u16,
    /// Ticks in a second.
    pub hz: f32,
}

/// Supply voltage of one count of the 12-bit ADC: 3.3 V full scale behind a divider of 20.
pub const SUPPLY_V_PER_COUNT: f64 = 66.0 / 4096.0;
/// Motor current of one count: DRV8874, 450 uA/A into 1 kohm, 3.3 V full scale.
pub const CURRENT_A_PER_COUNT: f64 = 3.3 / 4096.0 / (450e-6 * 1_000.0);

pub(crate) const UNITS_PER_RAD: f64 = 4_294_967_296.0 / core::f64::consts::TAU;

impl Config {
    /// Derives the tick's constants.
    pub fn new(parameters: &Parameters) -> Self {
        let rate_hz = parameters.limits.rate_hz;
        let period_s = 1.0 / rate_hz;
        let supervision = &parameters.supervision;
        let window = &parameters.window;
        let (geometry, drive) = (&parameters.geometry, &parameters.drive);
        let margin = supervision.guide_margin;
        let reach = geometry.usable_radius() + supervision.disk_margin_mm / geometry.radius_mm;
        let bearable = supervision.motor_current_a / CURRENT_A_PER_COUNT;
        let fastest = parameters.limits.pivot_rate_rad_s * supervision.overspeed_factor;
        Self {
            encoders: parameters
                .encoders
                .map(|setup| EncoderConfig::new(&setup, supervision, period_s)),
            scale: SetpointScale::new(rate_hz),
            servo: ServoConfig::new(parameters),
            limits: SupervisionConfig {
                following_error: (supervision.following_error_rad * UNITS_PER_RAD) as i32,
                // A count is 64 units; the half lets a setpoint between two counts be met.
                window: ((window.counts + 0.5) * 64.0) as i32,
                dwell: libm::ceil(window.dwell_s * rate_hz) as u32,
                following_per_rate: (supervision.following_error_s * UNITS_PER_RAD) as f32,
                supply_min: (supervision.supply_min_v / SUPPLY_V_PER_COUNT) as u16,
                late_ticks: supervision.late_ticks,
                overspeed: (fastest * period_s * UNITS_PER_RAD) as u32,
                separation: ((geometry.separation_rad - supervision.separation_margin_rad)
                    * UNITS_PER_RAD) as u32,
                guide: [
                    (geometry.guide_start - margin) as f32,
                    (geometry.guide_start + geometry.guide_length + margin) as f32,
                ],
                reach_square: (reach * reach) as f32,
                at_end: libm::ceil(supervision.at_end_s * rate_hz) as u32,
                heat: (bearable * bearable) as f32,
                heating: (1.0
                    - libm::exp(-f64::from(TURN) * period_s / supervision.motor_heating_s))
                    as f32,
                frozen_way: (supervision.frozen_rad * UNITS_PER_RAD) as u64,
                frozen_duty: (supervision.frozen_v / drive.supply_v * f64::from(drive.pwm_counts))
                    as u16,
                hz: rate_hz as f32,
            },
            fault_stop: FaultStop::new(supervision.stop_s, rate_hz),
        }
    }
}

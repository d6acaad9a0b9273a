//! What the tick computes with, derived once from the parameters.

use crate::encoder::EncoderConfig;
use crate::motion::Scale;
use crate::parameters::Parameters;
use crate::servo::ServoConfig;

/// The tick's constants.
#[derive(Clone, Debug, PartialEq)]
pub struct Config {
    /// Encoders, pivot by pivot.
    pub encoders: [EncoderConfig; 3],
    /// Setpoint integers to rates.
    pub scale: Scale,
    /// Servo.
    pub servo: ServoConfig,
    /// Supervision.
    pub limits: SupervisionConfig,
}

/// Thresholds in the tick's units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupervisionConfig {
    /// Largest following error, 2^-32 turns.
    pub following_error: i32,
    /// Window of a settled pivot, 2^-32 turns.
    pub window: i32,
    /// Ticks inside the window that count as settled.
    pub dwell: u32,
    /// Lowest supply in ADC counts.
    pub supply_min: u16,
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
        Self {
            encoders: parameters
                .encoders
                .map(|setup| EncoderConfig::new(&setup, supervision, period_s)),
            scale: Scale::new(rate_hz),
            servo: ServoConfig::new(parameters),
            limits: SupervisionConfig {
                following_error: (supervision.following_error_rad * UNITS_PER_RAD) as i32,
                // A count is 64 units; the half lets a setpoint between two counts be met.
                window: ((window.counts + 0.5) * 64.0) as i32,
                dwell: libm::ceil(window.dwell_s * rate_hz) as u32,
                supply_min: (supervision.supply_min_v / SUPPLY_V_PER_COUNT) as u16,
            },
        }
    }
}

//! What the tick computes with, derived once from the parameters.

use crate::control::encoder::EncoderConfig;
use crate::control::guides::config::GuideConfig;
use crate::control::held_position::PositionSteps;
use crate::control::inspection::INSPECTION_PERIOD_TICKS;
use crate::control::oscillation::MEMORY_S;
use crate::control::rest_mode::{RestModeConfig, UNITS_PER_COUNT};
use crate::control::servo::ServoConfig;
use crate::control::units::{CURRENT_A_PER_COUNT, SUPPLY_V_PER_COUNT, UNITS_PER_RAD};
use crate::control::wiring::WiringConfig;
use crate::drivers::latch::LATCH_OFFSET_S;
use crate::drivers::power_stage::{BRIDGE, BUS};
use crate::motion::{FaultStop, SetpointScale};
use crate::parameters::Parameters;

/// Share of the limits of a pivot's motion under which its setpoint hardly moves.
const SLOW: f64 = 0.1;
/// From one [test of the brake resistor](super::brake_resistor_test) to the next while the stage rests, s.
const RESISTOR_TEST_PERIOD_S: f64 = 2.0;
/// Supply that is too high, ADC counts.
pub(super) const MAX_SUPPLY_COUNTS: u16 = (BUS.too_high_v / SUPPLY_V_PER_COUNT) as u16;
/// Most ticks of the settling window's mean.
pub(super) const MAX_MEAN_TICKS: usize = 32;

/// The tick's constants.
#[derive(Clone, Debug, PartialEq)]
pub struct Config {
    /// Whether the machine is commissioned: if not, the servo never goes on.
    pub commissioned: bool,
    /// Which connector is which pivot's.
    pub wiring: WiringConfig,
    /// Encoders, pivot by pivot.
    pub encoders: [EncoderConfig; 3],
    /// Setpoint integers to rates.
    pub scale: SetpointScale,
    /// To what a position is rounded that the servo takes over.
    pub steps: PositionSteps,
    /// Servo.
    pub servo: ServoConfig,
    /// Guides, where they are told of.
    pub guides: Option<GuideConfig>,
    /// What becomes of its gains at rest.
    pub rest_mode: RestModeConfig,
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
    pub following_error_per_rate: f32,
    /// Window of a settled pivot, 2^-32 turns, times the ticks of the mean.
    pub settling_window: u32,
    /// Ticks of the mean error that is held against it.
    pub mean_ticks: usize,
    /// Ticks inside the window that count as settled.
    pub settling_ticks: u32,
    /// Lowest supply in ADC counts.
    pub min_supply_counts: u16,
    /// Ticks that may be late, one in a hundred forgiven.
    pub late_ticks: u32,
    /// Largest step of a pivot in a tick, 2^-32 turns.
    pub max_step: u32,
    /// Smallest angle between two pivots, 2^-32 turns.
    pub min_separation: u32,
    /// Range of a pivot's place on its guide, track radii.
    pub guide_range: [f32; 2],
    /// Square of the largest distance of the platform's centre from the track's, track radii.
    pub max_radius_squared: f32,
    /// Longest time at the largest duty (saturated), ticks.
    pub max_saturated_ticks: u32,
    /// Square of the current that a motor bears, ADC counts.
    pub max_mean_square_current: f32,
    /// How far a current may be from what its voltage drives, ADC counts; a share of that besides.
    pub unexplained_current_counts: u16,
    /// Share of the way to a new temperature that a winding goes from one inspection to the next.
    pub winding_smoothing: f32,
    /// Distance of a setpoint in which a reading must change, 2^-32 turns.
    pub frozen_distance: u64,
    /// Rate under which a pivot's setpoint hardly moves, rad/s.
    pub slow_rate: f32,
    /// The same for its acceleration, rad/s^2.
    pub slow_acceleration: f32,
    /// What is left of counted reversals from one inspection to the next.
    pub oscillation_memory: f32,
    /// Ticks of rest from one test of the brake resistor to the next.
    pub resistor_test_ticks: u32,
    /// Ticks in a second.
    pub rate_hz: f32,
}

impl SupervisionConfig {
    /// Ticks that the bridges are given to wake up.
    #[inline]
    pub(super) fn wake_ticks(&self) -> u32 {
        // One more: the first may begin anywhere in it.
        (BRIDGE.wake_grace_s as f32 * self.rate_hz) as u32 + 1
    }

    /// Whether the supply is neither too low nor too high.
    #[inline]
    pub(super) const fn has_good_supply(&self, counts: u16) -> bool {
        counts >= self.min_supply_counts && counts <= MAX_SUPPLY_COUNTS
    }
}

impl Config {
    /// Derives the tick's constants.
    pub fn new(parameters: &Parameters) -> Self {
        let rate_hz = parameters.limits.rate_hz;
        let period_s = 1.0 / rate_hz;
        let supervision = &parameters.supervision;
        let window = &parameters.window;
        let geometry = &parameters.geometry;
        let mean_ticks = (libm::rint(window.mean_s * rate_hz) as usize).clamp(1, MAX_MEAN_TICKS);
        let margin = supervision.guide_margin;
        let reach = geometry.usable_radius() + supervision.disk_margin_mm / geometry.radius_mm;
        let bearable = supervision.motor_current_a / CURRENT_A_PER_COUNT;
        let fastest = parameters.limits.pivot_rate_rad_s * supervision.overspeed_factor;
        let wiring = WiringConfig::new(&parameters.wiring);
        let latch_offsets_s = wiring.of_encoders(&LATCH_OFFSET_S);
        Self {
            commissioned: parameters.commissioned,
            wiring,
            encoders: [0, 1, 2].map(|pivot| {
                EncoderConfig::new(&parameters.encoders[pivot], supervision, period_s)
                    .latched_later(latch_offsets_s[pivot], period_s)
            }),
            scale: SetpointScale::new(rate_hz),
            steps: PositionSteps::new(geometry.radius_mm),
            servo: ServoConfig::new(parameters),
            guides: GuideConfig::new(parameters),
            rest_mode: RestModeConfig::new(parameters, mean_ticks),
            limits: SupervisionConfig {
                following_error: (supervision.following_error_rad * UNITS_PER_RAD) as i32,
                // A count is 64 units; the half lets a setpoint between two counts be met.
                settling_window: ((window.counts + 0.5) * UNITS_PER_COUNT * mean_ticks as f64)
                    as u32,
                mean_ticks,
                settling_ticks: libm::ceil(window.dwell_s * rate_hz) as u32,
                following_error_per_rate: (supervision.following_error_s * UNITS_PER_RAD) as f32,
                min_supply_counts: (supervision.supply_min_v / SUPPLY_V_PER_COUNT) as u16,
                late_ticks: supervision.late_ticks,
                max_step: (fastest * period_s * UNITS_PER_RAD) as u32,
                min_separation: ((geometry.separation_rad - supervision.separation_margin_rad)
                    * UNITS_PER_RAD) as u32,
                guide_range: [
                    (geometry.guide_start - margin) as f32,
                    (geometry.guide_start + geometry.guide_length + margin) as f32,
                ],
                max_radius_squared: (reach * reach) as f32,
                max_saturated_ticks: libm::ceil(supervision.max_saturation_s * rate_hz) as u32,
                max_mean_square_current: (bearable * bearable) as f32,
                unexplained_current_counts: (supervision.unexplained_current_a
                    / CURRENT_A_PER_COUNT) as u16,
                winding_smoothing: (1.0
                    - libm::exp(
                        -f64::from(INSPECTION_PERIOD_TICKS) * period_s
                            / supervision.motor_heating_s,
                    )) as f32,
                frozen_distance: (supervision.frozen_rad * UNITS_PER_RAD) as u64,
                slow_rate: (SLOW * parameters.limits.pivot_rate_rad_s) as f32,
                slow_acceleration: (SLOW * parameters.limits.pivot_acceleration_rad_s2) as f32,
                oscillation_memory: libm::exp(
                    -f64::from(INSPECTION_PERIOD_TICKS) * period_s / MEMORY_S,
                ) as f32,
                resistor_test_ticks: (RESISTOR_TEST_PERIOD_S * rate_hz) as u32,
                rate_hz: rate_hz as f32,
            },
            fault_stop: FaultStop::new(supervision.stop_s, rate_hz),
        }
    }
}

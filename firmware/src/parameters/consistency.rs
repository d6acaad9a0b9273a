//! What has to hold between parameters, each of which is in its own range.

use super::{ConnectorOrder, HARMONICS, Parameters, Wiring};
use kinematics::Geometry;

/// Least and most of the track's radius that the usable disk may reach out to: closer to the track the pivots' rates
/// have no bound.
const USABLE_RADIUS_RANGE: [f64; 2] = [0.05, 0.95];
/// The tick's 32-bit rates end at 39 track radii or turns a second ([`SetpointScale`](crate::motion::SetpointScale)); a tenth is kept
/// free.
const MAX_RATE_1_S: f64 = 35.0;
/// The same for accelerations, which end at 3,050 a second squared. What an urgent stop makes of the largest
/// acceleration that a pivot may have, 2,000 rad/s^2, is less: at most 2/sqrt(3) of it in track radii.
const MAX_ACCELERATION_1_S2: f64 = 2_700.0;
/// Shortest silence of the host that can be noticed, ms: what an operating system keeps with ease.
pub(crate) const MIN_HOST_SILENCE_MS: f64 = 10.0;
/// Largest share of a motion that an encoder's error within the periods of its scale may add to it or take away: real ones are a few
/// hundredths.
const MAX_SUBDIVISION_SLOPE: f64 = 0.5;
/// The encoder's resolution, 2^-26 turns.
const COUNT_RAD: f64 = core::f64::consts::TAU / 67_108_864.0;

impl Parameters {
    /// Whether they make a stage that can be controlled: that the disk is not empty, that the tick's numbers hold every
    /// rate, that no threshold contradicts another, that encoders are not corrected beyond reason, that a tick has time for all sines, that no connector is two pivots', and that a record has a point from its trigger on. Says nothing of
    /// each parameter's own range.
    pub fn are_sound(&self) -> bool {
        self.has_disk()
            && self.rates_fit()
            && self.thresholds_agree()
            && self.connectors_differ()
            && self.readings_rise()
            && self.sines_fit()
            && self.recorder.before < self.recorder.points
    }

    fn has_disk(&self) -> bool {
        let Geometry {
            radius_mm,
            guide_start,
            guide_length,
            separation_rad,
        } = self.geometry;
        Geometry::new(radius_mm, guide_start, guide_length, separation_rad).is_ok_and(|geometry| {
            (USABLE_RADIUS_RANGE[0]..=USABLE_RADIUS_RANGE[1]).contains(&geometry.usable_radius())
        })
    }

    fn rates_fit(&self) -> bool {
        let (limits, radius_mm) = (&self.limits, self.geometry.radius_mm);
        let fastest = (limits.speed_mm_s / radius_mm).max(limits.turn_speed_deg_s / 360.0);
        let hardest =
            (limits.acceleration_mm_s2 / radius_mm).max(limits.turn_acceleration_deg_s2 / 360.0);
        limits.all_positive()
            && fastest <= MAX_RATE_1_S
            && hardest * limits.stop_factor <= MAX_ACCELERATION_1_S2
    }

    fn connectors_differ(&self) -> bool {
        let Wiring {
            encoder_order,
            bridge_order,
            ..
        } = self.wiring;
        [encoder_order, bridge_order]
            .iter()
            .all(|digits| ConnectorOrder::from_digits(f64::from(*digits)).is_some())
    }

    /// Whether what is taken from the encoders' readings leaves them rising with the angle.
    fn readings_rise(&self) -> bool {
        self.subdivision.iter().all(|subdivision| {
            let slope: f64 = (1_u32..)
                .zip(&subdivision.harmonics)
                .map(|(k, one)| {
                    f64::from(k * subdivision.periods) * f64::from(one.amplitude_nrad) * 1e-9
                })
                .sum();
            slope < MAX_SUBDIVISION_SLOPE
        })
    }

    /// A tick has time for four of each pivot's: sines of ripple, one of which the gear's error takes the place of, and one the guides.
    fn sines_fit(&self) -> bool {
        let servo = &self.servo;
        (servo.ripple.iter().zip(&servo.gear_errors)).all(|(ripple, gear)| {
            let sines = ripple
                .harmonics
                .iter()
                .filter(|sine| sine.amplitude_n_m != 0.0);
            let others =
                usize::from(gear.amplitude_urad != 0.0) + usize::from(self.guides.are_told());
            sines.count() + others <= HARMONICS
        })
    }

    fn thresholds_agree(&self) -> bool {
        let (supervision, power) = (&self.supervision, &self.power);
        let braking = self.limits.pivot_acceleration_rad_s2 * self.limits.stop_factor;
        let silence_ms = supervision.host_silence_ms;
        let silence_fits = silence_ms == 0.0 || silence_ms >= MIN_HOST_SILENCE_MS;
        // A stage that settles must not be at fault, nor one that brakes, nor one at its nominal supply.
        supervision.following_error_rad > (self.window.counts + 1.0) * COUNT_RAD
            && supervision.plausible_acceleration_rad_s2 > braking
            && supervision.separation_margin_rad < self.geometry.separation_rad.max(f64::MIN_POSITIVE)
            && supervision.guide_margin < self.geometry.guide_start
            && silence_fits
            && supervision.supply_min_v < power.supply_v
            // What a motor may carry for long it may carry for a moment.
            && supervision.motor_current_a <= power.current_limit_a
            // Four times the dead time is what a bridge needs to put out anything at all in both directions.
            && (self.drives.iter()).all(|drive| drive.dead_time_s * power.pwm_hz < 0.25)
    }
}

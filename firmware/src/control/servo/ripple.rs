//! Torque ripple of a motor and its gear, made up for: a few sines of the pivot's angle.
//!
//! The drive adds `sum A_k sin(p_k phi + a_k)` to its torque, phi the pivot's angle and p_k its periods in a turn of the ring (for a
//! commutator of 26 periods a motor turn behind a gear of 50, 1,300). The current that takes it away is `-T / (Kt N)`, and the voltage
//! behind it `R i + L i'`: for each sine `-A R / (Kt N) (sin + (L / R) p phi' cos)`, at the angle where the pivot will be when the
//! voltage acts. So the phase is right at every speed, as far as the model of the winding is.

use crate::control::units::UNITS_PER_RAD;
use crate::number::sin_cos_short;
use crate::parameters::{Drive, HARMONICS, Harmonic};
use kinematics::Angle;

/// Binary places of a harmonic's periods.
const PERIOD_PLACES: u32 = 15;

/// A sine, in the tick's units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Sine {
    /// Periods a turn of the ring, times 2^15: a pivot's angle times this is the phase.
    periods: u32,
    /// 2^-32 turns.
    phase: u32,
    volts: f32,
    /// Volts of the cosine for a pivot's rate of 1 rad/s.
    volts_per_rate: f32,
}

/// The sines of a pivot that are there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RippleConfig {
    sines: [Sine; HARMONICS],
    count: u8,
    /// 2^-32 turns that a pivot goes on until a voltage acts, for a rate of 1 rad/s.
    lead: f32,
}

impl RippleConfig {
    /// Derives the constants.
    pub fn new(harmonics: &[Harmonic; HARMONICS], drive: &Drive, latency_s: f64) -> Self {
        let mut config = Self {
            lead: (latency_s * UNITS_PER_RAD) as f32,
            ..Self::default()
        };
        let volt_per_torque =
            drive.resistance_ohm / (drive.torque_constant_n_m_a * drive.gear_ratio);
        let winding_s = drive.inductance_h / drive.resistance_ohm;
        let present = harmonics.iter().filter(|one| one.amplitude_n_m != 0.0);
        for (place, harmonic) in config.sines.iter_mut().zip(present) {
            let volts = -volt_per_torque * harmonic.amplitude_n_m;
            let scale = f64::from(1_u32 << PERIOD_PLACES);
            *place = Sine {
                periods: libm::rint(harmonic.periods * scale) as u32,
                phase: libm::rint(harmonic.phase_deg / 360.0 * 4_294_967_296.0) as i64 as u32,
                volts: volts as f32,
                volts_per_rate: (volts * winding_s * harmonic.periods) as f32,
            };
            config.count += 1;
        }
        config
    }

    /// Volts against the ripple; 0 where there is none.
    #[inline]
    pub fn volts(&self, setpoint: Angle, rate: f32) -> f32 {
        if self.count == 0 {
            return 0.0;
        }
        self.sum(setpoint, rate)
    }

    /// Of the sines that are there.
    // Once in the loop's memory: written out for each pivot and each sine it would be long.
    #[inline(never)]
    fn sum(&self, setpoint: Angle, rate: f32) -> f32 {
        let angle = setpoint.units() + i64::from((rate * self.lead) as i32);
        let mut volts = 0.0;
        for sine in self.sines.iter().take(self.count.into()) {
            // All turns count, so that a gear without a whole ratio keeps its phase.
            let turned = (angle.wrapping_mul(i64::from(sine.periods)) >> PERIOD_PLACES) as u32;
            let (sin, cos) = sin_cos_short(turned.wrapping_add(sine.phase));
            volts += sine.volts * sin + sine.volts_per_rate * rate * cos;
        }
        volts
    }
}

//! The cyclic error of a gear, made up for: its motor does not turn evenly where the ring does.
//!
//! A gear has an error of a sine once a turn of its motor: with the ring at phi the motor stands `e = A sin(n phi + a)` further on, n the gear
//! ratio, all seen at the ring. The voltage for that is what its own motion asks for, with K the motor constant at the ring, R and
//! L of the winding and J the inertia of the motor and its side of the gear:
//!
//! ```text
//! V = K e' + (R / K) (J e'' - T de/dphi) + (L / K) J e'''
//! e' = A n phi' cos      e'' = A n (phi'' cos - n phi'^2 sin)      e''' = -A n^3 phi'^3 cos
//! ```
//!
//! T is what the gear passes on: an uneven one takes by the ratio by which it gives. Of e''' only what grows with the speed counts.
//! It is computed when a pivot has its turn, for the middle of the ticks up to its next one: at 10 rad/s a period has 31 turns.

use crate::control::inspection::LOOK_TICKS;
use crate::control::units::UNITS_PER_RAD;
use crate::number::sin_cos_short;
use crate::parameters::{Drive, GearError};
use kinematics::Angle;

/// Binary places of the gear ratio.
const RATIO_PLACES: u32 = 15;

/// What the voltage is made of, in the tick's units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GearErrorConfig {
    is_there: bool,
    /// Motor turns in a turn of the ring, times 2^15: a pivot's angle times this is the phase.
    ratio: u32,
    /// 2^-32 turns.
    phase: u32,
    /// 2^-32 turns that a pivot goes on until the voltage acts, for a rate of 1 rad/s.
    lead: f32,
    /// Volts of the cosine by the rate, its cube, the acceleration and the torque; of the sine by the square of the rate.
    per_rate: f32,
    per_cube: f32,
    per_acceleration: f32,
    per_torque: f32,
    per_square: f32,
}

impl GearErrorConfig {
    /// Derives the constants.
    pub fn new(error: &GearError, drive: &Drive, latency_s: f64, rate_hz: f64) -> Self {
        if error.amplitude_urad == 0.0 {
            return Self::default();
        }
        let (n, inertia) = (drive.gear_ratio, drive.motor_inertia_kg_m2);
        let constant = drive.torque_constant_n_m_a * n;
        let slope = 1e-6 * error.amplitude_urad * n;
        let volt_per_torque = drive.resistance_ohm / constant;
        let held_s = 0.5 * f64::from(LOOK_TICKS - 1) / rate_hz;
        Self {
            is_there: true,
            ratio: libm::rint(n * f64::from(1_u32 << RATIO_PLACES)) as u32,
            phase: libm::rint(error.phase_deg / 360.0 * 4_294_967_296.0) as i64 as u32,
            lead: ((latency_s + held_s) * UNITS_PER_RAD) as f32,
            per_rate: (slope * constant) as f32,
            per_cube: (-slope * drive.inductance_h / constant * inertia * n * n) as f32,
            per_acceleration: (slope * volt_per_torque * 2.0 * inertia) as f32,
            per_torque: (-slope * volt_per_torque) as f32,
            per_square: (-slope * volt_per_torque * inertia * n) as f32,
        }
    }

    /// Volts at a setpoint: against the back-EMF, and for the torque. `torque` is what motor, ring and platform ask for together. 0 where there is
    /// no error.
    #[inline]
    pub fn volts(&self, setpoint: Angle, rate: f32, acceleration: f32, torque: f32) -> [f32; 2] {
        if self.is_there {
            self.sum(setpoint, rate, acceleration, torque)
        } else {
            [0.0; 2]
        }
    }

    // Once in the loop's memory.
    #[inline(never)]
    fn sum(&self, setpoint: Angle, rate: f32, acceleration: f32, torque: f32) -> [f32; 2] {
        let angle = setpoint.units() + i64::from((rate * self.lead) as i32);
        let turned = (angle.wrapping_mul(i64::from(self.ratio)) >> RATIO_PLACES) as u32;
        let (sin, cos) = sin_cos_short(turned.wrapping_add(self.phase));
        let square = rate * rate;
        let along = rate * self.per_cube * square
            + self.per_acceleration * acceleration
            + self.per_torque * torque;
        [
            cos * (self.per_rate * rate),
            cos * along + sin * (self.per_square * square),
        ]
    }
}

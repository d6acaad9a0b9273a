//! The servo of a pivot as a frequency response, as `firmware/src/control/servo/pivot.rs` and `filter.rs` compute it tick by tick.
//!
//! ```text
//!  r = e' + Kp e                         e' is the change in a tick
//!  volts = filters(Kv r + integral)      the integral collects Ki r a tick later
//! ```

use nalgebra::Complex;
use std::f64::consts::{PI, TAU};

/// A notch. See the parameters 0x54500340 to 0x54500345.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Notch {
    /// Centre; 0: no filter.
    pub frequency_hz: f64,
    /// Width.
    pub width_hz: f64,
    /// What it lets pass at its centre, 0 to 1.
    pub gain: f64,
}

/// A lead. See the parameters 0x54500346 and 0x54500347.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lead {
    /// The gain grows from here; 0: no lead.
    pub from_hz: f64,
    /// Up to here.
    pub to_hz: f64,
}

/// Gains and filters of a pivot, as its parameters have them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PivotGains {
    /// Velocity gain, V s/rad.
    pub velocity_v_s_rad: f64,
    /// Position gain, 1/s.
    pub position_1_s: f64,
    /// Integral gain, V/rad.
    pub integral_v_rad: f64,
    /// Against resonances.
    pub notches: [Notch; 2],
    /// Against the winding's lag.
    pub lead: Lead,
}

impl Notch {
    /// None.
    pub const NONE: Self = Self {
        frequency_hz: 0.0,
        width_hz: 200.0,
        gain: 0.1,
    };

    fn response(&self, tangent: Complex<f64>, tick_s: f64) -> Complex<f64> {
        if self.frequency_hz <= 0.0 {
            return 1.0.into();
        }
        let corner = (PI * self.frequency_hz * tick_s).tan();
        let width = corner * self.width_hz / self.frequency_hz;
        let square = tangent * tangent + corner * corner;
        (square + tangent * (self.gain * width)) / (square + tangent * width)
    }
}

impl Lead {
    /// None.
    pub const NONE: Self = Self {
        from_hz: 0.0,
        to_hz: 3_000.0,
    };

    fn response(&self, tangent: Complex<f64>, tick_s: f64) -> Complex<f64> {
        if self.from_hz <= 0.0 {
            return 1.0.into();
        }
        let [from, to] = [self.from_hz, self.to_hz].map(|hz| (PI * hz * tick_s).tan());
        (1.0 + tangent / from) / (1.0 + tangent / to)
    }
}

impl PivotGains {
    /// Volts for each rad that the ring is behind its setpoint.
    #[must_use]
    pub fn response(&self, hz: f64, tick_s: f64) -> Complex<f64> {
        let back = Complex::cis(-TAU * hz * tick_s);
        // The bilinear transform's s, corners at tan(pi f T).
        let tangent = Complex::new(0.0, (PI * hz * tick_s).tan());
        let rate = (1.0 - back) / tick_s + self.position_1_s;
        let collected = self.integral_v_rad * tick_s * back / (1.0 - back);
        let filters: Complex<f64> = self
            .notches
            .iter()
            .map(|notch| notch.response(tangent, tick_s))
            .product();
        filters * self.lead.response(tangent, tick_s) * rate * (self.velocity_v_s_rad + collected)
    }

    /// With another velocity gain and the integral gain in the same proportion.
    #[must_use]
    pub fn scaled(&self, by: f64) -> Self {
        Self {
            velocity_v_s_rad: self.velocity_v_s_rad * by,
            integral_v_rad: self.integral_v_rad * by,
            ..*self
        }
    }
}

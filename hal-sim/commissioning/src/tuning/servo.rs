//! The servo of a pivot as a frequency response, as `firmware/src/control/servo/pivot.rs` and `filter.rs` compute it tick by tick.
//!
//! ```text
//!  r = e' + Kp e                         e' is the change in a tick
//!  volts = filters(Kv r + integral)      the integral collects Ki r a tick later
//! ```

use firmware::parameters::{FeedbackFilters, Gains, Lead, Notch};
use nalgebra::Complex;
use std::f64::consts::{PI, TAU};

/// Gains and filters of a pivot, as its parameters have them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PivotGains {
    /// Gains.
    pub gains: Gains,
    /// What lies between feedback and voltage.
    pub filters: FeedbackFilters,
}

fn notch(notch: &Notch, tangent: Complex<f64>, tick_s: f64) -> Complex<f64> {
    if notch.frequency_hz <= 0.0 {
        return 1.0.into();
    }
    let corner = (PI * notch.frequency_hz * tick_s).tan();
    let width = corner * notch.width_hz / notch.frequency_hz;
    let square = tangent * tangent + corner * corner;
    (square + tangent * (notch.gain * width)) / (square + tangent * width)
}

fn lead(lead: &Lead, tangent: Complex<f64>, tick_s: f64) -> Complex<f64> {
    if lead.from_hz <= 0.0 {
        return 1.0.into();
    }
    let [from, to] = [lead.from_hz, lead.to_hz].map(|hz| (PI * hz * tick_s).tan());
    (1.0 + tangent / from) / (1.0 + tangent / to)
}

/// A frequency, as the servo's parts need it.
pub(super) struct At {
    /// A tick's delay.
    back: Complex<f64>,
    /// The bilinear transform's s, corners at tan(pi f T).
    tangent: Complex<f64>,
    tick_s: f64,
}

impl At {
    pub(super) fn new(hz: f64, tick_s: f64) -> Self {
        Self {
            back: Complex::cis(-TAU * hz * tick_s),
            tangent: Complex::new(0.0, (PI * hz * tick_s).tan()),
            tick_s,
        }
    }
}

impl PivotGains {
    /// Volts for each rad that the ring is behind its setpoint.
    #[must_use]
    pub fn response(&self, hz: f64, tick_s: f64) -> Complex<f64> {
        self.response_at(&At::new(hz, tick_s))
    }

    pub(super) fn response_at(&self, at: &At) -> Complex<f64> {
        let At {
            back,
            tangent,
            tick_s,
        } = *at;
        let rate = (1.0 - back) / tick_s + self.gains.position_1_s;
        let collected = self.gains.integral_v_rad * tick_s * back / (1.0 - back);
        let FeedbackFilters { notches, lead: one } = &self.filters;
        let filters: Complex<f64> = notches
            .iter()
            .map(|one| notch(one, tangent, tick_s))
            .product();
        let velocity = self.gains.velocity_v_s_rad;
        filters * lead(one, tangent, tick_s) * rate * (velocity + collected)
    }

    /// With another velocity gain and the integral gain in the same proportion.
    #[must_use]
    pub fn scaled(&self, by: f64) -> Self {
        Self {
            gains: Gains {
                velocity_v_s_rad: self.gains.velocity_v_s_rad * by,
                integral_v_rad: self.gains.integral_v_rad * by,
                ..self.gains
            },
            ..*self
        }
    }
}

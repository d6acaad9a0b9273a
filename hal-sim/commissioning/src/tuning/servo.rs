//! The servo of a pivot as a frequency response, as `firmware/src/control/servo/pivot.rs` and `filter.rs` compute it tick by tick.
//!
//! ```text
//!  r = e' + Kp e                         e' is the change in a tick
//!  volts = filters(Kv r + integral)      the integral collects Ki r a tick later
//! ```

use firmware::parameters::{FeedbackFilters, Gains, Notch};
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

/// A frequency, as the servo's parts need it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct At {
    /// A tick's delay.
    back: Complex<f64>,
    /// The bilinear transform's s, corners at tan(pi f T).
    tangent: Complex<f64>,
    /// `(1 - 1/z)^6`: takes the six integrators out of the loops of three pivots.
    pub without_integrators: Complex<f64>,
}

impl At {
    pub(super) fn new(hz: f64, tick_s: f64) -> Self {
        let back = Complex::cis(-TAU * hz * tick_s);
        Self {
            back,
            tangent: Complex::new(0.0, (PI * hz * tick_s).tan()),
            without_integrators: (1.0 - back).powi(6),
        }
    }
}

/// What of a servo is the same at all frequencies.
pub(super) struct Servo {
    gains: Gains,
    notches: [NotchCorner; 2],
    lead: Option<[f64; 2]>,
    tick_s: f64,
}

/// Square of a notch's corner, and its damping above and below the line.
struct NotchCorner {
    square: f64,
    over: f64,
    under: f64,
}

impl NotchCorner {
    fn new(notch: &Notch, tick_s: f64) -> Self {
        if notch.frequency_hz <= 0.0 {
            return Self {
                square: 1.0,
                over: 1.0,
                under: 1.0,
            };
        }
        let corner = (PI * notch.frequency_hz * tick_s).tan();
        let width = corner * notch.width_hz / notch.frequency_hz;
        Self {
            square: corner * corner,
            over: notch.gain * width,
            under: width,
        }
    }

    fn response(&self, tangent: Complex<f64>) -> Complex<f64> {
        let square = tangent * tangent + self.square;
        (square + tangent * self.over) / (square + tangent * self.under)
    }
}

impl Servo {
    pub(super) fn new(pivot: &PivotGains, tick_s: f64) -> Self {
        let FeedbackFilters { notches, lead } = &pivot.filters;
        let corner = |hz: f64| (PI * hz * tick_s).tan();
        Self {
            gains: pivot.gains,
            notches: notches.each_ref().map(|one| NotchCorner::new(one, tick_s)),
            lead: (lead.from_hz > 0.0).then(|| [lead.from_hz, lead.to_hz].map(corner)),
            tick_s,
        }
    }

    pub(super) fn response(&self, at: &At) -> Complex<f64> {
        let At { back, tangent, .. } = *at;
        let rate = (1.0 - back) / self.tick_s + self.gains.position_1_s;
        let collected = self.gains.integral_v_rad * self.tick_s * back / (1.0 - back);
        let notches: Complex<f64> = (self.notches.iter())
            .map(|notch| notch.response(tangent))
            .product();
        let lead = self.lead.map_or(Complex::from(1.0), |[from, to]| {
            (1.0 + tangent / from) / (1.0 + tangent / to)
        });
        notches * lead * rate * (self.gains.velocity_v_s_rad + collected)
    }
}

impl PivotGains {
    /// Volts for each rad that the ring is behind its setpoint.
    #[must_use]
    pub fn response(&self, hz: f64, tick_s: f64) -> Complex<f64> {
        Servo::new(self, tick_s).response(&At::new(hz, tick_s))
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

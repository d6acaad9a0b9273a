//! Filters of the feedback: two notches against resonances, a lead against the winding's lag.
//!
//! Second-order sections by the bilinear transform, each corner put where it is asked for (`s = (1 - 1/z) / (1 + 1/z)`, corners at
//! `tan(pi f / f_s)`): Oppenheim and Schafer, Discrete-Time Signal Processing, section 7.1. All of them let the constant part pass
//! as it is, so that the integral keeps its meaning.

use crate::parameters::{FeedbackFilters, Lead, Notch};
use core::f64::consts::PI;

/// Filters that a pivot can have.
const SECTIONS: usize = 3;

/// `(b0 + b1/z + b2/z^2) / (1 + a1/z + a2/z^2)`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Section {
    b: [f32; 3],
    a: [f32; 2],
}

impl Section {
    /// `(n0 s^2 + n1 s + n2) / (d0 s^2 + d1 s + d2)` in the transform's s.
    fn bilinear([n0, n1, n2]: [f64; 3], [d0, d1, d2]: [f64; 3]) -> Self {
        let scale = 1.0 / (d0 + d1 + d2);
        let b = [n0 + n1 + n2, 2.0 * (n2 - n0), n0 - n1 + n2];
        let a = [2.0 * (d2 - d0), d0 - d1 + d2];
        Self {
            b: b.map(|b| (b * scale) as f32),
            a: a.map(|a| (a * scale) as f32),
        }
    }

    fn notch(notch: &Notch, rate_hz: f64) -> Option<Self> {
        let corner = libm::tan(PI * notch.frequency_hz / rate_hz);
        // Width over frequency is twice the damping of the poles, and the transform keeps that ratio at the centre.
        let width = corner * notch.width_hz / notch.frequency_hz;
        let square = corner * corner;
        (notch.frequency_hz > 0.0)
            .then(|| Self::bilinear([1.0, notch.gain * width, square], [1.0, width, square]))
    }

    fn lead(lead: &Lead, rate_hz: f64) -> Option<Self> {
        let [from, to] = [lead.from_hz, lead.to_hz].map(|hz| libm::tan(PI * hz / rate_hz));
        // Of the first order: as one of the second, both halves would have a root at half the tick's rate, on the edge of stability.
        let scale = 1.0 / (1.0 + to);
        (lead.from_hz > 0.0).then(|| Self {
            b: [to / from + to, to - to / from, 0.0].map(|b| (b * scale) as f32),
            a: [(to - 1.0) * scale, 0.0].map(|a| a as f32),
        })
    }
}

/// The filters of a pivot that are there, one after the other.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FilterConfig {
    sections: [Section; SECTIONS],
    count: u8,
}

impl FilterConfig {
    /// Derives the coefficients, for so many ticks a second.
    pub fn new(filters: &FeedbackFilters, rate_hz: f64) -> Self {
        let [first, second] = &filters.notches;
        let sections = [
            Section::notch(first, rate_hz),
            Section::notch(second, rate_hz),
            Section::lead(&filters.lead, rate_hz),
        ];
        let mut config = Self::default();
        for (place, section) in (config.sections.iter_mut()).zip(sections.into_iter().flatten()) {
            *place = section;
            config.count += 1;
        }
        config
    }

    /// Gain at half the tick's rate: what the filters make of the encoders' noise. At least 1.
    pub fn noise_gain(&self) -> f32 {
        let sections = self.sections.iter().take(self.count.into());
        let gain: f32 = (sections)
            .map(
                |Section {
                     b: [b0, b1, b2],
                     a: [a1, a2],
                 }| { (b0 - b1 + b2) / (1.0 - a1 + a2) },
            )
            .product();
        gain.abs().max(1.0)
    }
}

/// What the filters of a pivot remember.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Filters([[f32; 2]; SECTIONS]);

impl Filters {
    /// The filtered value; without filters the value itself.
    #[inline]
    pub fn step(&mut self, config: &FilterConfig, value: f32) -> f32 {
        if config.count == 0 {
            return value;
        }
        let mut value = value;
        for (section, state) in config
            .sections
            .iter()
            .zip(&mut self.0)
            .take(config.count.into())
        {
            let ([b0, b1, b2], [a1, a2]) = (section.b, section.a);
            // Transposed direct form II.
            let filtered = b0 * value + state[0];
            state[0] = b1 * value - a1 * filtered + state[1];
            state[1] = b2 * value - a2 * filtered;
            value = filtered;
        }
        value
    }
}

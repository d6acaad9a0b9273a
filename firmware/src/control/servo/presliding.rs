//! Friction of a ring as a spring that slips: presliding after Dahl, driven by the setpoint.

/// Deflection of the contact, -1 to 1 times its Coulomb friction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Presliding {
    deflection: f32,
}

impl Presliding {
    /// The deflection now.
    #[inline]
    pub fn deflection(&self) -> f32 {
        self.deflection
    }

    /// The deflection after the setpoint has moved by `way` (in presliding lengths).
    ///
    /// Dahl's `dz/ds = 1 - z sign(ds)`, one implicit step: stable and within +-1 for any way.
    #[inline]
    pub fn advance(&mut self, way: f32) -> f32 {
        self.deflection = (self.deflection + way) / (1.0 + way.abs());
        self.deflection
    }
}

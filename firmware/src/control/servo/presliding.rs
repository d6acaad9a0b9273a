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

    /// The deflection after the setpoint has moved by `distance` (in presliding lengths).
    ///
    /// Dahl's `dz/ds = 1 - z sign(ds)`, one implicit step: stable and within +-1 for any distance.
    #[inline]
    pub fn advance(&mut self, distance: f32) -> f32 {
        self.deflection = (self.deflection + distance) / (1.0 + distance.abs());
        self.deflection
    }
}

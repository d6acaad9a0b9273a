//! What lines about excitations ask for.

/// What lines about excitations ask for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExcitationRequest {
    /// Pivot whose motor is excited, 0 to 2.
    pub pivot: usize,
    /// What it does.
    pub shape: Shape,
    /// For how long at most.
    pub ms: f64,
    /// Way of a pivot that ends it.
    pub until_mrad: Option<f64>,
    /// Current of the motor that ends it.
    pub until_a: Option<f64>,
}

/// What an excitation does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// `EXC STEP`: this voltage.
    Step {
        /// The voltage.
        volts: f64,
    },
    /// `EXC RAMP`: from nothing to this voltage.
    Ramp {
        /// The voltage at its end.
        volts: f64,
    },
    /// `EXC SINES`: a multisine.
    Sines {
        /// Its peak.
        volts: f64,
        /// Lowest and highest harmonic of 4,096 ticks.
        harmonics: [u32; 2],
        /// How many.
        lines: usize,
    },
    /// `EXC RING`: rings held each by itself, one moved.
    Ring {
        /// How far.
        mrad: f64,
        /// How fast.
        mrad_s: f64,
    },
}

//! Whether a servo oscillates: a voltage that goes to and fro by a large swing, over and over.

/// Reversals, those long ago for less, that are an oscillation: with the time constant below, from 31 Hz on.
const REVERSALS: f32 = 6.0;
/// What a reversal counts while the setpoint moves, where feedback goes to and fro with the motion: so it is one from 100 Hz on.
const IN_MOTION: f32 = 0.3;
/// Time constant with which reversals are forgotten.
pub(super) const MEMORY_S: f64 = 0.1;

/// The voltage that a pivot's feedback asks for, looked at from time to time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OscillationWatch {
    /// Furthest voltage since the last reversal, and which way it went.
    extreme: f32,
    rising: bool,
    reversals: f32,
    /// Voltage of the last reversal, and how far it was from the one before.
    before: f32,
    swing: f32,
}

impl OscillationWatch {
    /// Takes the voltage; whether it oscillates. `forgetting` is what is left of the reversals since the last look; `slowly`: the
    /// setpoint hardly moves.
    #[inline]
    pub fn update(&mut self, volts: f32, swing: f32, forgetting: f32, slowly: bool) -> bool {
        self.reversals *= forgetting;
        let beyond = if self.rising {
            volts - self.extreme
        } else {
            self.extreme - volts
        };
        if beyond > 0.0 {
            self.extreme = volts;
        } else if beyond < -swing {
            self.rising = !self.rising;
            self.swing = (self.extreme - self.before).abs();
            (self.before, self.extreme) = (self.extreme, volts);
            self.reversals += if slowly { 1.0 } else { IN_MOTION };
        }
        self.reversals > REVERSALS
    }

    /// The last way from one reversal to the next, V.
    pub fn swing(&self) -> f32 {
        self.swing
    }
}

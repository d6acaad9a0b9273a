//! What is recorded of a machine, and when within a tick each of it holds.

/// Signals of one pivot at successive ticks. All three are as long as each other; a pivot that was not recorded has none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Signals {
    /// What the bridge was told in each tick, V: duty times the supply that was measured.
    pub volts: Vec<f64>,
    /// The motor's current, A.
    pub current_a: Vec<f64>,
    /// The ring's angle, rad, without steps at whole turns.
    pub angle_rad: Vec<f64>,
}

/// Successive ticks of up to three pivots.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Record {
    /// Ticks from the beginning of the excitation to the first of the record.
    pub first_tick: usize,
    /// The pivots.
    pub pivots: [Signals; 3],
}

impl Signals {
    /// Ticks of it, or `None` where the three are not as long as each other.
    #[must_use]
    pub fn ticks(&self) -> Option<usize> {
        let ticks = self.volts.len();
        (self.current_a.len() == ticks && self.angle_rad.len() == ticks).then_some(ticks)
    }
}

/// When within a control period things happen, s from the tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// Control period.
    pub tick_s: f64,
    /// From a tick to when its duty acts.
    pub duty_s: f64,
    /// From a tick to the instant at which the angle that it reads was latched: less than 0.
    pub angle_s: f64,
    /// The same of the currents.
    pub current_s: f64,
}

impl Timing {
    /// The image's (`firmware/src/bin/stage/timeline.rs`): the encoders latch 15 us before the tick, and the duty acts 32 us after it.
    /// The currents are taken to be those of the tick, as the simulator has it. On the chip the converter starts with the latch: there
    /// it is `current_s: -13e-6`.
    pub const STAGE: Self = Self {
        tick_s: 50e-6,
        duty_s: 32e-6,
        angle_s: -15e-6,
        current_s: 0.0,
    };

    /// From the latch of an angle to the middle of the period in which the duty acts that was computed with it, s.
    #[must_use]
    pub fn latency_s(&self) -> f64 {
        self.duty_s + 0.5 * self.tick_s - self.angle_s
    }
}

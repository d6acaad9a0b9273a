//! Lamps, and pins that show a scope where latch and tick are.

use crate::pins;
use firmware::commander::Lamps;
use stm32f4xx_hal::gpio::Output;

/// High from the encoders' latch to the end of its handler.
pub type LatchMark = pins::LatchMark<Output>;
/// High from the tick's begin until its duties are written.
pub type TickMark = pins::TickMark<Output>;

/// The board's three lamps.
pub struct BoardLamps {
    /// Shows the state.
    pub status: pins::StatusLamp<Output>,
    /// The motors are driven.
    pub drive: pins::DriveLamp<Output>,
    /// A fault is latched.
    pub fault: pins::FaultLamp<Output>,
}

impl BoardLamps {
    /// Lights them, or not.
    pub fn show(&mut self, lamps: Lamps) {
        self.status.set_state(lamps.status.into());
        self.drive.set_state(lamps.drive.into());
        self.fault.set_state(lamps.fault.into());
    }
}

//! What a board's lamps show: the state, for whoever stands before it without a computer.
//!
//! | status lamp, every 1.6 s | the controller |
//! |---|---|
//! | one flash | runs, servo off |
//! | two flashes | runs, and is not commissioned: it drives nothing |
//! | three flashes | has a fault; the fault lamp is lit too |
//! | lit half the time | drives, and holds the stage at rest |
//! | five flashes a second | drives, and moves |
//! | stays dark or lit | does not run |

use super::Commander;
use crate::mode::Mode;

/// Ticks of a step of a pattern, 0.1 s, and the steps.
const STEP_TICKS: u64 = 2_000;
const STEPS: u64 = u16::BITS as u64;

/// Patterns: a bit a step, the lowest first.
const OFF: u16 = 0b1;
const NOT_COMMISSIONED: u16 = 0b101;
const FAULT: u16 = 0b1_0101;
const HOLDING: u16 = 0x00FF;
const MOVING: u16 = 0x5555;

/// Which lamps are lit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lamps {
    /// Shows the state by its pattern.
    pub status: bool,
    /// The motors are driven.
    pub drive: bool,
    /// A fault is latched.
    pub fault: bool,
}

impl Commander {
    /// What the lamps show now; all are dark before the first snapshot.
    pub fn lamps(&self) -> Lamps {
        let Some(snapshot) = self.snapshot() else {
            return Lamps::default();
        };
        let drive = !matches!(snapshot.mode, Mode::Off | Mode::Fault);
        let fault = snapshot.fault.is_some();
        let pattern = match snapshot.mode {
            _ if fault => FAULT,
            Mode::Holding => HOLDING,
            Mode::Moving | Mode::Stopping | Mode::Exciting => MOVING,
            Mode::Off | Mode::Fault if self.commissioned => OFF,
            Mode::Off | Mode::Fault => NOT_COMMISSIONED,
        };
        Lamps {
            status: pattern >> (snapshot.tick / STEP_TICKS % STEPS) & 1 != 0,
            drive,
            fault,
        }
    }
}

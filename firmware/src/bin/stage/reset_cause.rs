//! Why the chip started.

use crate::restart;
use firmware::gcs::{Crash, CrashCause, START_CAUSES};
use stm32f4xx_hal::pac;

/// Why the chip started.
#[derive(Clone, Copy, Debug, PartialEq, Eq, defmt::Format)]
#[repr(u8)]
pub enum ResetCause {
    /// Power came up.
    PowerOn = 1,
    /// The supply dipped.
    BrownOut = 2,
    /// The reset pin.
    Pin = 3,
    /// The program asked for it: a panic or a processor fault.
    Software = 4,
    /// The loop stood still.
    Watchdog = 5,
    /// A flag this image does not expect.
    Other = 6,
    /// `RBT`.
    Command = 7,
    /// The crystal stopped.
    ClockFailure = 8,
}

impl ResetCause {
    /// In words, and whether somebody asked for it.
    pub const fn told(self) -> (&'static str, bool) {
        match self {
            Self::Watchdog => (START_CAUSES[0], false),
            Self::Software => (START_CAUSES[1], false),
            Self::BrownOut => (START_CAUSES[2], false),
            Self::ClockFailure => (START_CAUSES[3], false),
            Self::PowerOn => (START_CAUSES[4], true),
            Self::Pin => (START_CAUSES[5], true),
            Self::Command => (START_CAUSES[6], true),
            Self::Other => (START_CAUSES[7], true),
        }
    }

    /// Reads the flags and clears them for the next time. Every reset also sets the pin's flag, so that one comes last.
    /// Whoever ends the program asks for a reset; how it ended says why.
    pub fn take(rcc: &mut pac::RCC, crash: Option<Crash>) -> Self {
        let flags = rcc.csr().read();
        let cause = if flags.wdgrstf().bit_is_set() || flags.wwdgrstf().bit_is_set() {
            Self::Watchdog
        } else if flags.sftrstf().bit_is_set() {
            if restart::was_asked_for() {
                Self::Command
            } else {
                Self::of_crash(crash)
            }
        } else if flags.porrstf().bit_is_set() {
            Self::PowerOn
        } else if flags.borrstf().bit_is_set() {
            Self::BrownOut
        } else if flags.padrstf().bit_is_set() {
            Self::Pin
        } else {
            Self::Other
        };
        rcc.csr().modify(|_, w| w.rmvf().set_bit());
        cause
    }

    const fn of_crash(crash: Option<Crash>) -> Self {
        match crash {
            Some(Crash::Exception { cause, .. }) => match cause {
                CrashCause::ClockFailure => Self::ClockFailure,
                CrashCause::LoopStoodStill => Self::Watchdog,
                CrashCause::ProcessorFault | CrashCause::UnexpectedInterrupt => Self::Software,
            },
            _ => Self::Software,
        }
    }
}

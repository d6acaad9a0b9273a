//! The independent watchdog, fed only while the control loop ticks, and the cause of the last reset.

use crate::{restart, trace::TRACE};
use core::sync::atomic::{AtomicU32, Ordering};
use firmware::gcs::START_CAUSES;
use stm32f4xx_hal::{pac, prelude::*, watchdog::IndependentWatchdog};

/// How long the loop may stand still, ms. The oscillator behind it is good to -30 and +50 %.
const TIMEOUT_MS: u32 = 20;

/// The tick at which the watchdog was last fed.
static FED_AT: AtomicU32 = AtomicU32::new(0);

const RELOAD: u16 = 0xAAAA;

/// Starts the watchdog; nothing but a reset stops it again.
pub fn start(iwdg: pac::IWDG) {
    IndependentWatchdog::new(iwdg).start(TIMEOUT_MS.millis());
}

/// Feeds the watchdog if the tick has run since the last time. Only the command side calls this, so both have to live.
pub fn feed() {
    let ticks = TRACE.ticks();
    if ticks == FED_AT.load(Ordering::Relaxed) {
        return;
    }
    FED_AT.store(ticks, Ordering::Relaxed);
    // SAFETY: the key register is only written, and this key only reloads the counter.
    unsafe { (*pac::IWDG::ptr()).kr().write(|w| w.key().bits(RELOAD)) };
}

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
}

impl ResetCause {
    /// What is worth telling over the command interface: a start that nobody asked for.
    pub const fn unasked(self) -> Option<&'static str> {
        match self {
            Self::Watchdog => Some(START_CAUSES[0]),
            Self::Software => Some(START_CAUSES[1]),
            Self::BrownOut => Some(START_CAUSES[2]),
            _ => None,
        }
    }

    /// Reads the flags and clears them for the next time. Every reset also sets the pin's flag, so that one comes last.
    pub fn take(rcc: &mut pac::RCC) -> Self {
        let flags = rcc.csr().read();
        let cause = if flags.wdgrstf().bit_is_set() {
            Self::Watchdog
        } else if flags.sftrstf().bit_is_set() {
            if restart::was_asked_for() {
                Self::Command
            } else {
                Self::Software
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
}

//! Two watchdogs. The window watchdog is fed by the tick: when one does not end, the outputs are cut half a millisecond
//! later. The independent one, with an oscillator of its own, is fed behind each tick, by what records it: it also bites when
//! the crystal is gone. And it bites when the command side has not come round for half a second: it may be slow, with ticks
//! that leave it little, but not hang.
//!
//! | | time | what it does |
//! |---|---|---|
//! | window watchdog, early warning | 0.39 to 0.49 ms after the last tick | interrupt above the tick: `fault_handlers` cut the outputs, keep where the program was, and reset |
//! | window watchdog itself | 0.1 ms later | reset, where even that interrupt was held back |
//! | independent watchdog | 20 ms nominal; 10.9 to 37.6 ms, its oscillator has 17 to 47 kHz | reset |
//! | the same, when the command side hangs | 0.5 s more | reset |
//! | the same during start-up | 8.2 s nominal; 5.6 to 15.4 s | reset |

use crate::timeline::TICK_HZ;
use core::sync::atomic::{AtomicU32, Ordering};
use stm32f4xx_hal::{
    pac::{self, Interrupt, NVIC},
    rcc::Rcc,
};

/// Ticks since the command side's last sign of life.
static SILENT_TICKS: AtomicU32 = AtomicU32::new(0);
/// As many may be: its longest work, a long plan, takes some ms of the processor, of which ticks may leave it a thirtieth.
const MOST_SILENT_TICKS: u32 = TICK_HZ / 2;

const UNLOCK: u16 = 0x5555;
const RELOAD: u16 = 0xAAAA;
const START: u16 = 0xCCCC;

/// Prescaler and reload of the independent watchdog: 32 kHz nominal over 128, five counts.
const RUNNING: (u8, u16) = (0b101, 4);
/// The same over 64, all counts.
const STARTING: (u8, u16) = (0b100, 0xFFF);
/// How often to look whether they have arrived: five cycles of a clock of 17 kHz are 50,000 of the core.
const MAX_LOOKS: u32 = 100_000;

/// What feeds the window watchdog: it runs (bit 7), and five counts of 97.5 us to its early warning at 0x40.
const FED: u16 = 0x80 | 0x45;

/// Both.
pub struct Watchdogs {
    independent: pac::IWDG,
    window: pac::WWDG,
}

impl Watchdogs {
    /// Starts the independent watchdog, with time for the start-up; nothing but a reset stops it again. The first thing the
    /// chip does.
    pub fn new(independent: pac::IWDG, window: pac::WWDG) -> Self {
        write_key(&independent, START);
        let watchdogs = Self {
            independent,
            window,
        };
        watchdogs.set_timeout(STARTING);
        watchdogs
    }

    /// From now on the loop has to tick: the window watchdog runs, and the independent one's short time-out is in force.
    pub fn start(self, rcc: &mut Rcc) {
        self.set_timeout(RUNNING);
        rcc.apb1enr().modify(|_, w| w.wwdgen().enabled());
        // The clock is there before the first access (erratum 2.2.7).
        cortex_m::asm::dsb();
        // No window: the whole count is one. The early warning interrupts.
        self.window
            .cfr()
            .write(|w| w.ewi().enable().wdgtb().div1().w().set(0x7F));
        feed_window();
        // SAFETY: the handler needs nothing that is not there yet. Its priority stays 0, above the tick's.
        unsafe { NVIC::unmask(Interrupt::WWDG) };
    }

    /// Sets prescaler and reload, waits until the watchdog has them, and begins the count anew: until then it counts what
    /// it had, after its start up to half a minute.
    fn set_timeout(&self, (prescaler, reload): (u8, u16)) {
        let registers = &self.independent;
        write_key(registers, UNLOCK);
        // SAFETY: a prescaler's code.
        (registers.pr()).write(|w| unsafe { w.pr().bits(prescaler) });
        registers.rlr().write(|w| w.rl().set(reload));
        // Without an oscillator there is no watchdog to wait for either.
        for _ in 0..MAX_LOOKS {
            if registers.sr().read().bits() == 0 {
                break;
            }
        }
        write_key(registers, RELOAD);
    }
}

fn write_key(iwdg: &pac::iwdg::RegisterBlock, key: u16) {
    // SAFETY: the three keys are all that is ever written.
    iwdg.kr().write(|w| unsafe { w.key().bits(key) });
}

/// Feeds the window watchdog: called at the end of every tick.
#[inline(always)]
pub fn feed_window() {
    // SAFETY: one store, of a value that only reloads the counter.
    unsafe { (*pac::WWDG::ptr()).cr().write(|w| w.bits(FED)) };
}

/// The command side's sign of life: each time it comes round, and while it waits for the flash or the line.
pub fn note_alive() {
    SILENT_TICKS.store(0, Ordering::Relaxed);
}

/// Feeds the independent watchdog: called behind every tick. Not once the command side has been silent for too long.
pub fn feed() {
    let silent = SILENT_TICKS.load(Ordering::Relaxed);
    if silent < MOST_SILENT_TICKS {
        SILENT_TICKS.store(silent + 1, Ordering::Relaxed);
        // SAFETY: the key register is only written, and this key only reloads the counter.
        write_key(unsafe { &*pac::IWDG::ptr() }, RELOAD);
    }
}

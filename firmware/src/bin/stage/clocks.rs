//! The clock tree: 8 MHz from the board's crystal, or from outside, 168 MHz core.
//!
//! | clock | Hz | what hangs on it |
//! |---|---|---|
//! | core, AHB | 168 M | |
//! | APB2 | 84 M, timers 168 M | TIM1, SPI1, USART1, ADC1 |
//! | APB1 | 42 M, timers 84 M | TIM3, SPI2, SPI3 |

use stm32f4xx_hal::{
    pac,
    rcc::{Config, Rcc, RccExt},
    time::Hertz,
};

/// Cycles of the core in a second.
pub const CORE_HZ: u32 = 168_000_000;
/// Counts of TIM1 in a second.
pub const TIM1_HZ: u32 = 168_000_000;
/// Counts of TIM3 in a second.
pub const TIM3_HZ: u32 = 84_000_000;
/// Clock of SPI1 and USART1.
pub const APB2_HZ: u32 = 84_000_000;
/// Clock of SPI2 and SPI3.
pub const APB1_HZ: u32 = 42_000_000;

const CRYSTAL: Hertz = Hertz::MHz(8);

/// How long a crystal may take to start, turns of the loop that waits for it: some 0.3 s of the 16 MHz oscillator. A good
/// one takes 2 ms.
const MAX_CRYSTAL_LOOKS: u32 = 500_000;

/// Where the clock comes from.
#[derive(Clone, Copy, PartialEq, Eq)]
// Each board has one of them.
#[allow(dead_code)]
pub enum ClockSource {
    /// A crystal at both pins.
    Crystal,
    /// Somebody else's clock at one of them.
    Bypassed,
}

/// The clock tree, and where it comes from.
pub struct Clocks {
    /// For those who switch their own clocks on.
    pub rcc: Rcc,
    /// The crystal did not start: all rates are those of the internal oscillator, 1 % off and more. Good enough to say
    /// so, not to drive with: nothing would watch it.
    pub without_crystal: bool,
}

/// Starts the crystal and the PLL, switches over to them, and has the crystal watched: when it stops, the timers' break
/// cuts the outputs, and the processor takes the non-maskable interrupt.
pub fn start(rcc: pac::RCC, source: ClockSource) -> Clocks {
    let has_crystal = start_crystal(&rcc, source);
    let source = if has_crystal {
        Config::hse(CRYSTAL)
    } else {
        Config::hsi()
    };
    let rcc = rcc.freeze(
        source
            .sysclk(Hertz::Hz(TIM1_HZ))
            .hclk(Hertz::Hz(TIM1_HZ))
            .pclk1(Hertz::Hz(APB1_HZ))
            .pclk2(Hertz::Hz(APB2_HZ)),
    );
    if has_crystal {
        rcc.cr().modify(|_, w| w.csson().on());
    }
    Clocks {
        rcc,
        without_crystal: !has_crystal,
    }
}

/// Whether the crystal has started. One that has not is switched off again.
fn start_crystal(rcc: &pac::RCC, source: ClockSource) -> bool {
    // Settable only while the oscillator is off.
    let bypassed = source == ClockSource::Bypassed;
    rcc.cr().modify(|_, w| w.hsebyp().bit(bypassed));
    rcc.cr().modify(|_, w| w.hseon().on());
    let starts = (0..MAX_CRYSTAL_LOOKS).any(|_| rcc.cr().read().hserdy().is_ready());
    if !starts {
        rcc.cr().modify(|_, w| w.hseon().off());
    }
    starts
}

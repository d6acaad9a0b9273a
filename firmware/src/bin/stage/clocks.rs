//! The clock tree: 8 MHz crystal, 168 MHz core.
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

/// Starts the crystal and the PLL and switches over to them.
pub fn start(rcc: pac::RCC) -> Rcc {
    rcc.freeze(
        Config::hse(CRYSTAL)
            .sysclk(Hertz::Hz(TIM1_HZ))
            .hclk(Hertz::Hz(TIM1_HZ))
            .pclk1(Hertz::Hz(APB1_HZ))
            .pclk2(Hertz::Hz(APB2_HZ)),
    )
}

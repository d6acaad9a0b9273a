//! TIM3: the interrupt that latches the encoders, 15 us before each tick.
//!
//! TIM3 and TIM1 count the same clock, so the phase between them never drifts; it is set once by starting TIM3 part of
//! the way into its period, and the two timers one store apart.

use crate::{clocks, pwm::PwmTimer};
use stm32f4xx_hal::{
    pac,
    rcc::{Enable, Rcc},
};

/// Control ticks in a second.
pub const TICK_HZ: u32 = 20_000;
/// From the latch to the tick, us: 64 bits at 5.25 MHz take 12.2 us, the rest is for the interrupt and the DMA.
pub const LEAD_US: u32 = 15;

const PERIOD: u16 = (clocks::TIM3_HZ / TICK_HZ) as u16;
const LEAD: u16 = (clocks::TIM3_HZ / 1_000_000 * LEAD_US) as u16;

const _: () = assert!(PERIOD as u32 * TICK_HZ == clocks::TIM3_HZ);

/// The latch timer.
pub struct LatchTimer {
    tim: pac::TIM3,
}

impl LatchTimer {
    /// Configures TIM3, stopped.
    pub fn new(tim: pac::TIM3, rcc: &mut Rcc) -> Self {
        pac::TIM3::enable(rcc);
        tim.cr1().write(|w| w.urs().counter_only());
        tim.arr().write(|w| w.arr().set(PERIOD - 1));
        tim.egr().write(|w| w.ug().set_bit());
        tim.cnt().write(|w| w.cnt().set(LEAD));
        tim.dier().write(|w| w.uie().enabled());
        Self { tim }
    }

    /// Starts both timers: the first latch comes 35 us, the first tick 50 us from now.
    pub fn start_with(&mut self, pwm: &mut PwmTimer) {
        self.tim.cr1().modify(|_, w| w.cen().enabled());
        pwm.start();
    }

    /// Acknowledges the interrupt.
    pub fn acknowledge(&mut self) {
        self.tim.sr().write(|w| w.uif().clear_bit());
    }
}

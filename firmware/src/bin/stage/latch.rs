//! TIM3: the interrupt that latches the encoders, before each tick.
//!
//! TIM3 and TIM1 count the same clock, so the phase between them never drifts; it is set once by starting TIM3 part of
//! the way into its period, and the two timers one store apart.

use crate::{
    pwm::PwmTimer,
    timeline::{LATCH_COUNTS, LEAD_COUNTS},
};
use stm32f4xx_hal::{
    pac,
    rcc::{Enable, Rcc},
};

/// The latch timer.
pub struct LatchTimer {
    tim: pac::TIM3,
}

impl LatchTimer {
    /// Configures TIM3, stopped.
    pub fn new(tim: pac::TIM3, rcc: &mut Rcc) -> Self {
        pac::TIM3::enable(rcc);
        tim.cr1().write(|w| w.urs().counter_only());
        tim.arr().write(|w| w.arr().set(LATCH_COUNTS - 1));
        tim.egr().write(|w| w.ug().set_bit());
        tim.cnt().write(|w| w.cnt().set(LEAD_COUNTS));
        tim.dier().write(|w| w.uie().enabled());
        Self { tim }
    }

    /// Starts both timers: the first latch comes 35 us, the first tick 50 us from now.
    pub fn start_with(&mut self, pwm: &mut PwmTimer) {
        self.tim.cr1().modify(|_, w| w.cen().enabled());
        pwm.start();
    }

    /// Counts since the event.
    #[inline(always)]
    pub fn counts(&self) -> u32 {
        self.tim.cnt().read().bits()
    }

    /// Acknowledges the interrupt.
    pub fn acknowledge(&mut self) {
        self.tim.sr().write(|w| w.uif().clear_bit());
    }
}

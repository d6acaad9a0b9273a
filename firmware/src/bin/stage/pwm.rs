//! TIM1: three edge-aligned PWM outputs of 40 kHz, the tick's interrupt, and the break input.
//!
//! Compare values are preloaded: what the tick writes takes over at the next PWM period, whole. The tick is the interrupt
//! of channel 4's compare event, so that it may come anywhere in a PWM period (`timeline`): it has the rest of that one
//! and the whole next one, and its duty acts with the one after. The latch task arms it in every second PWM period, and
//! the tick disarms it. A late tick may write its three duties on both sides of a period's beginning: for that period the motors have
//! duties of two ticks. Each has a loop of its own, and the tick counts as late.
//!
//! While the break input is low the outputs are low without any software, and they stay low until [`Bridges::drive`]
//! finds the input released: low brakes the motors (the bridges' phase/enable mode).

use crate::timeline::{PWM_COUNTS, TICK_COUNT};
use core::convert::Infallible;
use embedded_hal::pwm::{ErrorType, SetDutyCycle};
use stm32f4xx_hal::{
    pac,
    rcc::{Enable, Rcc},
};

/// The full duty.
pub const MAX_DUTY: u16 = PWM_COUNTS;

/// What is left of TIM1 when the PWM channels are taken out.
pub struct PwmTimer {
    tim: pac::TIM1,
}

/// The latch's part of TIM1: what lets the tick's interrupt come.
pub struct TickEvent(());

/// One PWM output: TIM1 channel `CHANNEL`, 1 to 3.
pub struct PwmChannel<const CHANNEL: u8>(());

/// Configures TIM1, stopped, the outputs held low.
pub fn configure(
    tim: pac::TIM1,
    rcc: &mut Rcc,
) -> (
    PwmTimer,
    TickEvent,
    (PwmChannel<1>, PwmChannel<2>, PwmChannel<3>),
) {
    pac::TIM1::enable(rcc);
    // URS: only an overflow sets the update flag, not the software update below.
    tim.cr1().write(|w| w.arpe().enabled().urs().counter_only());
    tim.arr().write(|w| w.arr().set(MAX_DUTY - 1));
    tim.ccmr1_output().write(|w| {
        w.oc1m().pwm_mode1().oc1pe().enabled();
        w.oc2m().pwm_mode1().oc2pe().enabled()
    });
    tim.ccmr2_output()
        .write(|w| w.oc3m().pwm_mode1().oc3pe().enabled());
    tim.ccer()
        .write(|w| w.cc1e().set_bit().cc2e().set_bit().cc3e().set_bit());
    // Break on a low level, so that a broken wire stops; no automatic restart; a disabled output is held at its idle
    // level, low. Lock level 1 keeps a stray write from undoing that.
    tim.bdtr().write(|w| {
        w.bke().enabled().bkp().active_low();
        w.aoe().manual().ossi().idle_level();
        // SAFETY: 0b01 is lock level 1; the field's values are all defined.
        unsafe { w.lock().bits(0b01) }
    });
    tim.ccr(3).write(|w| w.ccr().set(TICK_COUNT));
    tim.egr().write(|w| w.ug().set_bit());
    // The first tick comes two whole periods after the start.
    tim.cnt().write(|w| w.cnt().set(TICK_COUNT));
    (
        PwmTimer { tim },
        TickEvent(()),
        (PwmChannel(()), PwmChannel(()), PwmChannel(())),
    )
}

impl TickEvent {
    /// Lets the next compare event interrupt. Called once a control period, in the tick's PWM period, before it.
    #[inline(always)]
    pub fn arm(&mut self) {
        // SAFETY: both registers are written as a whole, here and by the tick that this lets come.
        let tim = unsafe { &*pac::TIM1::ptr() };
        tim.sr().write(|w| w.cc4if().clear_bit());
        tim.dier().write(|w| w.cc4ie().enabled());
    }
}

impl PwmTimer {
    /// Acknowledges the tick's interrupt, and lets no further one come until the next latch.
    #[inline(always)]
    pub fn disarm_tick(&mut self) {
        self.tim.dier().reset();
        self.tim.sr().write(|w| w.cc4if().clear_bit());
    }

    /// Counts since the tick's compare event, cycles of the core: how long the interrupt took to get here.
    #[inline(always)]
    pub fn counts_since_tick(&self) -> u32 {
        let count = self.tim.cnt().read().cnt().bits();
        let since = count.wrapping_sub(TICK_COUNT);
        u32::from(if count < TICK_COUNT {
            since.wrapping_add(PWM_COUNTS)
        } else {
            since
        })
    }

    /// Whether the break has cut the outputs since the last call.
    pub fn take_break(&mut self) -> bool {
        let cut = self.tim.sr().read().bif().bit_is_set();
        if cut {
            // Has no effect while the input is still low.
            self.tim.sr().write(|w| w.bif().clear_bit());
        }
        cut
    }

    /// Connects the outputs, or holds them low. While the break input is low they stay low whatever is asked.
    pub fn connect(&mut self, connected: bool) {
        self.tim.bdtr().modify(|_, w| w.moe().bit(connected));
    }

    /// Starts counting.
    pub fn start(&mut self) {
        self.tim.cr1().modify(|_, w| w.cen().enabled());
    }
}

impl<const CHANNEL: u8> ErrorType for PwmChannel<CHANNEL> {
    type Error = Infallible;
}

impl<const CHANNEL: u8> SetDutyCycle for PwmChannel<CHANNEL> {
    fn max_duty_cycle(&self) -> u16 {
        MAX_DUTY
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        // SAFETY: each channel owns its compare register, which nothing else writes.
        let tim = unsafe { &*pac::TIM1::ptr() };
        tim.ccr(usize::from(CHANNEL - 1))
            .write(|w| w.ccr().set(duty.min(MAX_DUTY)));
        Ok(())
    }
}

/// Cuts the outputs from wherever the program has failed: low, the motors brake.
pub fn cut() {
    // SAFETY: for use when nothing else runs any more.
    let tim = unsafe { &*pac::TIM1::ptr() };
    tim.bdtr().modify(|_, w| w.moe().clear_bit());
}

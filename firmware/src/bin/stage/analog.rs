//! ADC1: the three motor currents and the supply, converted after each latch.
//!
//! The four channels are the converter's injected group, which has a result register for each: no DMA, nothing to
//! wait for, nothing to overrun. Started with the latch they are ready 7.6 us later, in the middle of a PWM period.
//!
//! A motor's current ripples with the PWM, by up to 0.4 A, and is its mean where the motor is shorted for half its time: at 12.5 us of
//! a short pulse's period. The four channels are sampled from 4 to 11 us after the period's beginning, before that, so that a current reads up to
//! a quarter of the ripple high. Whether the ripple is what it is computed to be, and whether it is worth a start by a timer's event, a
//! scope has to show: no emulator here has a ripple, or starts a converter by an event.

use firmware::drivers::power_stage::signed_current_counts;
use stm32f4xx_hal::{
    pac,
    rcc::{Enable, Rcc},
};

/// First of the four neighbouring channels.
const FIRST_CHANNEL: u8 = 10;
/// Code of 28 cycles of sampling; with 12 of conversion, 1.9 us at 21 MHz.
const SAMPLING: u8 = 2;

/// The converter.
pub struct Analog {
    adc: pac::ADC1,
}

/// What one group says, in counts of 12 bits.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counts {
    /// Motor currents, with their sign.
    pub current: [i16; 3],
    /// Supply voltage.
    pub supply: u16,
}

impl Analog {
    /// Switches the converter on.
    pub fn new(adc: pac::ADC1, common: &pac::ADC_COMMON, rcc: &mut Rcc) -> Self {
        pac::ADC1::enable(rcc);
        common.ccr().write(|w| w.adcpre().div4());
        adc.cr1().write(|w| w.scan().enabled());
        // SAFETY: every code of a sampling time, and channel numbers up to 18, are defined.
        unsafe {
            adc.smpr1().write(|w| {
                w.smp10().bits(SAMPLING).smp11().bits(SAMPLING);
                w.smp12().bits(SAMPLING).smp13().bits(SAMPLING)
            });
            adc.jsqr().write(|w| {
                w.jl().bits(3);
                w.jsq1().bits(FIRST_CHANNEL).jsq2().bits(FIRST_CHANNEL + 1);
                w.jsq3()
                    .bits(FIRST_CHANNEL + 2)
                    .jsq4()
                    .bits(FIRST_CHANNEL + 3)
            });
        }
        adc.cr2().write(|w| w.adon().enabled());
        Self { adc }
    }

    /// Starts the group.
    #[inline(always)]
    pub fn start(&mut self) {
        self.adc.cr2().modify(|_, w| w.jswstart().start());
    }

    /// The last group's results.
    #[inline(always)]
    pub fn counts(&self) -> Counts {
        Counts {
            current: [
                signed_current_counts(self.adc.jdr1().read().jdata().bits()),
                signed_current_counts(self.adc.jdr2().read().jdata().bits()),
                signed_current_counts(self.adc.jdr3().read().jdata().bits()),
            ],
            supply: self.adc.jdr4().read().jdata().bits(),
        }
    }
}

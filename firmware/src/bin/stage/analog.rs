//! ADC1: the three motor currents and the supply, converted after each latch.
//!
//! The four channels are the converter's injected group, which has a result register for each: no DMA, nothing to
//! wait for, nothing to overrun. Started with the latch they are ready 7.6 us later, in the middle of a PWM period: each
//! channel at its own place of the ripple, which the measurement of the currents has in its offset.
//!
//! Between groups the converter looks at its internal reference, over and over: what that reads says what the converter's
//! own supply is, which all its counts are shares of.

use firmware::drivers::power_stage::signed_current_counts;
use stm32f4xx_hal::{
    pac,
    rcc::{Enable, Rcc},
};

/// Code of 28 cycles of sampling; with 12 of conversion, 1.9 us at 21 MHz.
const SAMPLING: u8 = 2;
/// The internal reference, and the code of 480 cycles: it wants 10 us.
const REFERENCE: u8 = 17;
const REFERENCE_SAMPLING: u32 = 0b111;
/// What the maker has read there at a supply of [`CALIBRATION_SUPPLY_V`] (RM0090, 13.10; data sheet, table 84).
const REFERENCE_CALIBRATION: *const u16 = 0x1FFF_7A2A as *const u16;
const CALIBRATION_SUPPLY_V: f64 = 3.3;
/// So many channels have their sampling times in one register, the rest in the other.
const CHANNELS_0_TO_9: u8 = 10;

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
    /// Switches the converter on, to convert these channels: the three currents, the supply.
    pub fn new(adc: pac::ADC1, common: &pac::ADC_COMMON, channels: [u8; 4], rcc: &mut Rcc) -> Self {
        pac::ADC1::enable(rcc);
        (common.ccr()).write(|w| w.adcpre().div4().tsvrefe().enabled());
        // SAFETY: the code of a sampling time, in the bits of the channel.
        (adc.smpr1()).write(|w| unsafe {
            w.bits(REFERENCE_SAMPLING << (3 * (REFERENCE - CHANNELS_0_TO_9)))
        });
        // SAFETY: a channel. It is the whole regular group.
        (adc.sqr3()).write(|w| unsafe { w.sq1().bits(REFERENCE) });
        adc.cr1().write(|w| w.scan().enabled());
        for channel in channels {
            let code = u32::from(SAMPLING);
            // SAFETY: every code of a sampling time is defined; the bits are the channel's.
            unsafe {
                match channel.checked_sub(CHANNELS_0_TO_9) {
                    Some(above) => adc
                        .smpr1()
                        .modify(|r, w| w.bits(r.bits() | code << (3 * above))),
                    None => adc
                        .smpr2()
                        .modify(|r, w| w.bits(r.bits() | code << (3 * channel))),
                };
            }
        }
        let [first, second, third, supply] = channels;
        // SAFETY: these are channels.
        adc.jsqr().write(|w| unsafe {
            w.jl().bits(3);
            w.jsq1().bits(first).jsq2().bits(second);
            w.jsq3().bits(third).jsq4().bits(supply)
        });
        adc.cr2().write(|w| w.adon().enabled().cont().continuous());
        // In a store of its own: the converter takes a moment to wake up, and drops what was started before.
        adc.cr2().modify(|_, w| w.swstart().start());
        Self { adc }
    }

    /// Starts the group.
    #[inline(always)]
    pub fn start(&mut self) {
        self.adc.cr2().modify(|_, w| w.jswstart().start());
    }

    /// What the converter is supplied with, V: as the chip's own reference shows it.
    pub fn supply_v() -> f64 {
        // SAFETY: reading the result has no effect on the group that the tick reads, and the maker's word is there on every
        // part of the family.
        let (counts, calibration) = unsafe {
            (
                (*pac::ADC1::ptr()).dr().read().data().bits(),
                REFERENCE_CALIBRATION.read_volatile(),
            )
        };
        CALIBRATION_SUPPLY_V * f64::from(calibration) / f64::from(counts.max(1))
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

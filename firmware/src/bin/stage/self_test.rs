//! What the chip reads about itself for `TST?`: registers and identity. Nothing is changed. What is waited for, the
//! watchdog's oscillator and whole frames, takes a millisecond, and some where it does not come.

use crate::{
    analog::Analog, clocks, encoders, latch_timing, oscillator, pins, self_check,
    timeline::DEADLINE_CYCLES,
};
use core::ops::RangeInclusive;
use firmware::control::units::SUPPLY_V_PER_COUNT;
use firmware::drivers::biss::MOST_BITS_BEFORE_START;
use firmware::drivers::power_stage::signed_current_counts;
use firmware::self_test::{Board, Reading};
use stm32f4xx_hal::pac;

/// The crystal, Hz.
const CRYSTAL_HZ: f64 = 8e6;
/// STM32F427 and F429, and their revision 3: bank 2 of older ones can be read wrongly.
const DEVICE: f64 = 0x419 as f64;
const REVISION_3: f64 = 0x2001 as f64;
const DBGMCU_IDCODE: *const u32 = 0xE004_2000 as *const u32;
const FLASH_KIB: *const u16 = 0x1FFF_7A22 as *const u16;
/// The bridges' supply at which the stage runs, V.
const SUPPLY_V: RangeInclusive<f64> = 45.6..=50.4;
/// Counts of a current with the bridge asleep: 30 mA, twice what shunt amplifier, reference and converter may be off.
const NO_CURRENT: RangeInclusive<f64> = -8.0..=8.0;
/// The chip's own supply, V: what the converter's counts are shares of.
const CHIP_SUPPLY_V: RangeInclusive<f64> = 3.2..=3.4;
const CONVERTER_SUPPLY_V: f64 = 3.3;
/// The watchdog's oscillator, Hz (data sheet, table 43).
const OSCILLATOR_HZ: RangeInclusive<f64> = 17e3..=47e3;
/// Counts of 84 MHz: half a microsecond. So much a latch may wander, and so much has to be left before a frame is missing.
const MOST_JITTER: f64 = 42.0;
const LEAST_MARGIN: f64 = 42.0;
/// Pins: emergency stop (PE15) released; sleep (PD4 to PD6) low.
const RELEASED: u32 = 1 << 15;
const SLEEP_PINS: u32 = 0b111 << 4;

/// The chip of this board.
pub struct StageBoard;

/// How often to look for whole frames: one comes in 50 us, and for 12 of them there are bytes of two.
const FRAME_LOOKS: u32 = 1_000;

/// Clocks before each encoder's start bit; 0 where there is no good frame.
fn bits_before_start() -> [f64; 3] {
    [0, 1, 2].map(|pivot| {
        let found =
            (0..FRAME_LOOKS).find_map(|_| encoders::last_frames().get(pivot)?.bits_before_start());
        f64::from(found.unwrap_or(0))
    })
}

fn exactly(value: f64) -> RangeInclusive<f64> {
    value..=value
}

impl Board for StageBoard {
    fn name(&self) -> &'static str {
        pins::NAME
    }

    fn has_debugger(&self) -> bool {
        cortex_m::peripheral::DCB::is_debugger_attached()
    }

    fn deadline_cycles(&self) -> Option<u32> {
        Some(DEADLINE_CYCLES)
    }

    fn readings(&self, tell: &mut dyn FnMut(&Reading)) {
        let mut say = |name, value: f64, unit, good| {
            tell(&Reading {
                name,
                value,
                unit,
                good,
            });
        };
        // SAFETY: registers and identity are read only, and reading these has no effect.
        let (rcc, flash, adc, ports, id, kib) = unsafe {
            (
                &*pac::RCC::ptr(),
                &*pac::FLASH::ptr(),
                &*pac::ADC1::ptr(),
                (&*pac::GPIOD::ptr(), &*pac::GPIOE::ptr()),
                DBGMCU_IDCODE.read_volatile(),
                FLASH_KIB.read_volatile(),
            )
        };
        say("DEVICE", f64::from(id & 0xFFF), "", exactly(DEVICE));
        say(
            "REVISION",
            f64::from(id >> 16),
            "",
            REVISION_3..=f64::from(u16::MAX),
        );
        say("FLASH", f64::from(kib), "KiB", exactly(2048.0));
        let on_pll = rcc.cfgr().read().sws().is_pll();
        let pll = rcc.pllcfgr().read();
        let vco_hz = CRYSTAL_HZ / f64::from(pll.pllm().bits()) * f64::from(pll.plln().bits());
        let divider = 2.0 * (f64::from(pll.pllp().bits()) + 1.0);
        let core_hz = if on_pll { vco_hz / divider } else { 0.0 };
        say("CORE", core_hz, "Hz", exactly(f64::from(clocks::CORE_HZ)));
        let crystal = rcc.cr().read().hserdy().bit_is_set();
        say("CRYSTAL", f64::from(u8::from(crystal)), "", exactly(1.0));
        let acr = flash.acr().read();
        say(
            "WAIT_STATES",
            f64::from(acr.latency().bits()),
            "",
            exactly(5.0),
        );
        let cached =
            acr.prften().bit_is_set() && acr.icen().bit_is_set() && acr.dcen().bit_is_set();
        say("CACHES", f64::from(u8::from(cached)), "", exactly(1.0));
        let own_vectors = self_check::has_own_vectors();
        say(
            "VECTORS",
            f64::from(u8::from(own_vectors)),
            "",
            exactly(1.0),
        );
        let options = flash.optcr().read().bits();
        say(
            "BROWN_OUT_LEVEL",
            f64::from(3 - (options >> 2 & 3)),
            "",
            exactly(3.0),
        );
        say("BOOT_BANK_2", f64::from(options >> 4 & 1), "", exactly(0.0));
        say(
            "WATCHDOG_BY_SOFTWARE",
            f64::from(options >> 5 & 1),
            "",
            exactly(1.0),
        );
        // SAFETY: as above.
        let low = unsafe { &*pac::PWR::ptr() }.csr().read().pvdo().bit();
        say(
            "FLASH_SUPPLY_LOW",
            f64::from(u8::from(low)),
            "",
            exactly(0.0),
        );
        let chip_supply_v = Analog::supply_v();
        say("CHIP_SUPPLY", chip_supply_v, "V", CHIP_SUPPLY_V);
        let oscillator_hz = oscillator::rate_hz().unwrap_or(0.0);
        say("LSI", oscillator_hz, "Hz", OSCILLATOR_HZ);
        say(
            "LATCH_JITTER",
            f64::from(latch_timing::jitter()),
            "counts of 84 MHz",
            0.0..=MOST_JITTER,
        );
        say(
            "FRAME_MARGIN",
            f64::from(latch_timing::frame_margin()),
            "counts of 84 MHz",
            LEAST_MARGIN..=f64::from(latch_timing::MOST_MARGIN),
        );
        let names = ["FRAME_START1", "FRAME_START2", "FRAME_START3"];
        for (name, bits) in names.into_iter().zip(bits_before_start()) {
            say(
                name,
                bits,
                "clocks",
                1.0..=f64::from(MOST_BITS_BEFORE_START),
            );
        }
        let released = ports.1.idr().read().bits() & RELEASED != 0;
        say(
            "EMERGENCY_STOP",
            f64::from(u8::from(!released)),
            "",
            exactly(0.0),
        );
        let awake = ports.0.odr().read().bits() & SLEEP_PINS != 0;
        say(
            "BRIDGES_AWAKE",
            f64::from(u8::from(awake)),
            "",
            exactly(0.0),
        );
        let counts = [
            adc.jdr1().read().jdata().bits(),
            adc.jdr2().read().jdata().bits(),
            adc.jdr3().read().jdata().bits(),
        ]
        .map(signed_current_counts);
        for (name, counts) in ["CURRENT1", "CURRENT2", "CURRENT3"].into_iter().zip(counts) {
            say(name, f64::from(counts), "counts", NO_CURRENT);
        }
        let supply_v = f64::from(adc.jdr4().read().jdata().bits())
            * SUPPLY_V_PER_COUNT
            * (chip_supply_v / CONVERTER_SUPPLY_V);
        say("SUPPLY", supply_v, "V", SUPPLY_V);
    }
}

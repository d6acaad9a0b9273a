//! What the chip reads about itself for `TST?`: registers and identity, nothing is changed and nothing waits.

use crate::{clocks, pins};
use core::ops::RangeInclusive;
use firmware::control::units::SUPPLY_V_PER_COUNT;
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
/// Pins: emergency stop (PE15) released; sleep (PD4 to PD6) low.
const RELEASED: u32 = 1 << 15;
const SLEEP_PINS: u32 = 0b111 << 4;

/// The chip of this board.
pub struct StageBoard;

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
        let supply_v = f64::from(adc.jdr4().read().jdata().bits()) * SUPPLY_V_PER_COUNT;
        say("SUPPLY", supply_v, "V", SUPPLY_V);
    }
}

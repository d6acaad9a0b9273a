//! The flash that settings are kept in: the four sectors of 16 KiB at the beginning of bank 2.
//!
//! Code lies in bank 1 (`memory.x`) and goes on from there while bank 2 is written: the tick never waits. The idle task
//! does, giving the watchdog its signs of life: 16 us for a word, 0.25 s, 0.5 s at most, for an erase. Meanwhile no line is answered;
//! what comes in gathers in the receiver's ring of 2 KiB.
//!
//! Reading one bank while the other is written may corrupt the data cache (erratum 2.2.15), so that is off while a
//! sector is written, and empty when it is on again. The loop does not mind: its code and its
//! constants are in RAM (`loop_memory`; `cargo image-check` looks).

use crate::{self_check::SelfCheck, watchdog};
use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash, check_erase, check_read,
    check_write,
};
use firmware::gcs::STORED_BYTES;
use stm32f4xx_hal::{
    pac,
    rcc::{Enable, Rcc},
};

/// Where it begins, after the code's memory.
const BEGIN: usize = 0x0810_0000;
const SECTORS: usize = 4;
const SECTOR_BYTES: usize = 16 << 10;
/// The code of its first sector, number 12, in `SNB`: bank 2 counts from 16.
const FIRST_SECTOR: u8 = 0b1_0000;
const KEYS: [u32; 2] = [0x4567_0123, 0xCDEF_89AB];
/// Every error flag of `SR`, cleared by writing it.
const ERRORS: u32 = 0b1_1111_0010;

const _: () = assert!(STORED_BYTES <= SECTOR_BYTES);

/// See the module.
pub struct SettingsFlash {
    flash: pac::FLASH,
    power: pac::PWR,
    has_second_bank: bool,
}

/// Code of the detector's highest threshold, some 2.9 V: words of 32 bits are programmed from 2.7 V on.
const LOW_SUPPLY: u8 = 0b111;

impl SettingsFlash {
    /// In bank 2, if there is one. Without, every access is refused: reading there is a processor fault.
    pub fn new(flash: pac::FLASH, power: pac::PWR, chip: &SelfCheck, rcc: &mut Rcc) -> Self {
        pac::PWR::enable(rcc);
        // SAFETY: every code is a threshold.
        (power.cr()).modify(|_, w| unsafe { w.pls().bits(LOW_SUPPLY).pvde().set_bit() });
        Self {
            flash,
            power,
            has_second_bank: chip.has_second_bank,
        }
    }

    /// Whether flash can be changed now: with the chip's supply going down, what is written might not be what is read.
    fn check_supply(&self) -> Result<(), FlashError> {
        if self.power.csr().read().pvdo().bit_is_set() {
            Err(FlashError::SupplyLow)
        } else {
            Ok(())
        }
    }

    fn check_bank(&self) -> Result<(), FlashError> {
        if self.has_second_bank {
            Ok(())
        } else {
            Err(FlashError::Absent)
        }
    }

    /// Lets `change` do what it does to the flash.
    fn unlocked(
        &mut self,
        change: impl FnOnce(&mut Self) -> Result<(), FlashError>,
    ) -> Result<(), FlashError> {
        self.check_bank()?;
        self.flash.acr().modify(|_, w| w.dcen().disabled());
        for key in KEYS {
            // SAFETY: the two keys in this order are what unlocks the control register.
            self.flash.keyr().write(|w| unsafe { w.bits(key) });
        }
        // SAFETY: writing ones clears flags, and these are flags.
        self.flash.sr().write(|w| unsafe { w.bits(ERRORS) });
        let result = change(self);
        self.flash.cr().write(|w| w.lock().locked());
        // Can be written only while the cache is off.
        self.flash.acr().modify(|_, w| w.dcrst().reset());
        self.flash.acr().modify(|_, w| w.dcrst().no_reset());
        self.flash.acr().modify(|_, w| w.dcen().enabled());
        result
    }

    /// Waits for the end of what was begun.
    fn finish(&mut self) -> Result<(), FlashError> {
        while self.flash.sr().read().bsy().is_busy() {
            watchdog::note_alive();
        }
        if self.flash.sr().read().bits() & ERRORS == 0 {
            Ok(())
        } else {
            Err(FlashError::Refused)
        }
    }
}

/// Why the flash can not be read or written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlashError {
    /// Not there, or not whole words or sectors.
    Place(NorFlashErrorKind),
    /// Its controller has refused it.
    Refused,
    /// The chip's supply is too low.
    SupplyLow,
    /// The chip has no second bank.
    Absent,
}

impl NorFlashError for FlashError {
    fn kind(&self) -> NorFlashErrorKind {
        match self {
            Self::Place(kind) => *kind,
            Self::Refused | Self::SupplyLow | Self::Absent => NorFlashErrorKind::Other,
        }
    }
}

impl ErrorType for SettingsFlash {
    type Error = FlashError;
}

impl ReadNorFlash for SettingsFlash {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), FlashError> {
        check_read(self, offset, bytes.len()).map_err(FlashError::Place)?;
        self.check_bank()?;
        for (at, byte) in (BEGIN + offset as usize..).zip(bytes) {
            // SAFETY: in the flash, which can be read at any address. Volatile: the compiler does not know who writes
            // it.
            *byte = unsafe { (at as *const u8).read_volatile() };
        }
        Ok(())
    }

    fn capacity(&self) -> usize {
        SECTORS * SECTOR_BYTES
    }
}

impl NorFlash for SettingsFlash {
    const WRITE_SIZE: usize = 4;
    const ERASE_SIZE: usize = SECTOR_BYTES;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), FlashError> {
        check_erase(self, from, to).map_err(FlashError::Place)?;
        let sectors = from as usize / SECTOR_BYTES..to as usize / SECTOR_BYTES;
        self.unlocked(|flash| {
            for sector in sectors {
                flash.check_supply()?;
                let number = FIRST_SECTOR + sector as u8;
                // SAFETY: the number of a sector of bank 2, in which there is no code.
                (flash.flash.cr()).write(|w| unsafe {
                    w.psize().psize32().ser().sector_erase();
                    w.snb().bits(number)
                });
                // In a store of its own (RM0090, 3.6.3).
                flash.flash.cr().modify(|_, w| w.strt().start());
                flash.finish()?;
            }
            Ok(())
        })
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), FlashError> {
        check_write(self, offset, bytes.len()).map_err(FlashError::Place)?;
        self.unlocked(|flash| {
            flash.check_supply()?;
            flash
                .flash
                .cr()
                .write(|w| w.psize().psize32().pg().program());
            let words = bytes.chunks_exact(4).map(|word| {
                let mut bytes = [0; 4];
                bytes.copy_from_slice(word);
                u32::from_le_bytes(bytes)
            });
            for (place, word) in (BEGIN + offset as usize..).step_by(4).zip(words) {
                flash.check_supply()?;
                // SAFETY: a word of bank 2, in which there is no code; the controller is ready to program it.
                unsafe { (place as *mut u32).write_volatile(word) };
                // The word has arrived before the controller is asked whether it is busy.
                cortex_m::asm::dsb();
                flash.finish()?;
            }
            Ok(())
        })
    }
}

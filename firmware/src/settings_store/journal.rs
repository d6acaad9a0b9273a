//! Where images lie: records one behind the other, from sector to sector round the flash.
//!
//! The newest whole record counts. The next one goes behind it, or, where there is no erased room for it, into the next
//! sector, which is erased before. A sector that is erased holds older records only, so it does not matter what an
//! erase that is cut off leaves behind.

use super::envelope::{EnvelopeState, Header, Reader, WORD, Writer, is_erased};
use super::error::StoreError;
use core::ops::Range;
use embedded_storage::nor_flash::NorFlash;

/// What a flash holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FlashState {
    /// Nothing was ever stored.
    Empty,
    /// There is a newest record.
    Good,
    /// There was one and it is broken, or something else is there.
    Damaged,
}

/// See the module.
pub(super) struct Journal<F> {
    flash: F,
    /// The newest whole record, and where it is.
    newest: Option<(Header, u32)>,
    /// The highest generation seen.
    generation: u32,
}

impl<F: NorFlash> Journal<F> {
    const SECTOR: u32 = F::ERASE_SIZE as u32;

    pub const fn new(flash: F) -> Self {
        const {
            assert!((WORD as usize).is_multiple_of(F::WRITE_SIZE));
            assert!((WORD as usize).is_multiple_of(F::READ_SIZE));
        }
        Self {
            flash,
            newest: None,
            generation: 0,
        }
    }

    pub fn into_flash(self) -> F {
        self.flash
    }

    pub const fn flash(&mut self) -> &mut F {
        &mut self.flash
    }

    /// Looks through the whole flash.
    pub fn open(&mut self) -> FlashState {
        self.newest = None;
        self.generation = 0;
        self.scan().unwrap_or(FlashState::Damaged)
    }

    /// The newest image.
    pub fn newest(&mut self) -> Option<Reader<'_, F>> {
        let (header, at) = self.newest?;
        Some(header.reader(&mut self.flash, at))
    }

    fn sectors(&self) -> u32 {
        self.flash.capacity() as u32 / Self::SECTOR
    }

    fn scan(&mut self) -> Result<FlashState, F::Error> {
        let (mut broken, mut has_foreign_data) = (0, false);
        for sector in 0..self.sectors() {
            let (mut at, end) = (sector * Self::SECTOR, (sector + 1) * Self::SECTOR);
            while let Some(header) = Header::read(&mut self.flash, at, end)? {
                self.generation = self.generation.max(header.generation);
                match header.verify(&mut self.flash, at)? {
                    EnvelopeState::Whole => self.track_newest(header, at),
                    EnvelopeState::Unfinished => {}
                    EnvelopeState::Broken => broken = broken.max(header.generation),
                }
                at += header.envelope_bytes();
            }
            // A header that was cut off may stand there.
            let begun = Header {
                generation: 0,
                length: 0,
            }
            .envelope_bytes();
            has_foreign_data |= !is_erased(&mut self.flash, (at + begun).min(end)..end)?;
        }
        Ok(match self.newest {
            Some((newest, _)) if broken > newest.generation => FlashState::Damaged,
            Some(_) => FlashState::Good,
            None if broken > 0 || has_foreign_data => FlashState::Damaged,
            None => FlashState::Empty,
        })
    }

    fn track_newest(&mut self, header: Header, at: u32) {
        if self
            .newest
            .is_none_or(|(newest, _)| newest.generation < header.generation)
        {
            self.newest = Some((header, at));
        }
    }

    /// Writes an image of `length` bytes, which `fill` puts. Where the flash does not take it the next sector is tried.
    ///
    /// # Errors
    /// [`StoreError`]; the newest record is what it was.
    pub fn append(
        &mut self,
        length: u32,
        fill: impl Fn(&mut Writer<'_, F>) -> Result<(), F::Error>,
    ) -> Result<(), StoreError> {
        let header = Header {
            generation: self.generation + 1,
            length,
        };
        if length > Self::SECTOR || header.envelope_bytes() > Self::SECTOR {
            return Err(StoreError::TooLong);
        }
        let sectors = self.sectors();
        if sectors < 2 {
            // The newest record would have to be erased first.
            return Err(StoreError::Flash);
        }
        // Whatever becomes of it, the generation is used up.
        self.generation = header.generation;
        let behind = self.place_after_newest(&header);
        let last = self.newest.map_or(sectors - 1, |(_, at)| at / Self::SECTOR);
        let others = (1..sectors).map(|step| (last + step) % sectors * Self::SECTOR);
        for at in behind.into_iter().chain(others) {
            if let Ok(true) = self.write(&header, at, &fill) {
                self.newest = Some((header, at));
                return Ok(());
            }
        }
        Err(StoreError::Flash)
    }

    /// The place behind the newest record, if it has room for another one.
    fn place_after_newest(&mut self, header: &Header) -> Option<u32> {
        let (newest, at) = self.newest?;
        let sector_end = (at / Self::SECTOR + 1) * Self::SECTOR;
        let next = at + newest.envelope_bytes();
        let range = next..next.checked_add(header.envelope_bytes())?;
        let free = range.end <= sector_end && is_erased(&mut self.flash, range).unwrap_or(false);
        free.then_some(next)
    }

    /// Writes a record; whether it is there then.
    fn write(
        &mut self,
        header: &Header,
        at: u32,
        fill: &impl Fn(&mut Writer<'_, F>) -> Result<(), F::Error>,
    ) -> Result<bool, F::Error> {
        if at.is_multiple_of(Self::SECTOR) && !self.ensure_erased(at..at + Self::SECTOR)? {
            return Ok(false);
        }
        let mut writer = header.begin(&mut self.flash, at)?;
        fill(&mut writer)?;
        writer.finish()?;
        let whole = Header::read(&mut self.flash, at, at + header.envelope_bytes())?
            == Some(*header)
            && header.verify(&mut self.flash, at)? == EnvelopeState::Whole;
        if whole {
            header.end(&mut self.flash, at)?;
        }
        Ok(whole)
    }

    fn ensure_erased(&mut self, sector: Range<u32>) -> Result<bool, F::Error> {
        if is_erased(&mut self.flash, sector.clone())? {
            return Ok(true);
        }
        self.flash.erase(sector.start, sector.end)?;
        is_erased(&mut self.flash, sector)
    }
}

//! Where images lie: records one behind the other, from sector to sector round the flash.
//!
//! The newest whole record counts. The next one goes behind it, or, where there is no erased room for it, into the next
//! sector, which is erased before. A sector that is erased holds older records only, so it does not matter what an erase
//! that is cut off leaves behind.

use super::envelope::{Head, Reader, WORD, Wholeness, Writer, is_erased};
use super::error::StoreError;
use core::ops::Range;
use embedded_storage::nor_flash::NorFlash;

/// What a flash holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Condition {
    /// Nothing was ever kept.
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
    newest: Option<(Head, u32)>,
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

    pub const fn flash(&mut self) -> &mut F {
        &mut self.flash
    }

    /// Looks through the whole flash.
    pub fn open(&mut self) -> Condition {
        self.newest = None;
        self.generation = 0;
        self.scan().unwrap_or(Condition::Damaged)
    }

    /// The newest image.
    pub fn newest(&mut self) -> Option<Reader<'_, F>> {
        let (head, at) = self.newest?;
        Some(head.reader(&mut self.flash, at))
    }

    fn sectors(&self) -> u32 {
        self.flash.capacity() as u32 / Self::SECTOR
    }

    fn scan(&mut self) -> Result<Condition, F::Error> {
        let (mut broken, mut strange) = (0, false);
        for sector in 0..self.sectors() {
            let (mut at, end) = (sector * Self::SECTOR, (sector + 1) * Self::SECTOR);
            while let Some(head) = Head::read(&mut self.flash, at, end)? {
                self.generation = self.generation.max(head.generation);
                match head.look(&mut self.flash, at)? {
                    Wholeness::Whole => self.note(head, at),
                    Wholeness::Unfinished => {}
                    Wholeness::Broken => broken = broken.max(head.generation),
                }
                at += head.record_bytes();
            }
            // A head that was cut off may stand there.
            let begun = Head {
                generation: 0,
                length: 0,
            }
            .record_bytes();
            strange |= !is_erased(&mut self.flash, (at + begun).min(end)..end)?;
        }
        Ok(match self.newest {
            Some((newest, _)) if broken > newest.generation => Condition::Damaged,
            Some(_) => Condition::Good,
            None if broken > 0 || strange => Condition::Damaged,
            None => Condition::Empty,
        })
    }

    fn note(&mut self, head: Head, at: u32) {
        if self
            .newest
            .is_none_or(|(newest, _)| newest.generation < head.generation)
        {
            self.newest = Some((head, at));
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
        let head = Head {
            generation: self.generation + 1,
            length,
        };
        if length > Self::SECTOR || head.record_bytes() > Self::SECTOR {
            return Err(StoreError::TooLong);
        }
        let sectors = self.sectors();
        if sectors < 2 {
            // The newest record would have to be erased first.
            return Err(StoreError::Flash);
        }
        // Whatever becomes of it, the generation is used up.
        self.generation = head.generation;
        let behind = self.behind(&head);
        let last = self.newest.map_or(sectors - 1, |(_, at)| at / Self::SECTOR);
        let others = (1..sectors).map(|step| (last + step) % sectors * Self::SECTOR);
        for at in behind.into_iter().chain(others) {
            if let Ok(true) = self.write(&head, at, &fill) {
                self.newest = Some((head, at));
                return Ok(());
            }
        }
        Err(StoreError::Flash)
    }

    /// The place behind the newest record, if it has room for another one.
    fn behind(&mut self, head: &Head) -> Option<u32> {
        let (newest, at) = self.newest?;
        let sector_end = (at / Self::SECTOR + 1) * Self::SECTOR;
        let next = at + newest.record_bytes();
        let range = next..next.checked_add(head.record_bytes())?;
        let free = range.end <= sector_end && is_erased(&mut self.flash, range).unwrap_or(false);
        free.then_some(next)
    }

    /// Writes a record; whether it is there then.
    fn write(
        &mut self,
        head: &Head,
        at: u32,
        fill: &impl Fn(&mut Writer<'_, F>) -> Result<(), F::Error>,
    ) -> Result<bool, F::Error> {
        if at.is_multiple_of(Self::SECTOR) && !self.make_erased(at..at + Self::SECTOR)? {
            return Ok(false);
        }
        let mut writer = head.begin(&mut self.flash, at)?;
        fill(&mut writer)?;
        writer.finish()?;
        let whole = Head::read(&mut self.flash, at, at + head.record_bytes())? == Some(*head)
            && head.look(&mut self.flash, at)? == Wholeness::Whole;
        if whole {
            head.end(&mut self.flash, at)?;
        }
        Ok(whole)
    }

    fn make_erased(&mut self, sector: Range<u32>) -> Result<bool, F::Error> {
        if is_erased(&mut self.flash, sector.clone())? {
            return Ok(true);
        }
        self.flash.erase(sector.start, sector.end)?;
        is_erased(&mut self.flash, sector)
    }
}

//! Contents in their envelope.
//!
//! ```text
//! | header 16 | the same again | contents, padded to words | CRC 4 | end 4 |
//!   magic, generation, length, CRC of these           of header and contents
//! ```
//!
//! Written from left to right, the end when the contents have been read back and found right. So a wrong CRC is a power
//! cut as long as the end is still erased, and damage when it is not. The header stands there twice, so that damage to
//! one of them hides nothing. All CRCs are the 32-bit one of Ethernet and zip.

use core::ops::Range;
use crc::{CRC_32_ISO_HDLC, Crc, Digest};
use embedded_storage::nor_flash::NorFlash;

/// Bytes of a word, the least that is written.
pub(super) const WORD: u32 = 4;
const HEADER_BYTES: u32 = 16;
/// Bytes before the contents.
const HEADERS_BYTES: u32 = 2 * HEADER_BYTES;
/// "TPS1"
const MAGIC: u32 = 0x3153_5054;
/// What an end is, once written.
const END: [u8; 4] = [0; 4];
const ERASED: u8 = 0xFF;
/// Bytes read or written at a time.
const CHUNK_BYTES: usize = 64;

const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// Bytes that contents of so many bytes take in the flash.
pub const fn envelope_bytes(contents: u32) -> u32 {
    HEADERS_BYTES + contents.next_multiple_of(WORD) + 2 * WORD
}

/// What stands before the contents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Header {
    /// One more than that of the record before. No flash lives to see half of them.
    pub generation: u32,
    /// Bytes of the contents.
    pub length: u32,
}

/// What an envelope with a header is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum EnvelopeState {
    Whole,
    /// A power cut ended it.
    Unfinished,
    /// It was whole once.
    Broken,
}

impl Header {
    /// Bytes of the whole envelope.
    pub const fn envelope_bytes(&self) -> u32 {
        envelope_bytes(self.length)
    }

    fn bytes(&self) -> [u8; HEADER_BYTES as usize] {
        let mut bytes = [0; HEADER_BYTES as usize];
        let words = [MAGIC, self.generation, self.length];
        for (place, word) in bytes.chunks_exact_mut(4).zip(words) {
            place.copy_from_slice(&word.to_le_bytes());
        }
        let crc = CRC.checksum(&bytes[..12]);
        bytes[12..].copy_from_slice(&crc.to_le_bytes());
        bytes
    }

    fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let mut words = [0; 4];
        for (word, bytes) in words.iter_mut().zip(bytes.chunks_exact(4)) {
            *word = u32::from_le_bytes(bytes.try_into().ok()?);
        }
        let [magic, generation, length, crc] = words;
        let good =
            magic == MAGIC && crc == CRC.checksum(bytes.get(..12)?) && generation <= u32::MAX / 2;
        good.then_some(Self { generation, length })
    }

    /// The header at `at`, if there is one whose record ends before `end`.
    pub fn read<F: NorFlash>(flash: &mut F, at: u32, end: u32) -> Result<Option<Self>, F::Error> {
        if end.saturating_sub(at) < HEADERS_BYTES {
            return Ok(None);
        }
        let mut front = [0; HEADERS_BYTES as usize];
        flash.read(at, &mut front)?;
        let (first, second) = front.split_at(HEADER_BYTES as usize);
        let header = Self::from_bytes(first).or_else(|| Self::from_bytes(second));
        let fits = |header: &Self| header.length < end && header.envelope_bytes() <= end - at;
        Ok(header.filter(fits))
    }

    /// What has become of the record at `at`, of which this is the header.
    pub fn verify<F: NorFlash>(&self, flash: &mut F, at: u32) -> Result<EnvelopeState, F::Error> {
        let mut reader = self.reader(flash, at);
        let mut digest = CRC.digest();
        digest.update(&self.bytes());
        let mut piece = [0; CHUNK_BYTES];
        while reader.left > 0 {
            let length = CHUNK_BYTES.min(reader.left as usize);
            reader.read(&mut piece[..length])?;
            digest.update(&piece[..length]);
        }
        let mut tail = [0; 2 * WORD as usize];
        flash.read(at + self.envelope_bytes() - 2 * WORD, &mut tail)?;
        let (crc, end) = tail.split_at(WORD as usize);
        Ok(if crc == digest.finalize().to_le_bytes() {
            EnvelopeState::Whole
        } else if end.iter().all(|&byte| byte == ERASED) {
            EnvelopeState::Unfinished
        } else {
            EnvelopeState::Broken
        })
    }

    /// Reads the image of the record at `at`.
    pub const fn reader<'f, F>(&self, flash: &'f mut F, at: u32) -> Reader<'f, F> {
        Reader {
            flash,
            at: at + HEADERS_BYTES,
            left: self.length,
        }
    }

    /// Begins the record at `at`, where the flash is erased.
    pub fn begin<'f, F: NorFlash>(
        &self,
        flash: &'f mut F,
        at: u32,
    ) -> Result<Writer<'f, F>, F::Error> {
        let header = self.bytes();
        flash.write(at, &header)?;
        flash.write(at + HEADER_BYTES, &header)?;
        let mut digest = CRC.digest();
        digest.update(&header);
        Ok(Writer {
            flash,
            at: at + HEADERS_BYTES,
            piece: [0; CHUNK_BYTES],
            filled: 0,
            digest,
        })
    }

    /// Ends the record at `at`, which is whole.
    pub fn end<F: NorFlash>(&self, flash: &mut F, at: u32) -> Result<(), F::Error> {
        flash.write(at + self.envelope_bytes() - WORD, &END)
    }
}

/// Whether these bytes of the flash are erased.
pub(super) fn is_erased<F: NorFlash>(flash: &mut F, range: Range<u32>) -> Result<bool, F::Error> {
    let mut piece = [0; CHUNK_BYTES];
    let mut at = range.start;
    while at < range.end {
        let length = CHUNK_BYTES.min((range.end - at) as usize);
        flash.read(at, &mut piece[..length])?;
        if piece[..length].iter().any(|&byte| byte != ERASED) {
            return Ok(false);
        }
        at += length as u32;
    }
    Ok(true)
}

/// An image, from its beginning.
pub struct Reader<'f, F> {
    flash: &'f mut F,
    at: u32,
    left: u32,
}

impl<F: NorFlash> Reader<'_, F> {
    fn read(&mut self, bytes: &mut [u8]) -> Result<(), F::Error> {
        self.flash.read(self.at, bytes)?;
        self.at += bytes.len() as u32;
        self.left -= bytes.len() as u32;
        Ok(())
    }

    /// The next bytes of the image; none when there are not so many, or they cannot be read.
    pub fn fill(&mut self, bytes: &mut [u8]) -> Option<()> {
        (bytes.len() <= self.left as usize).then_some(())?;
        self.read(bytes).ok()
    }

    /// The next `N` bytes.
    pub fn take<const N: usize>(&mut self) -> Option<[u8; N]> {
        let mut bytes = [0; N];
        self.fill(&mut bytes)?;
        Some(bytes)
    }

    /// Whether that was all.
    pub const fn is_at_end(&self) -> bool {
        self.left == 0
    }
}

/// An image that is being written.
pub(super) struct Writer<'f, F> {
    flash: &'f mut F,
    at: u32,
    piece: [u8; CHUNK_BYTES],
    filled: usize,
    digest: Digest<'static, u32>,
}

/// Where an image goes.
pub trait Sink {
    /// Why it may not.
    type Error;
    /// More of it.
    fn put(&mut self, bytes: &[u8]) -> Result<(), Self::Error>;
}

impl<F: NorFlash> Sink for Writer<'_, F> {
    type Error = F::Error;

    fn put(&mut self, mut bytes: &[u8]) -> Result<(), F::Error> {
        self.digest.update(bytes);
        while !bytes.is_empty() {
            let room = &mut self.piece[self.filled..];
            let length = room.len().min(bytes.len());
            room[..length].copy_from_slice(&bytes[..length]);
            bytes = &bytes[length..];
            self.filled += length;
            if self.filled == CHUNK_BYTES {
                self.flush()?;
            }
        }
        Ok(())
    }
}

impl<F: NorFlash> Writer<'_, F> {
    fn flush(&mut self) -> Result<(), F::Error> {
        let length = self.filled.next_multiple_of(WORD as usize);
        self.flash.write(self.at, &self.piece[..length])?;
        self.at += length as u32;
        self.piece = [0; CHUNK_BYTES];
        self.filled = 0;
        Ok(())
    }

    /// Writes the CRC behind what was put.
    pub fn finish(mut self) -> Result<(), F::Error> {
        self.flush()?;
        let crc = self.digest.finalize().to_le_bytes();
        self.flash.write(self.at, &crc)
    }
}

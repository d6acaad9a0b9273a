//! The flash that the simulated controller keeps its settings in: as on the chip, in memory or in a file.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use drawing::write_whole;
use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash, check_erase, check_read,
    check_write,
};

const SECTORS: usize = 4;
const SECTOR_BYTES: usize = 16 << 10;
const BYTES: usize = SECTORS * SECTOR_BYTES;
const ERASED: u8 = 0xFF;

/// See the module. Writing clears bits, erasing a sector sets all of its bits; both are in the file when they return.
#[derive(Debug)]
pub struct SettingsFlash {
    bytes: Vec<u8>,
    file: Option<File>,
}

/// Why a file cannot stand for a flash.
#[derive(Debug, thiserror::Error)]
pub enum SettingsFileError {
    /// The system refuses it.
    #[error("cannot use {} for settings: {error}", path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// What the system says.
        error: io::Error,
    },
    /// It is a device, a pipe or a folder.
    #[error("{} is no file that keeps anything", .0.display())]
    NoFile(PathBuf),
    /// Another controller has it.
    #[error("{} is in use by another controller", .0.display())]
    InUse(PathBuf),
    /// It is something else.
    #[error("{} has {length} bytes and a controller's settings have {BYTES}: not such a file", path.display())]
    Length {
        /// Which.
        path: PathBuf,
        /// Bytes that it has.
        length: u64,
    },
}

impl SettingsFlash {
    /// Erased, and gone when it is dropped.
    #[must_use]
    pub fn in_memory() -> Self {
        Self {
            bytes: vec![ERASED; BYTES],
            file: None,
        }
    }

    /// With these bytes in the beginning, and gone when it is dropped.
    #[must_use]
    pub fn holding(bytes: &[u8]) -> Self {
        let mut flash = Self::in_memory();
        for (kept, byte) in flash.bytes.iter_mut().zip(bytes) {
            *kept = *byte;
        }
        flash
    }

    /// Whether nothing was ever stored in it.
    #[must_use]
    pub fn is_erased(&self) -> bool {
        self.bytes.iter().all(|&byte| byte == ERASED)
    }

    /// What it holds.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// With what a file holds; makes it, erased, where there is none. It is locked against others until dropped.
    ///
    /// # Errors
    /// [`SettingsFileError`]; the file is what it was.
    pub fn open(path: &Path) -> Result<Self, SettingsFileError> {
        let failed = |error| SettingsFileError::File {
            path: path.to_owned(),
            error,
        };
        let mut bytes = vec![ERASED; BYTES];
        match fs::metadata(path) {
            Ok(there) if !there.is_file() => {
                return Err(SettingsFileError::NoFile(path.to_owned()));
            }
            Ok(there) if there.len() > 0 => {}
            // Whole or not at all: a half-made one would stop every later start.
            _ => write_whole(path, &bytes).map_err(failed)?,
        }
        let mut file = (OpenOptions::new().read(true).write(true).open(path)).map_err(failed)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(SettingsFileError::InUse(path.to_owned())),
            Err(TryLockError::Error(error)) => return Err(failed(error)),
        }
        let length = file.metadata().map_err(failed)?.len();
        if length == BYTES as u64 {
            file.read_exact(&mut bytes).map_err(failed)?;
        } else {
            let path = path.to_owned();
            return Err(SettingsFileError::Length { path, length });
        }
        Ok(Self {
            bytes,
            file: Some(file),
        })
    }

    /// Brings the file up to date.
    fn store(&mut self, at: usize, length: usize) -> Result<(), FlashError> {
        if let Some(file) = &mut self.file {
            check_linked(file).map_err(FlashError::File)?;
            (file.seek(SeekFrom::Start(at as u64)))
                .and_then(|_| file.write_all(&self.bytes[at..at + length]))
                .map_err(FlashError::File)?;
        }
        Ok(())
    }
}

/// A file that was deleted meanwhile keeps nothing, though it can be written.
#[cfg(unix)]
fn check_linked(file: &File) -> io::Result<()> {
    use std::os::unix::fs::MetadataExt;

    match file.metadata()?.nlink() {
        0 => Err(io::ErrorKind::NotFound.into()),
        _ => Ok(()),
    }
}

/// Elsewhere a file that is open cannot be deleted.
#[cfg(not(unix))]
const fn check_linked(_: &File) -> io::Result<()> {
    Ok(())
}

/// Why the flash cannot be read or written.
#[derive(Debug)]
pub enum FlashError {
    /// Not there, or not whole words or sectors.
    Place(NorFlashErrorKind),
    /// The file cannot be written.
    File(io::Error),
}

impl NorFlashError for FlashError {
    fn kind(&self) -> NorFlashErrorKind {
        match self {
            Self::Place(kind) => *kind,
            Self::File(_) => NorFlashErrorKind::Other,
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
        bytes.copy_from_slice(&self.bytes[offset as usize..][..bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.bytes.len()
    }
}

impl NorFlash for SettingsFlash {
    const WRITE_SIZE: usize = 4;
    const ERASE_SIZE: usize = SECTOR_BYTES;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), FlashError> {
        check_erase(self, from, to).map_err(FlashError::Place)?;
        self.bytes[from as usize..to as usize].fill(ERASED);
        self.store(from as usize, (to - from) as usize)
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), FlashError> {
        check_write(self, offset, bytes.len()).map_err(FlashError::Place)?;
        for (kept, byte) in self.bytes[offset as usize..].iter_mut().zip(bytes) {
            *kept &= byte;
        }
        self.store(offset as usize, bytes.len())
    }
}

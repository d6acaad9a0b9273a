//! Files of a report: folders made, files written, and why they were not.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::png;
use crate::whole_file::write_whole;

/// Why a report was not written.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The file or folder cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Unwritable {
        /// Which.
        path: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// The folder holds something that is not ours.
    #[error("{} holds {file}, which this program has not written: name another folder with --out", folder.display())]
    NotOurs {
        /// The folder.
        folder: PathBuf,
        /// What is in it.
        file: String,
    },
    /// The picture could not be made into pixels.
    #[error("cannot render {}: {reason}", path.display())]
    Render {
        /// Which picture.
        path: PathBuf,
        /// What the renderer says.
        reason: String,
    },
}

/// Makes `folder` and everything above it, and finds out whether it takes files: before a long run, not after it.
///
/// # Errors
/// [`ReportError::Unwritable`].
pub fn make_folder(folder: &Path) -> Result<(), ReportError> {
    let probe = folder.join(".tripivot");
    fs::create_dir_all(folder)
        .and_then(|()| fs::write(&probe, []))
        .and_then(|()| fs::remove_file(&probe))
        .map_err(unwritable(folder))
}

/// Makes `folder` as [`make_folder`] does, to hold `files`. It may be there already and hold some of them, which will be
/// overwritten, and hidden files, but no others.
///
/// # Errors
/// [`ReportError::NotOurs`], [`ReportError::Unwritable`].
pub fn claim_folder(folder: &Path, files: &[&str]) -> Result<(), ReportError> {
    // What cannot be listed is not there, or cannot be written either.
    for entry in fs::read_dir(folder).into_iter().flatten() {
        let name = entry.map_err(unwritable(folder))?.file_name();
        let file = name.to_string_lossy().into_owned();
        if !file.starts_with('.') && !files.contains(&file.as_str()) {
            return Err(ReportError::NotOurs {
                folder: folder.to_owned(),
                file,
            });
        }
    }
    make_folder(folder)
}

/// Writes one file.
///
/// # Errors
/// [`ReportError::Unwritable`].
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), ReportError> {
    write_whole(path, bytes).map_err(unwritable(path))
}

/// Renders an SVG document of ours and writes it as a PNG file.
///
/// # Errors
/// [`ReportError`].
pub fn write_png(path: &Path, svg: &str) -> Result<(), ReportError> {
    let bytes = png::render(svg).map_err(|reason| ReportError::Render {
        path: path.to_owned(),
        reason,
    })?;
    write_file(path, &bytes)
}

/// What to make of an error of the system at `path`.
pub fn unwritable(path: &Path) -> impl Fn(io::Error) -> ReportError + '_ {
    |source| ReportError::Unwritable {
        path: path.to_owned(),
        source,
    }
}

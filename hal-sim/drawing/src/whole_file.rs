//! Files that are written whole or not at all: beside their place first, and then renamed. Nothing that is interrupted, and no full
//! disk, harms the file that was there.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

/// A file to be written, which can be written as far as that can be known beforehand.
#[derive(Debug)]
pub struct WholeFile {
    file: File,
    /// Where it is written, and where it is to be; `None` for a device or a pipe, which is written at once.
    places: Option<(PathBuf, PathBuf)>,
}

impl WholeFile {
    /// Makes it beside its place; what is there stays as it is until [`finish`](Self::finish).
    ///
    /// # Errors
    /// Those of the system: the folder is not there, or takes no file.
    pub fn create(path: &Path) -> io::Result<Self> {
        // Through a link, which stays one.
        let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        if fs::metadata(&path).is_ok_and(|there| !there.is_file()) {
            let file = OpenOptions::new().write(true).open(&path)?;
            return Ok(Self { file, places: None });
        }
        let name = path.file_name().ok_or(io::ErrorKind::InvalidInput)?;
        let mut beside = OsString::from(".");
        beside.push(name);
        beside.push(format!(".{}.new", std::process::id()));
        let beside = path.with_file_name(beside);
        Ok(Self {
            file: File::create(&beside)?,
            places: Some((beside, path)),
        })
    }

    /// Writes all of it, and puts it in its place.
    ///
    /// # Errors
    /// Those of the system; what was there is there still.
    pub fn finish(mut self, bytes: &[u8]) -> io::Result<()> {
        self.file.write_all(bytes)?;
        if let Some((beside, path)) = self.places.take() {
            let renamed = self
                .file
                .sync_all()
                .and_then(|()| fs::rename(&beside, path));
            if renamed.is_err() {
                let _ = fs::remove_file(&beside);
            }
            renamed?;
        }
        Ok(())
    }
}

impl Drop for WholeFile {
    fn drop(&mut self) {
        if let Some((beside, _)) = self.places.take() {
            // What is half made is in nobody's way.
            let _ = fs::remove_file(beside);
        }
    }
}

/// Writes a file whole or not at all.
///
/// # Errors
/// Those of the system; what was there is there still.
pub fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    WholeFile::create(path)?.finish(bytes)
}

/// Reads a text of at most so many bytes.
///
/// # Errors
/// Those of the system; a file that is larger, or no text.
pub fn read_text(path: &Path, most: u64) -> io::Result<String> {
    let mut text = String::new();
    File::open(path)?.take(most + 1).read_to_string(&mut text)?;
    if text.len() as u64 > most {
        return Err(io::Error::other(format!(
            "more than {most} bytes: not such a file"
        )));
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("whole-{name}-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    fn names(folder: &Path) -> Vec<OsString> {
        fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name())
            .collect()
    }

    #[test]
    fn what_is_not_finished_harms_nothing_and_leaves_nothing() {
        let folder = folder("drop");
        let path = folder.join("a");
        fs::write(&path, "old").unwrap();
        let mut half = WholeFile::create(&path).unwrap();
        half.file.write_all(b"ne").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"old");
        drop(half);
        assert_eq!(
            (names(&folder), fs::read(&path).unwrap()),
            (vec!["a".into()], b"old".to_vec())
        );
        write_whole(&path, b"new").unwrap();
        assert_eq!(
            (names(&folder), fs::read(&path).unwrap()),
            (vec!["a".into()], b"new".to_vec())
        );
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_folder_that_is_not_there_is_found_out_first() {
        assert!(WholeFile::create(Path::new("/nowhere/at/all")).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_and_a_device_is_written() {
        let folder = folder("link");
        let (path, link) = (folder.join("a"), folder.join("b"));
        fs::write(&path, "old").unwrap();
        std::os::unix::fs::symlink(&path, &link).unwrap();
        write_whole(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&path).unwrap(), b"new");
        write_whole(Path::new("/dev/null"), b"new").unwrap();
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn a_text_has_an_end() {
        let endless = read_text(Path::new("/dev/zero"), 1_000)
            .unwrap_err()
            .to_string();
        assert!(endless.contains("more than 1000 bytes"), "{endless}");
    }
}

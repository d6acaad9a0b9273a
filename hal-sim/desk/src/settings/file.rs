//! How settings are written down, to be read, compared and edited:
//!
//! ```text
//! # Settings of (c)2026 Tripivot, XYT-1 (C-887 compatible), SIM, 0.1.0
//! 0x54500100 = 200    # speed of the platform centre, mm/s, 0.2 to 2000
//!
//! macro scan
//!     MOV X 5
//!     WAC ONT? X = 1
//! end
//! ```

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use drawing::{read_text, write_whole};
use firmware::gcs::LINE_BYTES;

use crate::record::RecordError;

/// Longest file: many times what a controller keeps.
const LONGEST_BYTES: u64 = 1 << 20;

/// Settings of a controller.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Settings {
    /// Whose they are, as `*IDN?` says.
    pub of: String,
    /// Parameters.
    pub parameters: Vec<Parameter>,
    /// Macros.
    pub macros: Vec<Macro>,
}

/// A parameter and its value, as the controller writes them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// Its number.
    pub id: String,
    /// Its value.
    pub value: String,
    /// What it is, its unit and its range; for the reader.
    pub text: String,
}

/// A macro.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Macro {
    /// Its name.
    pub name: String,
    /// Its lines.
    pub lines: Vec<String>,
}

/// Why settings cannot be written down or brought back.
#[derive(Debug, thiserror::Error)]
pub enum SettingsError {
    /// The controller is not there, or refuses.
    #[error(transparent)]
    Controller(#[from] RecordError),
    /// The controller is not there any more, or refuses, and not all of what it was given could be taken back.
    #[error(
        "{0}; what had been set before that could not be taken back: RPA brings back what is kept"
    )]
    NotTakenBack(RecordError),
    /// The file cannot be read or written.
    #[error("{}: {error}", path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// What the system says.
        error: io::Error,
    },
    /// The file does not say what it should.
    #[error("{}:{number}: {reason}", path.display())]
    Line {
        /// Which.
        path: PathBuf,
        /// The line, from 1.
        number: usize,
        /// What is wrong with it.
        reason: &'static str,
    },
}

impl SettingsError {
    /// Whether the controller was there, and it went wrong all the same.
    #[must_use]
    pub const fn is_failure(&self) -> bool {
        match self {
            Self::Controller(error) | Self::NotTakenBack(error) => error.is_failure(),
            _ => false,
        }
    }
}

impl Settings {
    /// Writes them into a file, whole or not at all.
    ///
    /// # Errors
    /// [`SettingsError::File`]
    pub fn write(&self, path: &Path) -> Result<(), SettingsError> {
        write_whole(path, self.to_string().as_bytes()).map_err(|error| SettingsError::File {
            path: path.to_owned(),
            error,
        })
    }

    /// Reads them from a file.
    ///
    /// # Errors
    /// [`SettingsError::File`] and [`SettingsError::Line`].
    pub fn read(path: &Path) -> Result<Self, SettingsError> {
        let text = read_text(path, LONGEST_BYTES).map_err(|error| SettingsError::File {
            path: path.to_owned(),
            error,
        })?;
        Self::from_text(&text).map_err(|(number, reason)| SettingsError::Line {
            path: path.to_owned(),
            number,
            reason,
        })
    }

    /// Reads them from a text; an error has its line, from 1.
    fn from_text(text: &str) -> Result<Self, (usize, &'static str)> {
        let mut settings = Self::default();
        let mut recording: Option<Macro> = None;
        for (number, line) in (1..).zip(text.lines()) {
            let line = line.trim();
            let is_comment = recording.is_none() && line.starts_with('#');
            let said = if recording.is_some() {
                line
            } else {
                line.split('#').next().unwrap_or("")
            };
            if !is_comment && !said.bytes().all(|byte| (b' '..=b'~').contains(&byte)) {
                return Err((number, "a character that is not printable ASCII"));
            }
            if recording.is_some() && line.len() > LINE_BYTES {
                return Err((number, "the line is too long for a controller"));
            }
            if let Some(mut under_way) = recording.take() {
                if line == "end" {
                    settings.macros.push(under_way);
                } else {
                    under_way.lines.push(line.to_owned());
                    recording = Some(under_way);
                }
            } else if let Some(name) = line.strip_prefix("macro ") {
                recording = Some(Macro {
                    name: name.trim().to_owned(),
                    lines: Vec::new(),
                });
            } else if !line.is_empty() && !line.starts_with('#') {
                let parameter = parameter(line).ok_or((
                    number,
                    "neither a parameter, such as 0x54500100 = 200, nor a macro",
                ))?;
                settings.parameters.push(parameter);
            }
        }
        match recording {
            Some(_) => Err((text.lines().count(), "the macro has no end")),
            None => Ok(settings),
        }
    }
}

fn parameter(line: &str) -> Option<Parameter> {
    let (setting, text) = line.split_once('#').unwrap_or((line, ""));
    let (id, value) = setting.split_once('=')?;
    let (id, value) = (id.trim(), value.trim());
    let digits = id.strip_prefix("0x")?;
    u32::from_str_radix(digits, 16).ok()?;
    value.parse::<f64>().ok()?;
    Some(Parameter {
        id: id.to_owned(),
        value: value.to_owned(),
        text: text.trim().to_owned(),
    })
}

impl fmt::Display for Settings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "# Settings of {}", self.of)?;
        for Parameter { id, value, text } in &self.parameters {
            let setting = format!("{id} = {value}");
            writeln!(f, "{setting:<34} # {text}")?;
        }
        for Macro { name, lines } in &self.macros {
            writeln!(f, "\nmacro {name}")?;
            for line in lines {
                writeln!(f, "    {line}")?;
            }
            writeln!(f, "end")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        let settings = Settings {
            of: String::new(),
            parameters: vec![Parameter {
                id: "0x54500100".to_owned(),
                value: "1e-7".to_owned(),
                text: "speed, mm/s".to_owned(),
            }],
            macros: vec![Macro {
                name: "scan".to_owned(),
                lines: vec!["VAR A 1 # 2".to_owned(), "macro".to_owned()],
            }],
        };
        assert_eq!(Settings::from_text(&settings.to_string()), Ok(settings));
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        for (text, line) in [
            ("0x1 = 2\n\nspeed = 3\n", 3),
            ("0x1 = fast\n", 1),
            ("# a\nmacro x\nMOV X 1\n", 3),
        ] {
            assert_eq!(Settings::from_text(text).unwrap_err().0, line, "{text}");
        }
    }
}

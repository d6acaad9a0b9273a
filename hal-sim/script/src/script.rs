//! Scripts: files of GCS lines, checked as a whole before anything moves.

use std::fmt;
use std::path::{Path, PathBuf};

use drawing::read_text;
use firmware::gcs::{ErrorCode, parse};

use crate::disturbance::{self, Disturbance};

/// Longest script.
const LONGEST_BYTES: u64 = 16 << 20;

/// A line to be sent, or a disturbance.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Its number in the file, from 1.
    pub number: usize,
    /// Its text, without comment and surrounding space.
    pub text: String,
    /// What it does to a simulated stage in place of being sent.
    pub disturbance: Option<Disturbance>,
}

/// A checked script.
#[derive(Clone, Debug, PartialEq)]
pub struct Script {
    /// What it is called, in headings and errors.
    pub name: String,
    /// Its lines, empty ones and comments left out.
    pub lines: Vec<Line>,
}

/// Why a script is not run.
#[derive(Debug)]
pub enum ScriptError {
    /// The file can not be read.
    Unreadable {
        /// Which.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// A line is no command.
    Line {
        /// File and line.
        name: String,
        /// From 1.
        line: usize,
        /// From 1.
        column: usize,
        /// What was expected there.
        expected: &'static str,
        /// The error number that a controller would answer; none for a disturbance.
        code: Option<ErrorCode>,
    },
}

impl fmt::Display for ScriptError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable { path, source } => {
                write!(f, "cannot read {}: {source}", path.display())
            }
            Self::Line {
                name,
                line,
                column,
                expected,
                code,
            } => {
                write!(f, "{name}:{line}:{column}: expected {expected}")?;
                match code {
                    Some(code) => write!(f, " (GCS error {})", code.number()),
                    None => Ok(()),
                }
            }
        }
    }
}

impl std::error::Error for ScriptError {}

impl Script {
    /// Its first line that is a disturbance, which no controller can be sent.
    #[must_use]
    pub fn first_disturbance(&self) -> Option<&Line> {
        (self.lines.iter()).find(|line| line.disturbance.is_some())
    }

    /// The built-in demonstration.
    ///
    /// # Errors
    /// None in practice: a test parses it.
    pub fn demonstration() -> Result<Self, ScriptError> {
        Self::parse(
            "demonstration",
            include_str!("../../scripts/demonstration.gcs"),
        )
    }

    /// Reads and checks a file.
    ///
    /// # Errors
    /// The file can not be read, or the first line that is no command.
    pub fn read(path: &Path) -> Result<Self, ScriptError> {
        let text = read_text(path, LONGEST_BYTES).map_err(|source| ScriptError::Unreadable {
            path: path.to_owned(),
            source,
        })?;
        Self::parse(&path.display().to_string(), &text)
    }

    /// Checks a text. `# ` at the start of a line is a comment; elsewhere `#` belongs to commands like `#5`. A line that begins with
    /// `!` is a [`Disturbance`].
    ///
    /// # Errors
    /// The first line that is no command.
    pub fn parse(name: &str, text: &str) -> Result<Self, ScriptError> {
        let mut lines = Vec::new();
        for (index, raw) in text.lines().enumerate() {
            let text = raw.trim();
            if text.is_empty() || text == "#" || text.starts_with("# ") {
                continue;
            }
            let number = index + 1;
            let disturbance = check(text).map_err(|error| ScriptError::Line {
                name: name.to_owned(),
                line: number,
                column: raw.len() - raw.trim_start().len() + error.column,
                expected: error.expected,
                code: error.code,
            })?;
            lines.push(Line {
                number,
                text: text.to_owned(),
                disturbance,
            });
        }
        Ok(Self {
            name: name.to_owned(),
            lines,
        })
    }
}

/// What `ERR?` says after a command that stops, on purpose.
const STOPPED: u16 = 10;
/// Commands that stop.
const STOPS: [&str; 3] = ["STP", "HLT", "#24"];
/// Queries that do not end in `?`.
const ASKING_BYTES: [&str; 2] = ["#5", "#7"];

impl Line {
    /// The command, in capitals.
    #[must_use]
    pub fn word(&self) -> String {
        let word = self.text.split_whitespace().next().unwrap_or_default();
        word.to_ascii_uppercase()
    }

    /// Whether it is answered.
    #[must_use]
    pub fn asks(&self) -> bool {
        let word = self.word();
        word.ends_with('?') || ASKING_BYTES.contains(&&*word)
    }

    /// Whether this error number, asked for afterwards, means that it was carried out.
    #[must_use]
    pub fn is_done_with(&self, error: u16) -> bool {
        error == 0 || (error == STOPPED && STOPS.contains(&&*self.word()))
    }

    /// The byte that a line like `#5` stands for.
    #[must_use]
    pub fn single_byte(&self) -> Option<u8> {
        single_byte(&self.text)
    }
}

/// Commands that are a single byte on the wire, in a script `#` and the byte's number.
const SINGLE_BYTES: [u8; 3] = [5, 7, 24];

fn single_byte(text: &str) -> Option<u8> {
    let byte = text.strip_prefix('#')?.parse().ok()?;
    SINGLE_BYTES.contains(&byte).then_some(byte)
}

/// What is wrong with a line.
struct LineError {
    /// From 1.
    column: usize,
    expected: &'static str,
    code: Option<ErrorCode>,
}

fn check(text: &str) -> Result<Option<Disturbance>, LineError> {
    if text.starts_with(disturbance::MARK) {
        return match disturbance::parse(text) {
            Ok(disturbance) => Ok(Some(disturbance)),
            Err(error) => Err(LineError {
                column: error.offset + 1,
                expected: error.expected,
                code: None,
            }),
        };
    }
    if single_byte(text).is_some() {
        return Ok(None);
    }
    match parse(text.as_bytes()) {
        Ok(_) => Ok(None),
        Err(error) => Err(LineError {
            column: error.column,
            expected: error.expected,
            code: Some(error.code),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_demonstration_is_a_script() {
        assert!(Script::demonstration().unwrap().lines.len() > 50);
    }

    #[test]
    fn a_disturbance_is_a_line_that_a_stage_is_not_sent() {
        let script = Script::parse("push", "FRF\n! PUSH X 5 N 20 MS\n").unwrap();
        assert!(script.lines[0].disturbance.is_none() && script.lines[1].disturbance.is_some());
        let error = Script::parse("push", "FRF\n  ! PUSH X 5 KG 20 MS\n").unwrap_err();
        assert_eq!(error.to_string(), "push:2:14: expected N");
    }

    #[test]
    fn a_bad_line_is_named_with_line_and_column() {
        let error = Script::parse("tour.gcs", "FRF\n\n# a comment\n  MOV X 1o\n").unwrap_err();
        let ScriptError::Line { line, column, .. } = &error else {
            panic!("{error}");
        };
        assert_eq!((*line, *column), (4, 10), "{error}");
        assert!(
            error.to_string().starts_with("tour.gcs:4:10: expected "),
            "{error}"
        );
    }
}

//! The figures that the repository keeps, and whether parts have grown since.
//!
//! A table of numbers, one row a part. Parts that only stand beside, and those that check the counter, are not in it. Other
//! compilers make other code: against figures of another one a part may be larger by more.

use super::part::Part;
use super::size::Sizes;
use std::fmt;
use std::path::{Path, PathBuf};

/// Growth that is forgiven with the compiler of the figures, and with another one.
const SAME_COMPILER: f64 = 0.03;
const OTHER_COMPILER: f64 = 0.15;
/// A count is exact to so much.
const EXACT_TO: f64 = 2.0;

const COLUMNS: [&str; 4] = ["part", "unit", "mean", "worst"];
const COMPILER: &str = "compiler";
const STATES: &str = "states";
const INSTRUCTIONS: &str = "instructions";
const BYTES: &str = "bytes";

/// What is kept.
#[derive(Clone, Debug, PartialEq)]
pub struct Figures {
    /// Who built the images.
    pub compiler: String,
    /// States counted.
    pub states: u32,
    /// Part, unit, mean and worst.
    pub rows: Vec<Figure>,
}

/// One row.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    part: String,
    unit: &'static str,
    mean: f64,
    worst: f64,
}

/// The figures can not be had.
#[derive(Debug, thiserror::Error)]
pub enum FiguresError {
    /// The file can not be read or written.
    #[error("{}: {error}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why not.
        error: csv::Error,
    },
    /// A row is none.
    #[error("{}: row {row} is not part, unit, mean and worst", path.display())]
    Row {
        /// The file.
        path: PathBuf,
        /// Counted from 1.
        row: usize,
    },
}

/// What the figures do not agree with.
#[derive(Clone, Debug, PartialEq)]
pub enum Growth {
    /// A part has grown.
    Grown {
        /// Its name.
        part: String,
        /// Mean or worst, and its unit.
        what: String,
        /// Then and now.
        from: f64,
        /// Now.
        to: f64,
    },
    /// A part is not in the file.
    New(String),
    /// A part of the file is counted no more.
    Gone(String),
}

impl Figures {
    /// The figures of a run.
    pub fn new(states: u32, parts: &[Part], sizes: &Sizes) -> Self {
        let own =
            |part: &&Part| !part.name.starts_with("known") && !part.name.starts_with("beside");
        let counts = parts.iter().filter(own).map(|part| Figure {
            part: part.name.clone(),
            unit: INSTRUCTIONS,
            mean: (part.mean * 10.0).round() / 10.0,
            worst: f64::from(part.worst),
        });
        let bytes = [
            ("stage: code of the motion generator", sizes.generator()),
            ("stage: flash", sizes.total.flash),
            ("stage: RAM without stack", sizes.total.ram),
        ]
        .map(|(name, bytes)| Figure {
            part: name.to_owned(),
            unit: BYTES,
            mean: bytes as f64,
            worst: bytes as f64,
        });
        Self {
            compiler: sizes.compiler.clone(),
            states,
            rows: counts.chain(bytes).collect(),
        }
    }

    /// Reads a file.
    ///
    /// # Errors
    /// [`FiguresError`].
    pub fn read(path: &Path) -> Result<Self, FiguresError> {
        let file = |error| FiguresError::File {
            path: path.to_owned(),
            error,
        };
        let mut figures = Self {
            compiler: String::new(),
            states: 0,
            rows: Vec::new(),
        };
        let mut reader = csv::Reader::from_path(path).map_err(file)?;
        for (row, record) in reader.records().enumerate() {
            let record = record.map_err(file)?;
            figures.take(&record).ok_or_else(|| FiguresError::Row {
                path: path.to_owned(),
                row: row + 1,
            })?;
        }
        Ok(figures)
    }

    fn take(&mut self, record: &csv::StringRecord) -> Option<()> {
        let mut fields = record.iter();
        let mut next = || fields.next();
        let (part, unit, mean, worst) = (next()?, next()?, next()?, next()?);
        let unit = match unit {
            COMPILER => {
                part.clone_into(&mut self.compiler);
                return Some(());
            }
            STATES => {
                self.states = mean.parse().ok()?;
                return Some(());
            }
            INSTRUCTIONS => INSTRUCTIONS,
            BYTES => BYTES,
            _ => return None,
        };
        self.rows.push(Figure {
            part: part.to_owned(),
            unit,
            mean: mean.parse().ok()?,
            worst: worst.parse().ok()?,
        });
        Some(())
    }

    /// Writes a file.
    ///
    /// # Errors
    /// [`FiguresError::File`].
    pub fn write(&self, path: &Path) -> Result<(), FiguresError> {
        self.rows_to(path).map_err(|error| FiguresError::File {
            path: path.to_owned(),
            error,
        })
    }

    fn rows_to(&self, path: &Path) -> Result<(), csv::Error> {
        let mut writer = csv::Writer::from_path(path)?;
        writer.write_record(COLUMNS)?;
        writer.write_record([&self.compiler, COMPILER, "", ""])?;
        writer.write_record(["random states", STATES, &self.states.to_string(), ""])?;
        for row in &self.rows {
            let numbers = [row.mean, row.worst].map(|number| number.to_string());
            writer.write_record([&row.part, row.unit, &numbers[0], &numbers[1]])?;
        }
        Ok(writer.flush()?)
    }

    /// What has grown from these figures to `now`, by more than a compiler's whim.
    pub fn growth(&self, now: &Self) -> Vec<Growth> {
        let forgiven = if self.compiler == now.compiler {
            SAME_COMPILER
        } else {
            OTHER_COMPILER
        };
        let mut growth = Vec::new();
        for new in &now.rows {
            let Some(old) = self.rows.iter().find(|row| row.part == new.part) else {
                growth.push(Growth::New(new.part.clone()));
                continue;
            };
            // Of bytes there is but one number.
            let mean = (new.unit == INSTRUCTIONS).then_some(("mean", old.mean, new.mean));
            let worst = ("worst", old.worst, new.worst);
            for (what, from, to) in mean.into_iter().chain([worst]) {
                if to > from * (1.0 + forgiven) + EXACT_TO {
                    growth.push(Growth::Grown {
                        part: new.part.clone(),
                        what: format!("{what}, {}", new.unit),
                        from,
                        to,
                    });
                }
            }
        }
        let gone = (self.rows.iter()).filter(|old| now.rows.iter().all(|new| new.part != old.part));
        growth.extend(gone.map(|old| Growth::Gone(old.part.clone())));
        growth
    }
}

impl fmt::Display for Growth {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Grown {
                part,
                what,
                from,
                to,
            } => {
                let percent = 100.0 * (to / from - 1.0);
                write!(f, "{part}: {from} to {to} ({what}), {percent:+.1} %")
            }
            Self::New(part) => write!(f, "{part}: not in the file"),
            Self::Gone(part) => write!(f, "{part}: in the file, but counted no more"),
        }
    }
}

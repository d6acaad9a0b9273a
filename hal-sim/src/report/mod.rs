//! What a run leaves behind: statistics, a summary for the terminal, a trace as CSV, a picture as SVG and PNG, and a
//! document in HTML that plays it back.
//!
//! A run loop calls [`Trace::record`] every tick, collects its [`Move`]s, and puts both into a [`Run`], which prints
//! ([`Run::summary`]) and writes ([`Run::write`]) itself.

mod chart;
mod colour;
mod contour;
mod csv;
mod document;
mod envelope;
mod mechanism;
mod motion;
mod path;
mod picture;
mod png;
mod progress;
mod record;
mod sample;
mod scale;
mod statistics;
mod summary;
mod svg;
mod trace;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use firmware::motion::Limits;
use kinematics::Geometry;

pub use contour::{ContourMap, contour_map};
pub use progress::Progress;
pub use record::Record;
pub use sample::{MotionSample, Move, Sample};
pub use statistics::{Spread, Statistics};
pub use summary::Summary;
pub use trace::{DEFAULT_EVERY, Trace};

/// A finished run.
#[derive(Clone, Debug)]
pub struct Run {
    /// What was run, for headings: "demonstration", or the script's file name.
    pub name: String,
    /// The stage it ran on.
    pub geometry: Geometry,
    /// Its limits of motion.
    pub limits: Limits,
    /// What was recorded.
    pub trace: Trace,
    /// The moves in the order of time.
    pub moves: Vec<Move>,
    /// Wall-clock time of the simulation, s.
    pub wall_s: f64,
}

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
    /// The picture could not be made into pixels.
    #[error("cannot render {}: {reason}", path.display())]
    Render {
        /// Which picture.
        path: PathBuf,
        /// What the renderer says.
        reason: String,
    },
}

impl Run {
    /// The summary for the terminal.
    pub fn summary(&self) -> Summary<'_> {
        Summary::new(self)
    }

    /// The picture as an SVG document.
    pub fn picture(&self) -> String {
        picture::draw(self)
    }

    /// The picture of its setpoints' rates beside their limits, as an SVG document.
    pub fn motion_picture(&self) -> String {
        motion::draw(self)
    }

    /// The document that shows it in a browser, without a network.
    pub fn document(&self) -> String {
        document::write(self)
    }

    /// Writes `trace.csv`, `moves.csv`, `picture` and `motion` as SVG and PNG, and `report.html` into `folder`, which is made
    /// if it is not there.
    ///
    /// # Errors
    /// [`ReportError`] names the file that could not be written.
    pub fn write(&self, folder: &Path) -> Result<(), ReportError> {
        make_folder(folder)?;
        csv::write_trace(&folder.join("trace.csv"), &self.trace)?;
        csv::write_moves(&folder.join("moves.csv"), &self.moves)?;
        for (name, picture) in [
            ("picture", self.picture()),
            ("motion", self.motion_picture()),
        ] {
            write_file(&folder.join(format!("{name}.svg")), picture.as_bytes())?;
            write_png(&folder.join(format!("{name}.png")), &picture)?;
        }
        write_file(&folder.join("report.html"), self.document().as_bytes())
    }
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

/// Writes one file.
///
/// # Errors
/// [`ReportError::Unwritable`].
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), ReportError> {
    fs::write(path, bytes).map_err(unwritable(path))
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

fn unwritable(path: &Path) -> impl Fn(io::Error) -> ReportError + '_ {
    |source| ReportError::Unwritable {
        path: path.to_owned(),
        source,
    }
}

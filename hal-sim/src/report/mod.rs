//! What a run leaves behind: statistics, a summary for the terminal, a trace as CSV, a picture as SVG and PNG, and a
//! document in HTML that plays it back.
//!
//! A run loop calls [`Trace::record`] every tick, collects its [`Move`]s, and puts both into a [`Run`], which prints
//! ([`Run::summary`]) and writes ([`Run::write`]) itself.

mod contour;
mod csv;
mod document;
mod mechanism;
mod motion;
mod path;
mod picture;
mod sample;
mod statistics;
mod summary;
mod trace;

use std::path::Path;

use drawing::{ReportError, make_folder, write_file, write_png};
use firmware::motion::Limits;
use kinematics::Geometry;

pub use contour::{ContourMap, contour_map};
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

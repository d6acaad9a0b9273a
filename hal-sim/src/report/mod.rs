//! What a run leaves behind: statistics, a summary for the terminal, a trace as CSV, a picture as SVG and PNG, and a
//! document in HTML that plays it back.
//!
//! A run loop calls [`Trace::record`] every tick, collects its [`Move`]s, and puts both into a [`Run`], which prints
//! ([`Run::summary`]) and writes ([`Run::write`]) itself.
//!
//! | file | idea |
//! |---|---|
//! | `sample` | what a run records: a sample a tick, an entry a move |
//! | `trace` | every tick goes in; statistics, plots and rows come out |
//! | `statistics`, `facts` | what a run amounts to; the same for programs |
//! | `conditions` | what a run was made under |
//! | `summary`, `csv` | printed; written as tables |
//! | `picture`, `motion` | pictures of a run: its path and following; its setpoints |
//! | `path`, `mechanism` | the way of the centre; views of the plane |
//! | `document` | the run as one HTML document |
//! | `contour` | a quantity over the disk |

mod conditions;
mod contour;
mod csv;
mod document;
mod facts;
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
use serde::Serialize;

pub use conditions::Conditions;
pub use contour::{ContourMap, contour_map};
pub use facts::{AtRest, Facts, FollowingError, Leg, PeakRms, PoseError};
pub use sample::{MotionSample, Move, Sample};
pub use statistics::{PoseErrors, PoseSpread, Spread, Statistics};
pub use summary::Summary;
pub use trace::{DEFAULT_EVERY, Trace};

/// The files of a run. What it was made under stands in `conditions.json`, in the report and in the pictures: the tables
/// hold nothing but headings and numbers, which every program can read.
pub const FILES: [&str; 8] = [
    "trace.csv",
    "moves.csv",
    "picture.svg",
    "picture.png",
    "motion.svg",
    "motion.png",
    "report.html",
    "conditions.json",
];

/// A stage that has not settled so long after its setpoint's arrival does not settle, s: the reference stage needs a fifth of that,
/// half of it with all the payload that it may carry.
pub const SETTLING_S: f64 = 0.1;

/// What `conditions.json` holds.
#[derive(Serialize)]
struct NamedConditions<'a> {
    run: &'a str,
    #[serde(flatten)]
    conditions: &'a Conditions,
}

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
    /// What it was made under.
    pub conditions: Conditions,
    /// Wall-clock time of the simulation, s.
    pub wall_s: f64,
}

impl Run {
    /// The summary for the terminal.
    pub fn summary(&self) -> Summary<'_> {
        Summary::new(self)
    }

    /// What the summary says, to be serialised.
    pub fn facts(&self) -> Facts<'_> {
        facts::facts(self)
    }

    /// How many moves never settled.
    pub fn never_settled(&self) -> usize {
        (0..self.moves.len())
            .filter(|&index| self.never_settles(index))
            .count()
    }

    /// Whether the stage had not settled after this move when the next began or the run ended, though it had been given
    /// [`SETTLING_S`] or more: whoever sends the next line at once has not waited for it.
    pub(crate) fn never_settles(&self, index: usize) -> bool {
        let one = &self.moves[index];
        let end_s = self.trace.statistics().end_s;
        let until_s = self.moves.get(index + 1).map_or(end_s, |next| next.start_s);
        one.settled_s.is_none() && until_s - one.profile_end_s >= SETTLING_S
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

    /// Writes all [`FILES`] into `folder`, which is made if it is not there.
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
        write_file(&folder.join("report.html"), self.document().as_bytes())?;
        let conditions = NamedConditions {
            run: &self.name,
            conditions: &self.conditions,
        };
        // A structure of texts and numbers can always be serialised.
        let text = serde_json::to_string_pretty(&conditions).unwrap_or_default() + "\n";
        write_file(&folder.join("conditions.json"), text.as_bytes())
    }
}

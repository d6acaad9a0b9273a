//! Options of what only computes.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::super::number::coordinate;

/// One pose on the command line.
#[derive(Args, Clone, Debug)]
#[command(allow_negative_numbers = true)]
pub(in super::super) struct PoseArguments {
    /// Centre along x, mm.
    #[arg(value_parser = coordinate)]
    pub(in super::super) x: f64,
    /// Centre along y, mm.
    #[arg(value_parser = coordinate)]
    pub(in super::super) y: f64,
    /// Orientation, deg, any number of turns.
    #[arg(value_parser = coordinate)]
    pub(in super::super) theta: f64,
    /// Tell the result as one JSON document on standard output.
    ///
    /// Fields: x_mm, y_mm, theta_deg; reachable; reason (null if reachable); margins (null outside the track): disk_mm,
    /// guide_start_mm, guide_end_mm, separation_deg; separation_deg, the smallest; dexterity.
    #[arg(long)]
    pub(in super::super) json: bool,
}

/// The machine as it was built.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct BuiltMachine {
    /// What the machine is off the drawing: the angles are then those that its encoders read.
    ///
    /// What `tripivot calibrate fit` writes, or the JSON object of the published poses (144 numbers in track radii and rad: z, dR, ax,
    /// ay, e, d, Ec and Es 1 to 12, rc and rs 2 to 6, S 2 to 9, each with the pivot's number 0 to 2 at its end).
    #[arg(long, value_name = "FILE")]
    pub(in super::super) calibration: Option<PathBuf>,
}

/// One pose on the command line, or many on standard input.
#[derive(Args, Clone, Debug)]
#[command(allow_negative_numbers = true)]
pub(in super::super) struct PoseRows {
    /// X and Y in mm, THETA in deg.
    #[arg(num_args = 3, value_names = ["X", "Y", "THETA"], required_unless_present = "csv", conflicts_with = "csv", value_parser = coordinate)]
    pub(in super::super) numbers: Vec<f64>,
    /// Read rows x,y,theta from standard input and write rows phi1,phi2,phi3; with a calibration m1,m2,m3.
    ///
    /// Empty rows and rows that begin with # are passed over. The first other row may be a header, which is three names that begin
    /// with a letter: the output has one too then. Everything else has to be three numbers: the first row that is not ends
    /// the command.
    #[arg(long)]
    pub(in super::super) csv: bool,
    #[command(flatten)]
    pub(in super::super) built: BuiltMachine,
}

/// Three pivots on the command line, or many rows of them on standard input.
#[derive(Args, Clone, Debug)]
#[command(allow_negative_numbers = true)]
pub(in super::super) struct PivotRows {
    /// Angles of the pivots on the track, deg; with a calibration what the encoders read.
    #[arg(num_args = 3, value_names = ["PHI1", "PHI2", "PHI3"], required_unless_present = "csv", conflicts_with = "csv", value_parser = coordinate)]
    pub(in super::super) numbers: Vec<f64>,
    /// Read rows phi1,phi2,phi3 (with a calibration m1,m2,m3) from standard input and write rows x,y,theta.
    ///
    /// Empty rows and rows that begin with # are passed over. The first other row may be a header, which is three names that begin
    /// with a letter: the output has one too then. Everything else has to be three numbers: the first row that is not ends
    /// the command.
    #[arg(long)]
    pub(in super::super) csv: bool,
    #[command(flatten)]
    pub(in super::super) built: BuiltMachine,
}

/// A contour picture.
#[derive(Args, Clone, Debug)]
#[command(allow_negative_numbers = true)]
pub(in super::super) struct Map {
    /// What to draw.
    pub(in super::super) quantity: Quantity,
    /// The picture; SVG or PNG by its ending.
    #[arg(long, value_name = "FILE")]
    pub(in super::super) out: PathBuf,
    /// Orientation of the platform, deg.
    #[arg(long, default_value_t = 0.0, value_parser = coordinate)]
    pub(in super::super) theta: f64,
}

/// What a map shows.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub(in super::super) enum Quantity {
    /// How evenly the platform moves in all directions: 1 would be isotropic.
    Dexterity,
    /// The fastest pivot's rate at the worst direction of the platform's speed.
    Rate,
    /// The smallest angle between two pivots.
    Separation,
}

//! Options of what only computes.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// One pose on the command line.
#[derive(Args, Clone, Debug)]
#[command(allow_negative_numbers = true)]
pub(in super::super) struct PoseArguments {
    /// Centre along x, mm.
    pub(in super::super) x: f64,
    /// Centre along y, mm.
    pub(in super::super) y: f64,
    /// Orientation, deg, any number of turns.
    pub(in super::super) theta: f64,
}

/// One pose on the command line, or many on standard input.
#[derive(Args, Clone, Debug)]
#[command(allow_negative_numbers = true)]
pub(in super::super) struct PoseRows {
    /// X and Y in mm, THETA in deg.
    #[arg(num_args = 3, value_names = ["X", "Y", "THETA"], required_unless_present = "csv", conflicts_with = "csv")]
    pub(in super::super) numbers: Vec<f64>,
    /// Read rows x,y,theta from standard input and write rows phi1,phi2,phi3. A line of headings may come first.
    #[arg(long)]
    pub(in super::super) csv: bool,
}

/// Three pivots on the command line, or many rows of them on standard input.
#[derive(Args, Clone, Debug)]
#[command(allow_negative_numbers = true)]
pub(in super::super) struct PivotRows {
    /// Angles of the pivots on the track, deg.
    #[arg(num_args = 3, value_names = ["PHI1", "PHI2", "PHI3"], required_unless_present = "csv", conflicts_with = "csv")]
    pub(in super::super) numbers: Vec<f64>,
    /// Read rows phi1,phi2,phi3 from standard input and write rows x,y,theta. A line of headings may come first.
    #[arg(long)]
    pub(in super::super) csv: bool,
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
    #[arg(long, default_value_t = 0.0)]
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

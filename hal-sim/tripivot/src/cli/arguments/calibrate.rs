//! Options of calibration.

use std::path::PathBuf;

use calibration::Kit;
use clap::{Args, Subcommand};
use desk::calibrate::{NOISES, POSES};

use super::super::number::{whole, within};
use super::super::stage::Machine;
use super::controller::Controller;

/// What a built machine is off its drawing.
#[derive(Subcommand, Clone, Debug)]
pub(in super::super) enum CalibrateCommand {
    /// Choose poses to measure at, and tell what will come out of it and what the instrument cannot tell, before anything moves.
    Plan(CalibratePlan),
    /// Drive a plan and read an instrument at each of its poses; taken up where it was left when the file is there.
    Measure(CalibrateMeasure),
    /// Fit the machine to what was measured, and write it as a calibration file.
    Fit(CalibrateFit),
    /// Send a calibration to the controller of the machine that it was made for: all of it, or nothing. Exit code 1 where it is refused.
    Apply(CalibrateApply),
    /// Judge the calibration in force by what an instrument sees at fresh poses, each gone to from both sides. Exit code 1 if it is worse
    /// than predicted, or worse than none.
    Verify(CalibrateVerify),
    /// All that is known of a calibration as one page: error maps before and after, what the fit leaves, predicted beside verified, its
    /// numbers with their uncertainties, what cannot be told, drift.
    Report(CalibrateReport),
    /// All of it on a simulated machine that nobody knows: it is commissioned, calibrates itself with a plate that nobody has measured, and
    /// the report shows true poses against commanded ones before and after. Takes some minutes.
    Demo(CalibrateDemo),
    /// Take the calibration that is in force out of it: the controller's geometry is the drawing's again.
    Undo(CalibratedMachine),
}

/// The machine that is calibrated.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct CalibratedMachine {
    #[command(flatten)]
    pub(in super::super) controller: Controller,
    /// A simulated machine in place of a controller that runs, which is told its drives and its load. Wires and zeros of an unknown one
    /// are in the settings that `tripivot commission` leaves: give them with --settings.
    #[command(flatten)]
    pub(in super::super) machine: Machine,
    /// Seed of the simulated noise and of how the simulated instrument is set up.
    #[arg(long, default_value_t = 1, allow_negative_numbers = true, value_parser = whole(0..=u64::MAX))]
    pub(in super::super) seed: u64,
    /// File in which the simulated controller keeps its settings and its calibration, as `tripivot commission` leaves one [default:
    /// it forgets them].
    #[arg(long, value_name = "FILE")]
    pub(in super::super) settings: Option<PathBuf>,
}

/// A measurement.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct CalibrateMeasure {
    #[command(flatten)]
    pub(in super::super) stage: CalibratedMachine,
    /// The instrument: xyt, xy, theta, camera, camera2 or balls; or ends, which is none: rings are driven against the ends of guides, one at a time,
    /// with the servo off.
    #[arg(long)]
    pub(in super::super) kit: Kit,
    #[command(flatten)]
    pub(in super::super) noise: NoiseArguments,
    /// How many poses; the first is visited again after every twenty, to see what drifts.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole(POSES))]
    pub(in super::super) poses: usize,
    /// Command that reads the instrument: it is run in a shell for each pose, gets x_mm y_mm theta_deg on standard input (for cameras
    /// mark_x_mm mark_y_mm camera_x_mm camera_y_mm besides, for balls the ball's place and the gauges') and answers x_mm y_mm theta_deg, or x_mm
    /// y_mm, or theta_deg, or of a mark or ball off_x_um off_y_um, in one line [default: the simulated instrument beside a simulated machine].
    #[arg(long, value_name = "COMMAND")]
    pub(in super::super) reader: Option<String>,
    /// What was measured, as CSV, for `tripivot calibrate fit`. Each row is kept as it is measured: the same command again goes on
    /// behind the last one.
    #[arg(long, value_name = "FILE")]
    pub(in super::super) out: PathBuf,
}

/// A calibration for a controller.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct CalibrateApply {
    /// The calibration file.
    pub(in super::super) file: PathBuf,
    /// What was measured of the machine as it is now, as `tripivot calibrate measure` leaves it: a calibration that explains it worse than
    /// what is in force is refused.
    #[arg(long, value_name = "FILE")]
    pub(in super::super) measured: PathBuf,
    /// The file of the calibration that is in force, if one is.
    #[arg(long, value_name = "FILE")]
    pub(in super::super) over: Option<PathBuf>,
    #[command(flatten)]
    pub(in super::super) stage: CalibratedMachine,
}

/// A verification.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct CalibrateVerify {
    /// The calibration file: the controller has to have it in force.
    pub(in super::super) file: PathBuf,
    #[command(flatten)]
    pub(in super::super) stage: CalibratedMachine,
    /// The instrument: xyt, xy, theta, camera, camera2 or balls [default: that of the calibration].
    #[arg(long)]
    pub(in super::super) kit: Option<Kit>,
    /// Standard deviation of one measurement of x or y [default: as in the calibration].
    #[arg(long, value_name = "LENGTH", value_parser = length_m)]
    pub(in super::super) noise: Option<f64>,
    /// Standard deviation of one measurement of theta [default: that of lengths over a base of 50 mm, or as in the calibration].
    #[arg(long, value_name = "ANGLE", value_parser = angle_rad)]
    pub(in super::super) noise_theta: Option<f64>,
    /// How many fresh poses; each is gone to twice.
    #[arg(long, value_name = "N", default_value_t = 60, allow_negative_numbers = true, value_parser = whole(POSES))]
    pub(in super::super) poses: usize,
    /// Command that reads the instrument, as for `tripivot calibrate measure`.
    #[arg(long, value_name = "COMMAND")]
    pub(in super::super) reader: Option<String>,
    /// Tell the result as one JSON document on standard output.
    ///
    /// Fields: kit, visits; xy_um and theta_urad, null where the instrument does not see it (seen, noise, of_stage, predicted: each rms;
    /// ratio, of seen over predicted with the noise in both; largest, largest_at_visit, both_sides_apart, as_drawn); as_predicted (from, to), scale (of
    /// the stage over the instrument's, taken out, where the calibration does not know it; else null), verdict; poses
    /// (commanded_mm_deg, off_um_urad, as_drawn_um_urad). `tripivot calibrate report` takes it.
    #[arg(long)]
    pub(in super::super) json: bool,
}

/// A report.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct CalibrateReport {
    /// The calibration file.
    pub(in super::super) file: PathBuf,
    /// What it was fitted to, as `tripivot calibrate measure` leaves it.
    #[arg(long, value_name = "FILE")]
    pub(in super::super) measured: PathBuf,
    /// What `tripivot calibrate verify --json` has told of it.
    #[arg(long, value_name = "FILE")]
    pub(in super::super) verified: Option<PathBuf>,
    /// The page.
    #[arg(long, value_name = "FILE", default_value = "calibration.html")]
    pub(in super::super) out: PathBuf,
}

/// A demonstration.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct CalibrateDemo {
    /// The machine, as a workshop would build it.
    #[arg(long, value_name = "SEED", default_value_t = 1, allow_negative_numbers = true, value_parser = whole(0..=u64::MAX))]
    pub(in super::super) unknown: u64,
    /// Settings of this machine's controller, as `tripivot commission --unknown SEED` leaves them [default: it is commissioned first].
    #[arg(long, value_name = "FILE")]
    pub(in super::super) settings: Option<PathBuf>,
    /// How many poses are measured; fewer would not tell the machine's scatter from the noise.
    #[arg(long, value_name = "N", default_value_t = 300, allow_negative_numbers = true, value_parser = whole(200..=3000_usize))]
    pub(in super::super) poses: usize,
    /// Folder for the report, the error maps, what was measured, the calibration and the controller's settings.
    #[arg(long, value_name = "DIR", default_value = "tripivot-calibration")]
    pub(in super::super) out: PathBuf,
}

/// The instrument's noise.
#[derive(Args, Clone, Copy, Debug)]
pub(in super::super) struct NoiseArguments {
    /// Standard deviation of one measurement of x or y, or of where a pivot stops at an end, such as 50nm or 2um.
    #[arg(long, value_name = "LENGTH", value_parser = length_m)]
    pub(in super::super) noise: f64,
    /// Standard deviation of one measurement of theta, such as 1urad [default: that of lengths over a base of 50 mm].
    #[arg(long, value_name = "ANGLE", value_parser = angle_rad)]
    pub(in super::super) noise_theta: Option<f64>,
}

/// A plan of poses.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct CalibratePlan {
    /// The instrument: xyt (x, y and theta), xy (x and y of one target), theta, camera (over a plate of unknown marks), camera2 (the
    /// same at two places), balls (two gauges across each other against three balls, at two places), ends (none: pivots are driven against the ends of their guides).
    #[arg(long)]
    pub(in super::super) kit: Kit,
    #[command(flatten)]
    pub(in super::super) noise: NoiseArguments,
    /// How many poses.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole(POSES))]
    pub(in super::super) poses: usize,
    /// Write the poses into this file, as CSV, the most telling first: x_mm, y_mm, theta_deg; for cameras the mark in the platform frame
    /// and the camera in the base frame besides (for balls ball and gauges), for ends the guide and where on it the end is.
    #[arg(long, value_name = "FILE")]
    pub(in super::super) out: Option<PathBuf>,
    /// Tell the result as one JSON document on standard output.
    ///
    /// Fields: kit, noise_nm, noise_urad, poses; expected_xy_nm, expected_worst_xy_nm, worst_pose (x_mm, y_mm, theta_deg),
    /// expected_theta_urad; yours_to_choose, not_identifiable, more_not_identifiable, held_by_tolerances, numbers.
    #[arg(long)]
    pub(in super::super) json: bool,
}

/// A fit.
#[derive(Args, Clone, Debug)]
pub(in super::super) struct CalibrateFit {
    /// What was measured, as CSV. The first row names the columns: m1_deg,m2_deg,m3_deg (readings of the encoders), then
    /// x_mm,y_mm,theta_deg or x_mm,y_mm or theta_deg or mark_x_mm,mark_y_mm,camera_x_mm,camera_y_mm,off_x_um,off_y_um
    /// or ball_x_mm,ball_y_mm,gauge_x_mm,gauge_y_mm,off_x_um,off_y_um or guide,end_mm.
    pub(in super::super) file: PathBuf,
    #[command(flatten)]
    pub(in super::super) noise: NoiseArguments,
    /// The calibration file.
    #[arg(long, value_name = "FILE")]
    pub(in super::super) out: PathBuf,
    /// What the machine is called.
    #[arg(long, value_name = "TEXT", default_value = "")]
    pub(in super::super) serial: String,
    /// Temperature at which was measured, deg C.
    #[arg(long, value_name = "C", allow_negative_numbers = true, value_parser = within(-50.0..=100.0))]
    pub(in super::super) temperature: Option<f64>,
    /// Tell the result as one JSON document on standard output.
    ///
    /// Fields: kit, visits, outliers (lines of the file), chi2, chi2_of_noise, scatter_nm, chi2_held_out, chi2_is_doubtful,
    /// expected_xy_nm, expected_worst_xy_nm, expected_theta_urad, drift (minutes, moved_nm_nm_urad, noise_nm_nm_urad; null if unknown),
    /// drift_is_significant, steps, file.
    #[arg(long)]
    pub(in super::super) json: bool,
}

fn length_m(text: &str) -> Result<f64, String> {
    let units = [("nm", 1e-9), ("um", 1e-6), ("mm", 1e-3)];
    with_unit(text, &units).ok_or_else(|| "not a length from 0.1nm to 1mm, such as 50nm".to_owned())
}

fn angle_rad(text: &str) -> Result<f64, String> {
    let units = [("nrad", 1e-9), ("urad", 1e-6), ("mrad", 1e-3)];
    with_unit(text, &units)
        .ok_or_else(|| "not an angle from 0.1nrad to 1mrad, such as 1urad".to_owned())
}

fn with_unit(text: &str, units: &[(&str, f64)]) -> Option<f64> {
    let (number, factor) =
        (units.iter()).find_map(|(unit, factor)| Some((text.strip_suffix(unit)?, factor)))?;
    let value = number.trim().parse::<f64>().ok()? * factor;
    NOISES.contains(&value).then_some(value)
}

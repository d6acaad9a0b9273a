//! The arguments, as clap reads them.

use std::path::PathBuf;

use clap::{ArgGroup, Args, Parser, Subcommand, ValueEnum, value_parser};

#[cfg(unix)]
use crate::record::Trigger;
use crate::report::DEFAULT_EVERY;

/// Tripivot: a simulated planar XY-Theta stage under its real controller.
///
/// Without a command it runs the built-in demonstration: a tour of the disk, three turns of the platform, and back.
#[derive(Parser, Debug)]
#[command(version, args_conflicts_with_subcommands = true)]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub(super) command: Option<Command>,
    #[command(flatten)]
    pub(super) simulation: Simulation,
}

#[derive(Subcommand, Debug)]
pub(super) enum Command {
    /// Run a script of GCS lines on the simulated stage.
    Run {
        /// The script.
        file: PathBuf,
        /// File that the controller keeps its settings in [default: nothing is kept].
        #[arg(long, value_name = "FILE")]
        settings: Option<PathBuf>,
        #[command(flatten)]
        simulation: Simulation,
    },
    /// Run the simulated stage in real time and let GCS clients drive it, over TCP and a pseudo-terminal.
    #[cfg(unix)]
    Serve(Serve),
    /// Watch and drive a controller that runs already, on a serial line or at a TCP address, in a browser.
    #[cfg(unix)]
    View(View),
    /// Record signals of a controller that runs already, every tick or less often: a table and a picture.
    #[cfg(unix)]
    Record(RecordRun),
    /// Write settings of a controller that runs already into a readable file, or bring them back from one.
    #[cfg(unix)]
    #[command(subcommand)]
    Settings(SettingsCommand),
    /// Run a script, or motion from a seed, on the image for the controller's chip, emulated, and compare it with the host to the bit.
    #[cfg(feature = "chip")]
    Chip(ChipRun),
    /// Let GCS clients drive the emulated chip over its serial line, one at a time, over TCP.
    #[cfg(all(feature = "chip", unix))]
    ChipServe(ChipServe),
    /// Count the instructions that parts of the library take on the emulated chip, over random states.
    #[cfg(feature = "chip")]
    Cost(CostRun),
    /// Let the control loop run on the emulated chip while the serial line is full, and tell when its ticks start.
    #[cfg(feature = "chip")]
    ChipLoad(ChipLoad),
    /// Follow one tick of a move on the emulated chip, instruction by instruction, and tell what they are spent on.
    #[cfg(feature = "chip")]
    ChipTick(ChipTick),
    /// Prove of the chip's image that its control loop cannot panic and how deep its stack gets; print what it takes of flash and
    /// RAM. Exit code 1 if the proof fails.
    #[cfg(feature = "chip")]
    ImageCheck,
    /// Break something in many short simulated runs, and see whether the controller notices. Exit code 1 if it does not.
    Faults(Faults),
    /// Pivot angles (deg) of a pose (mm, mm, deg).
    Inverse(PoseRows),
    /// Pose (mm, mm, deg) of three pivot angles (deg).
    Direct(PivotRows),
    /// Whether the stage can take a pose, and how far it is from each limit. Exit code 1 if it cannot.
    Check(PoseArguments),
    /// Draw a quantity over the disk as a contour picture.
    Map(Map),
}

/// Options of a simulation.
#[derive(Args, Clone, Debug)]
pub(super) struct Simulation {
    /// Folder for trace and picture [default: target/tripivot/<name>].
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// Write every N-th tick into the trace.
    #[arg(long, value_name = "N", default_value_t = DEFAULT_EVERY, value_parser = value_parser!(u32).range(1..))]
    pub(super) every: u32,
    #[command(flatten)]
    pub(super) stage: SimulatedStage,
    /// No progress bar.
    #[arg(long, short)]
    pub(super) quiet: bool,
}

/// The simulated stage.
#[derive(Args, Clone, Debug)]
pub(super) struct SimulatedStage {
    /// Seed of the simulated noise: the same seed gives the same trace.
    #[arg(long, default_value_t = 1)]
    pub(super) seed: u64,
    /// By how much the simulated stage departs from the controller's model of it: heavier, more friction, weaker motors.
    #[arg(long, value_name = "PERCENT", default_value_t = 20.0, allow_negative_numbers = true, value_parser = mismatch_percent)]
    pub(super) mismatch: f64,
    /// Load on the platform that the controller knows nothing of, 0 to 5 kg, 20 mm off the centre.
    #[arg(long, value_name = "KG", default_value_t = 0.0, value_parser = payload_kg)]
    pub(super) payload: f64,
    /// Imperfections of the simulated stage to switch off.
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    pub(super) without: Vec<Imperfection>,
    /// Switch on the eccentricity of the encoders: a stage that has not been calibrated.
    #[arg(long)]
    pub(super) eccentricity: bool,
}

/// The simulated stage, served.
#[cfg(unix)]
#[derive(Args, Clone, Debug)]
pub(super) struct Serve {
    /// Address and port to listen at; port 0 takes a free one.
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:50000")]
    pub(super) listen: String,
    /// Simulated seconds in a second.
    #[arg(long, value_name = "N", default_value_t = 1.0, value_parser = speed)]
    pub(super) speed: f64,
    /// A pseudo-terminal besides, in place of the controller's serial line.
    #[arg(long)]
    pub(super) pty: bool,
    /// Address and port of the page to watch and drive the stage in a browser; `off` for none [default: 127.0.0.1:8080, or a
    /// free port if that is taken].
    #[arg(long, value_name = "ADDRESS")]
    pub(super) web: Option<String>,
    /// File that the controller keeps its settings in [default: nothing is kept].
    #[arg(long, value_name = "FILE")]
    pub(super) settings: Option<PathBuf>,
    #[command(flatten)]
    pub(super) stage: SimulatedStage,
}

/// A page for a controller that runs already.
#[cfg(unix)]
#[derive(Args, Clone, Debug)]
#[command(group(ArgGroup::new("controller").required(true).args(["port", "connect"])))]
pub(super) struct View {
    /// The serial line that the controller is at, or a pseudo-terminal.
    #[arg(long, value_name = "DEVICE")]
    pub(super) port: Option<PathBuf>,
    /// Host and port that the controller is at.
    #[arg(long, value_name = "ADDRESS")]
    pub(super) connect: Option<String>,
    /// Bits a second on the serial line.
    #[arg(long, value_name = "N", default_value_t = 921_600)]
    pub(super) baud: u32,
    /// Address and port of the page [default: 127.0.0.1:8080, or a free port if that is taken].
    #[arg(long, value_name = "ADDRESS")]
    pub(super) web: Option<String>,
}

/// A record of a controller that runs already.
#[cfg(unix)]
#[derive(Args, Clone, Debug)]
pub(super) struct RecordRun {
    /// Host and port that the controller is at.
    #[arg(
        long,
        value_name = "ADDRESS",
        default_value = "127.0.0.1:50000",
        conflicts_with = "port"
    )]
    pub(super) connect: String,
    /// The serial line that the controller is at, or a pseudo-terminal.
    #[arg(long, value_name = "DEVICE")]
    pub(super) port: Option<PathBuf>,
    /// Bits a second on the serial line.
    #[arg(long, value_name = "N", default_value_t = 921_600)]
    pub(super) baud: u32,
    /// What to record, up to eight: source (X, Y, W; 1 to 3 for a pivot; 0 for the controller) and option, as HDR? lists them.
    #[arg(long, value_name = "SOURCE:OPTION", value_delimiter = ',', default_value = "X:1,X:3,Y:1,Y:3,W:1,W:3,1:73", value_parser = recorded)]
    pub(super) tables: Vec<String>,
    /// Ticks from point to point.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = value_parser!(u32).range(1..=65_536))]
    pub(super) every: u32,
    /// Points of the record [default: as the controller has it].
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..))]
    pub(super) points: Option<u32>,
    /// How many of them are from before the trigger.
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(super) before: u32,
    /// What begins it: now, move, fault, rises:TABLE:VALUE or falls:TABLE:VALUE [default: move with --send, now without].
    #[arg(long, value_name = "TRIGGER", value_parser = trigger)]
    pub(super) trigger: Option<Trigger>,
    /// A line to send once the recorder is armed, such as "MOV X 10".
    #[arg(long, value_name = "LINE")]
    pub(super) send: Option<String>,
    /// Seconds that the record may take.
    #[arg(long, value_name = "S", default_value_t = 60.0, value_parser = seconds)]
    pub(super) patience: f64,
    /// Folder for table and picture.
    #[arg(long, value_name = "DIR", default_value = "target/tripivot/record")]
    pub(super) out: PathBuf,
    /// No progress bar.
    #[arg(long, short)]
    pub(super) quiet: bool,
}

/// What to do with settings.
#[cfg(unix)]
#[derive(Subcommand, Clone, Debug)]
pub(super) enum SettingsCommand {
    /// Write all parameters that can be set, and all macros, into a file.
    Export(SettingsFile),
    /// Set the parameters of a file, record its macros, and have both kept. All must be at rest; some need the servo off.
    Import(SettingsFile),
}

/// A file of settings, and the controller.
#[cfg(unix)]
#[derive(Args, Clone, Debug)]
pub(super) struct SettingsFile {
    /// The file.
    pub(super) file: PathBuf,
    /// Host and port that the controller is at.
    #[arg(
        long,
        value_name = "ADDRESS",
        default_value = "127.0.0.1:50000",
        conflicts_with = "port"
    )]
    pub(super) connect: String,
    /// The serial line that the controller is at, or a pseudo-terminal.
    #[arg(long, value_name = "DEVICE")]
    pub(super) port: Option<PathBuf>,
    /// Bits a second on the serial line.
    #[arg(long, value_name = "N", default_value_t = 921_600)]
    pub(super) baud: u32,
}

/// A run on the emulated chip.
#[cfg(feature = "chip")]
#[derive(Args, Clone, Debug)]
pub(super) struct ChipRun {
    /// The script [default: the demonstration].
    pub(super) file: Option<PathBuf>,
    /// Instead of a script demanding motion from the seed, compared at so many ticks, with what they cost.
    #[arg(long, value_name = "N", conflicts_with_all = ["file", "out", "every"], value_parser = value_parser!(u64).range(1..))]
    pub(super) ticks: Option<u64>,
    /// Flip one bit of an encoder count on the host alone at this tick, counted from 0: the comparison has to find it, exit code 1.
    #[arg(long, value_name = "TICK", requires = "ticks")]
    pub(super) flip: Option<u64>,
    #[command(flatten)]
    pub(super) simulation: Simulation,
}

/// The emulated chip, served.
#[cfg(all(feature = "chip", unix))]
#[derive(Args, Clone, Debug)]
pub(super) struct ChipServe {
    /// Address and port to listen at; port 0 takes a free one.
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:50001")]
    pub(super) listen: String,
    #[command(flatten)]
    pub(super) stage: SimulatedStage,
}

/// Where the repository keeps the figures, for a program that is run where it was built.
#[cfg(feature = "chip")]
const FIGURES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../firmware/figures.csv");

/// Load on the emulated chip.
#[cfg(feature = "chip")]
#[derive(Args, Clone, Debug)]
pub(super) struct ChipLoad {
    /// Ticks.
    #[arg(long, value_name = "N", default_value_t = 20_000, value_parser = value_parser!(u64).range(1_000..=10_000_000))]
    pub(super) ticks: u64,
}

/// One tick on the emulated chip.
#[cfg(feature = "chip")]
#[derive(Args, Clone, Debug)]
pub(super) struct ChipTick {
    /// The tick, counted from the start; the move begins at 100.
    #[arg(long, value_name = "N", default_value_t = 600, value_parser = value_parser!(u64).range(..100_000))]
    pub(super) tick: u64,
    /// What to sum up by.
    #[arg(long, default_value = "file")]
    pub(super) by: Place,
}

/// Where an instruction is written.
#[cfg(feature = "chip")]
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub(super) enum Place {
    /// The file.
    File,
    /// The function, with its file.
    Function,
    /// The line.
    Line,
}

/// Counting on the emulated chip.
#[cfg(feature = "chip")]
#[derive(Args, Clone, Debug)]
pub(super) struct CostRun {
    /// Random states: each is a call of every part, or ten and more where calls are short [default: 300; with --check as many as
    /// the figures are of].
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=1_000_000))]
    pub(super) states: Option<u32>,
    /// Seed of the random states.
    #[arg(long, default_value_t = 1)]
    pub(super) seed: u32,
    /// Only parts with this in their name, as "motion".
    #[arg(long, value_name = "NAME", default_value = "")]
    pub(super) only: String,
    /// Compare with the figures that the repository keeps: exit code 1 when a part has grown by more than 3 %.
    #[arg(long, conflicts_with_all = ["states", "seed", "only"])]
    pub(super) check: bool,
    /// Write the figures.
    #[arg(long, conflicts_with_all = ["check", "seed", "only"])]
    pub(super) write: bool,
    /// The figures.
    #[arg(long, value_name = "FILE", default_value = FIGURES)]
    pub(super) figures: PathBuf,
    /// No progress bar.
    #[arg(long, short)]
    pub(super) quiet: bool,
}

/// A campaign of faults.
#[derive(Args, Clone, Debug)]
pub(super) struct Faults {
    /// Runs with a fault; as many are run without.
    #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = value_parser!(u32).range(1..=10_000_000))]
    pub(super) runs: u32,
    /// Seed of the campaign.
    #[arg(long, default_value_t = 1)]
    pub(super) seed: u64,
    /// Threads [default: as many as there are processors].
    #[arg(long, value_name = "N", value_parser = jobs)]
    pub(super) jobs: Option<usize>,
    /// Run the run of this seed again, alone, and tell about it.
    #[arg(long, value_name = "SEED", conflicts_with_all = ["runs", "seed", "jobs"])]
    pub(super) only: Option<u64>,
    /// Write all runs into this file, as CSV.
    #[arg(long, value_name = "FILE")]
    pub(super) out: Option<PathBuf>,
    /// No progress bar.
    #[arg(long, short)]
    pub(super) quiet: bool,
}

fn jobs(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(jobs @ 1..=1024) => Ok(jobs),
        _ => Err("not a number from 1 to 1024".to_owned()),
    }
}

/// What a simulated stage can do without.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub(super) enum Imperfection {
    /// All of them.
    All,
    /// Coulomb, static and presliding friction.
    DryFriction,
    /// Viscous friction.
    ViscousFriction,
    /// Elastic transmission.
    Compliance,
    /// Dead zone in the transmission.
    Backlash,
    /// Torque ripple of the motors.
    TorqueRipple,
    /// Encoder noise.
    EncoderNoise,
    /// Dead time of the bridges.
    DeadTime,
    /// Counts of the PWM.
    PwmQuantisation,
}

/// One pose on the command line.
#[derive(Args, Clone, Debug)]
#[command(allow_negative_numbers = true)]
pub(super) struct PoseArguments {
    /// Centre along x, mm.
    pub(super) x: f64,
    /// Centre along y, mm.
    pub(super) y: f64,
    /// Orientation, deg, any number of turns.
    pub(super) theta: f64,
}

/// One pose on the command line, or many on standard input.
#[derive(Args, Clone, Debug)]
#[command(allow_negative_numbers = true)]
pub(super) struct PoseRows {
    /// X and Y in mm, THETA in deg.
    #[arg(num_args = 3, value_names = ["X", "Y", "THETA"], required_unless_present = "csv", conflicts_with = "csv")]
    pub(super) numbers: Vec<f64>,
    /// Read rows x,y,theta from standard input and write rows phi1,phi2,phi3. A line of headings may come first.
    #[arg(long)]
    pub(super) csv: bool,
}

/// Three pivots on the command line, or many rows of them on standard input.
#[derive(Args, Clone, Debug)]
#[command(allow_negative_numbers = true)]
pub(super) struct PivotRows {
    /// Angles of the pivots on the track, deg.
    #[arg(num_args = 3, value_names = ["PHI1", "PHI2", "PHI3"], required_unless_present = "csv", conflicts_with = "csv")]
    pub(super) numbers: Vec<f64>,
    /// Read rows phi1,phi2,phi3 from standard input and write rows x,y,theta. A line of headings may come first.
    #[arg(long)]
    pub(super) csv: bool,
}

/// A contour picture.
#[derive(Args, Clone, Debug)]
#[command(allow_negative_numbers = true)]
pub(super) struct Map {
    /// What to draw.
    pub(super) quantity: Quantity,
    /// The picture; SVG or PNG by its ending.
    #[arg(long, value_name = "FILE")]
    pub(super) out: PathBuf,
    /// Orientation of the platform, deg.
    #[arg(long, default_value_t = 0.0)]
    pub(super) theta: f64,
}

/// What a map shows.
#[derive(Clone, Copy, PartialEq, Eq, Debug, ValueEnum)]
pub(super) enum Quantity {
    /// How evenly the platform moves in all directions: 1 would be isotropic.
    Dexterity,
    /// The fastest pivot's rate at the worst direction of the platform's speed.
    Rate,
    /// The smallest angle between two pivots.
    Separation,
}

/// Beyond that the simulated motors have no torque, or the platform no mass.
const MISMATCH_LIMIT_PERCENT: f64 = 80.0;

/// What the reference stage carries at most.
const PAYLOAD_LIMIT_KG: f64 = 5.0;

fn payload_kg(text: &str) -> Result<f64, String> {
    let kg: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (0.0..=PAYLOAD_LIMIT_KG).contains(&kg) {
        Ok(kg)
    } else {
        Err(format!("not between 0 and {PAYLOAD_LIMIT_KG}"))
    }
}

fn mismatch_percent(text: &str) -> Result<f64, String> {
    let percent: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if percent.abs() <= MISMATCH_LIMIT_PERCENT {
        Ok(percent)
    } else {
        Err(format!(
            "not from -{MISMATCH_LIMIT_PERCENT} to {MISMATCH_LIMIT_PERCENT}"
        ))
    }
}

/// Slowest and fastest: 20 ticks a second, and more than any machine computes.
#[cfg(unix)]
const SPEEDS: std::ops::RangeInclusive<f64> = 1e-3..=1e3;

#[cfg(unix)]
fn speed(text: &str) -> Result<f64, String> {
    let speed: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if SPEEDS.contains(&speed) {
        Ok(speed)
    } else {
        Err(format!("not from {} to {}", SPEEDS.start(), SPEEDS.end()))
    }
}

/// Source and option as the controller takes them.
#[cfg(unix)]
fn recorded(text: &str) -> Result<String, String> {
    match text.split_once(':') {
        Some((source, option)) if !source.is_empty() && option.parse::<u16>().is_ok() => {
            Ok(format!("{source} {option}"))
        }
        _ => Err("not a source and an option's number, such as X:1".to_owned()),
    }
}

#[cfg(unix)]
fn trigger(text: &str) -> Result<Trigger, String> {
    let expected = || "not now, move, fault, rises:TABLE:VALUE or falls:TABLE:VALUE".to_owned();
    let words: Vec<&str> = text.split(':').collect();
    match words[..] {
        ["now"] => Ok(Trigger::Now),
        ["move"] => Ok(Trigger::Move),
        ["fault"] => Ok(Trigger::Fault),
        [way @ ("rises" | "falls"), table, value] => Ok(Trigger::Crosses {
            table: table.parse().map_err(|_| expected())?,
            value: value.parse().map_err(|_| expected())?,
            rising: way == "rises",
        }),
        _ => Err(expected()),
    }
}

/// A day.
#[cfg(unix)]
const LONGEST_S: f64 = 86_400.0;

#[cfg(unix)]
fn seconds(text: &str) -> Result<f64, String> {
    let seconds: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (0.0..=LONGEST_S).contains(&seconds) {
        Ok(seconds)
    } else {
        Err(format!("not from 0 to {LONGEST_S}"))
    }
}

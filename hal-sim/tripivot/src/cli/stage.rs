//! The simulated stage on the command line, here and of the program that runs the chip's image.

use std::path::PathBuf;

use std::{fs, io};

use clap::Args;
use clap::builder::PossibleValuesParser;
use hal_sim::machine::devices::StageParameters;
use hal_sim::machine::file::{MachineError, from_text, to_text};
use hal_sim::machine::plant::{Imperfections, NAMED};
use hal_sim::machine::unknown;
use hal_sim::report::DEFAULT_EVERY;
use hal_sim::rig::Told;
use hal_sim::rig::run::RunOptions;

use super::number::{whole, within};

/// Before the name of a run: the folder that it goes to unless `--out` says otherwise, in the working directory.
const FOLDER: &str = "tripivot-";

/// Options of a simulation.
#[derive(Args, Clone, Debug)]
pub struct Simulation {
    /// Folder for trace, pictures and report [default: tripivot-NAME in the working directory].
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Write every N-th tick into the trace.
    #[arg(long, value_name = "N", default_value_t = DEFAULT_EVERY, allow_negative_numbers = true, value_parser = whole(1..=u32::MAX))]
    pub every: u32,
    /// What is simulated.
    #[command(flatten)]
    pub stage: SimulatedStage,
    /// No progress bar.
    #[arg(long, short)]
    pub quiet: bool,
}

/// The simulated stage.
#[derive(Args, Clone, Debug)]
pub struct SimulatedStage {
    /// Seed of the simulated noise: the same seed gives the same trace.
    #[arg(long, default_value_t = 1, allow_negative_numbers = true, value_parser = whole(0..=u64::MAX))]
    pub seed: u64,
    /// By how much the simulated stage departs from the controller's model of it: heavier, more friction, weaker motors [default: 0,
    /// and 20 with --kind].
    #[arg(long, value_name = "PERCENT", allow_negative_numbers = true, value_parser = within(-MISMATCH_LIMIT_PERCENT..=MISMATCH_LIMIT_PERCENT))]
    pub mismatch: Option<f64>,
    /// Load on the platform that the controller knows nothing of, 0 to 5 kg, 20 mm off the centre.
    #[arg(long, value_name = "KG", default_value_t = 0.0, allow_negative_numbers = true, value_parser = within(0.0..=PAYLOAD_LIMIT_KG))]
    pub payload: f64,
    /// Imperfections of the simulated stage to switch off; `all` leaves an ideal machine. The controller's settings are then those of a machine
    /// without them.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = imperfection(&["all"]))]
    pub without: Vec<String>,
    /// Imperfections to switch on that a kind machine (--kind) or a machine of one's own has not; `all` are those of the reference stage.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = imperfection(&["all"]))]
    pub with: Vec<String>,
    /// Start with a controller that keeps no settings: it knows neither zeros nor directions of the encoders, and nothing drives before
    /// it is commissioned. Without this, an empty store gets the settings that the simulated machine comes with.
    #[arg(long)]
    pub uncommissioned: bool,
    /// Tell the controller all that is true of the machine, as if it had been commissioned and calibrated without an error: wiring, zeros,
    /// drives, masses, friction, stiffness, ripple, the encoders' and the geometry's errors, and gains that its resonances bear.
    #[arg(long, conflicts_with = "uncommissioned")]
    pub told: bool,
    /// The machine itself.
    #[command(flatten)]
    pub machine: Machine,
}

/// A machine of one's own.
#[derive(Args, Clone, Debug)]
pub struct Machine {
    /// File of the machine's numbers; `tripivot machine` prints one to start from [default: the reference stage].
    #[arg(id = "machine", long = "machine", value_name = "FILE")]
    pub file: Option<PathBuf>,
    /// The reference stage as no workshop builds it: guides without friction, stiff and exact, gears and encoders without errors, an ideal
    /// supply. Its controller comes with the drawing's numbers; in a run the machine is off them by --mismatch.
    #[arg(long, conflicts_with_all = ["machine", "unknown"])]
    pub kind: bool,
    /// A machine as a workshop builds it, every number drawn by its usual size, plugs and zeros as they came: what a first start meets.
    #[arg(long, value_name = "SEED", conflicts_with = "machine", allow_negative_numbers = true, value_parser = whole(0..=u64::MAX))]
    pub unknown: Option<u64>,
    /// Set one number of the machine, as in plant.platform_mass_kg=3.5; again for more.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

impl Machine {
    /// Its numbers.
    ///
    /// # Errors
    /// [`StageError`]: the file, or what is set, is no machine.
    pub fn parameters(&self) -> Result<StageParameters, StageError> {
        let text = match (&self.file, self.unknown) {
            (Some(file), _) => {
                fs::read_to_string(file).map_err(|error| StageError::Unreadable {
                    file: file.clone(),
                    error,
                })?
            }
            (None, Some(seed)) => to_text(&unknown(seed)),
            (None, None) => {
                let mut reference = StageParameters::REFERENCE;
                reference.plant.imperfections = if self.kind {
                    Imperfections::CALIBRATED
                } else {
                    Imperfections::ALL
                };
                to_text(&reference)
            }
        };
        from_text(&text, &self.set).map_err(|error| StageError::Machine {
            origin: (self.file.as_ref())
                .map_or_else(|| "--set".into(), |file| file.display().to_string()),
            error,
        })
    }

    /// Whether one was asked for.
    #[must_use]
    pub const fn is_simulated(&self) -> bool {
        self.file.is_some() || self.unknown.is_some() || self.kind || !self.set.is_empty()
    }

    /// What to call it.
    #[must_use]
    pub fn name(&self) -> String {
        let mut name = match (&self.file, self.unknown) {
            (Some(file), _) => format!("machine of {}", file.display()),
            (None, Some(seed)) => format!("unknown machine {seed}"),
            (None, None) if self.kind => "kind reference stage".to_owned(),
            (None, None) => "reference stage".to_owned(),
        };
        for setting in &self.set {
            name += " with ";
            name += setting;
        }
        name
    }
}

/// Why there is no stage to simulate.
#[derive(Debug, thiserror::Error)]
pub enum StageError {
    /// The file of the machine.
    #[error("cannot read {}: {error}", .file.display())]
    Unreadable {
        /// Which.
        file: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// What is in it.
    #[error("{origin}: {error}")]
    Machine {
        /// The file, or the command line.
        origin: String,
        /// Why.
        error: MachineError,
    },
}

/// A name of an imperfection.
fn imperfection(more: &[&'static str]) -> PossibleValuesParser {
    (more.iter().copied())
        .chain(NAMED.iter().map(|named| named.name))
        .collect::<Vec<_>>()
        .into()
}

/// Beyond that the simulated motors have no torque, or the platform no mass.
const MISMATCH_LIMIT_PERCENT: f64 = 80.0;

/// What the reference stage carries at most.
const PAYLOAD_LIMIT_KG: f64 = 5.0;

/// What to do in a run called `name`.
///
/// # Errors
/// [`StageError`]: there is no such machine.
pub fn options(name: &str, arguments: &Simulation) -> Result<RunOptions, StageError> {
    let default = || PathBuf::from(format!("{FOLDER}{name}"));
    Ok(RunOptions {
        out: arguments.out.clone().unwrap_or_else(default),
        every: arguments.every,
        quiet: arguments.quiet,
        ..stage_options(&arguments.stage)?
    })
}

/// The stage that was asked for; the rest as it is by default.
///
/// # Errors
/// [`StageError`]: there is no such machine.
pub fn stage_options(arguments: &SimulatedStage) -> Result<RunOptions, StageError> {
    let machine = arguments.machine.parameters()?;
    let Machine { kind, unknown, .. } = arguments.machine;
    let usual = if kind && arguments.machine.set.is_empty() {
        RunOptions::default().mismatch_percent
    } else {
        0.0
    };
    Ok(RunOptions {
        seed: arguments.seed,
        mismatch_percent: arguments.mismatch.unwrap_or(usual),
        payload_kg: arguments.payload,
        imperfections: imperfections(arguments, machine.plant.imperfections),
        machine,
        machine_name: arguments.machine.name(),
        // Nobody knows its zeros.
        uncommissioned: arguments.uncommissioned || arguments.machine.unknown.is_some(),
        told: if arguments.told {
            Told::Everything
        } else if !kind && unknown.is_none() && !arguments.uncommissioned {
            Told::Reference
        } else {
            Told::Nothing
        },
        ..RunOptions::default()
    })
}

fn imperfections(arguments: &SimulatedStage, usual: Imperfections) -> Imperfections {
    let all = |names: &[String]| names.iter().any(|name| name == "all");
    let start = if all(&arguments.without) {
        // The transmission that does not give way, as well.
        Imperfections {
            compliance: false,
            ..Imperfections::NONE
        }
    } else if all(&arguments.with) {
        Imperfections::ALL
    } else {
        usual
    };
    let switched = |on: Imperfections, (name, is_on): (&String, bool)| {
        // What the command line takes is a name, or `all`.
        on.switched(name, is_on).unwrap_or(on)
    };
    let without = arguments.without.iter().map(|name| (name, false));
    let with = arguments.with.iter().map(|name| (name, true));
    without.chain(with).fold(start, switched)
}

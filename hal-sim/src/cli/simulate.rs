//! `tripivot` and `tripivot run`: a simulation, its summary and its folder.

use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use super::arguments::{Imperfection, SimulatedStage, Simulation};
use super::error::CliError;
use crate::devices::SettingsFlash;
use crate::plant::Imperfections;
use crate::report::make_folder;
use crate::run::{self, RunOptions};
use crate::script::Script;

/// Where runs go unless `--out` says otherwise, from the current folder.
const FOLDER: &str = "target/tripivot";

pub(super) fn demonstration(arguments: &Simulation) -> Result<ExitCode, CliError> {
    simulate("demonstration", arguments, &Script::demonstration()?, None)
}

pub(super) fn script(
    file: &Path,
    arguments: &Simulation,
    settings: Option<&Path>,
) -> Result<ExitCode, CliError> {
    let name = file
        .file_stem()
        .unwrap_or(file.as_os_str())
        .to_string_lossy();
    simulate(&name, arguments, &Script::read(file)?, settings)
}

/// Runs, and prints what came of it. A fault is reported after the summary, which shows how it came to it.
fn simulate(
    name: &str,
    arguments: &Simulation,
    script: &Script,
    settings: Option<&Path>,
) -> Result<ExitCode, CliError> {
    let flash = settings.map_or_else(|| Ok(SettingsFlash::in_memory()), SettingsFlash::open)?;
    let options = options(name, arguments);
    make_folder(&options.out)?;
    let outcome = run::run_with(script, &options, flash);
    outcome.run.write(&options.out)?;
    let mut text = String::new();
    for (query, answer) in &outcome.answers {
        text += &format!("{query}\n{}\n", answer.trim_end());
    }
    if !text.is_empty() {
        text.push('\n');
    }
    text += &format!(
        "{}{:<22}{}\n",
        outcome.run.summary(),
        "trace and report in",
        options.out.display()
    );
    (io::stdout().write_all(text.as_bytes())).map_err(CliError::output)?;
    match outcome.fault {
        Some(fault) => Err(CliError::Fault(fault)),
        None => Ok(ExitCode::SUCCESS),
    }
}

pub(super) fn options(name: &str, arguments: &Simulation) -> RunOptions {
    let default = || PathBuf::from(FOLDER).join(name);
    RunOptions {
        out: arguments.out.clone().unwrap_or_else(default),
        every: arguments.every,
        quiet: arguments.quiet,
        ..stage_options(&arguments.stage)
    }
}

/// The stage that was asked for; the rest as it is by default.
pub(super) fn stage_options(arguments: &SimulatedStage) -> RunOptions {
    RunOptions {
        seed: arguments.seed,
        mismatch_percent: arguments.mismatch,
        payload_kg: arguments.payload,
        imperfections: imperfections(arguments),
        ..RunOptions::default()
    }
}

fn imperfections(arguments: &SimulatedStage) -> Imperfections {
    let mut on = Imperfections {
        encoder_eccentricity: arguments.eccentricity,
        ..Imperfections::CALIBRATED
    };
    for without in &arguments.without {
        match without {
            Imperfection::All => {
                on = Imperfections {
                    compliance: false,
                    ..Imperfections::NONE
                }
            }
            Imperfection::DryFriction => on.dry_friction = false,
            Imperfection::ViscousFriction => on.viscous_friction = false,
            Imperfection::Compliance => on.compliance = false,
            Imperfection::Backlash => on.backlash = false,
            Imperfection::TorqueRipple => on.torque_ripple = false,
            Imperfection::EncoderNoise => on.encoder_noise = false,
            Imperfection::DeadTime => on.dead_time = false,
            Imperfection::PwmQuantisation => on.pwm_quantisation = false,
        }
    }
    on
}

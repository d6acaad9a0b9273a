//! `tripivot` and `tripivot run`: a simulation, its summary and its folder.

use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

use super::error::CliError;
use super::stage::{Simulation, options};
use drawing::make_folder;
use hal_sim::machine::devices::SettingsFlash;
use hal_sim::rig::run;
use hal_sim::rig::script::Script;

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

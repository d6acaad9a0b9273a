//! `tripivot` and `tripivot run`: a simulation, its summary and its folder.

use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

use serde::Serialize;

use super::VERSION;
use super::error::CliError;
use super::json;
use super::stage::{Simulation, options};
use drawing::claim_folder;
use hal_sim::machine::devices::SettingsFlash;
use hal_sim::report::{FILES, Facts};
use hal_sim::rig::run::{self, RunOutcome};
use hal_sim::rig::script::Script;

/// What a run is told as with `--json`.
#[derive(Serialize)]
struct Document<'a> {
    #[serde(flatten)]
    facts: Facts<'a>,
    answers: Vec<Answer<'a>>,
    fault: Option<&'a str>,
    folder: String,
}

/// A query of the script, and what the controller answered.
#[derive(Serialize)]
struct Answer<'a> {
    line: &'a str,
    answer: &'a str,
}

pub(super) fn demonstration(arguments: &Simulation, json: bool) -> Result<ExitCode, CliError> {
    let script = Script::demonstration()?;
    simulate("demonstration", arguments, &script, None, json)
}

pub(super) fn script(
    file: &Path,
    arguments: &Simulation,
    settings: Option<&Path>,
    json: bool,
) -> Result<ExitCode, CliError> {
    let name = file
        .file_stem()
        .unwrap_or(file.as_os_str())
        .to_string_lossy();
    simulate(&name, arguments, &Script::read(file)?, settings, json)
}

/// Runs, and prints what came of it. A fault is reported after the summary, which shows how it came to it.
fn simulate(
    name: &str,
    arguments: &Simulation,
    script: &Script,
    settings: Option<&Path>,
    json: bool,
) -> Result<ExitCode, CliError> {
    let flash = settings.map_or_else(|| Ok(SettingsFlash::in_memory()), SettingsFlash::open)?;
    let options = options(name, arguments)?;
    claim_folder(&options.out, &FILES)?;
    let mut outcome = run::run_with(script, &options, flash);
    let conditions = &mut outcome.run.conditions;
    conditions.program = format!("tripivot {VERSION}");
    conditions.settings = settings.map(|file| file.display().to_string());
    outcome.run.write(&options.out)?;
    if json {
        json::print(&document(&outcome, &options.out))?;
    } else {
        let text = text(&outcome, &options.out);
        (io::stdout().write_all(text.as_bytes())).map_err(CliError::output)?;
    }
    let (never, moves) = (outcome.run.never_settled(), outcome.run.moves.len());
    match outcome.fault {
        Some(fault) => Err(CliError::Fault(fault)),
        None if never > 0 => Err(CliError::NeverSettled { never, moves }),
        None => Ok(ExitCode::SUCCESS),
    }
}

fn document<'a>(outcome: &'a RunOutcome, folder: &Path) -> Document<'a> {
    let answer = |(line, answer): &'a (String, String)| Answer {
        line,
        answer: answer.trim_end(),
    };
    Document {
        facts: outcome.run.facts(),
        answers: outcome.answers.iter().map(answer).collect(),
        fault: outcome.fault.as_deref(),
        folder: folder.display().to_string(),
    }
}

fn text(outcome: &RunOutcome, folder: &Path) -> String {
    let mut text = String::new();
    for (query, answer) in &outcome.answers {
        text += &format!("{query}\n{}\n", answer.trim_end());
    }
    if !text.is_empty() {
        text.push('\n');
    }
    text + &format!(
        "{}{:<22}{}\n",
        outcome.run.summary(),
        "trace and report in",
        folder.display()
    )
}

//! `tripivot commission`: from a machine that nobody knows to one that moves.

pub(super) mod simulated;

use std::fs;
use std::io::{self, Write};
use std::process::ExitCode;

use super::FAILED;
use super::arguments::Commission;
use super::error::CliError;
use super::view::endpoint;
use desk::commission::{Attended, Chosen, Done, Machine, STEPS, page, run as run_steps};
use drawing::ReportError;
use hal_sim::date;
use simulated::SimulatedMachine;

/// Names of the files in the folder.
const REPORT: &str = "report.html";
const SETTINGS: &str = "settings.flash";

pub(super) fn run(arguments: &Commission) -> Result<ExitCode, CliError> {
    if arguments.list {
        let text: String = (STEPS.iter())
            .map(|step| format!("{:<14}{}\n", step.name, step.about))
            .collect();
        (io::stdout().write_all(text.as_bytes())).map_err(CliError::output)?;
        return Ok(ExitCode::SUCCESS);
    }
    let chosen = match (&arguments.from, &arguments.only) {
        (Some(name), _) => Chosen::from(name)?,
        (_, Some(name)) => Chosen::only(name)?,
        _ => Chosen::all(),
    };
    // Before anything moves: a report that cannot be written is of no use.
    let report = arguments.out.join(REPORT);
    let cannot = |source| ReportError::Unwritable {
        path: report.clone(),
        source,
    };
    fs::create_dir_all(&arguments.out).map_err(cannot)?;
    let mut machine: Box<dyn Machine> = if arguments.machine.is_simulated() {
        let settings = arguments.out.join(SETTINGS);
        Box::new(SimulatedMachine::new(
            &arguments.machine.parameters()?,
            arguments.seed,
            &settings,
        )?)
    } else {
        Box::new(Attended::open(
            &endpoint(&arguments.controller)?,
            |text| eprintln!("{text}"),
            || io::stdin().read_line(&mut String::new()).map(|_| ()),
        )?)
    };
    let identity = machine.ask("*IDN?")?.unwrap_or_default();
    let name = if arguments.machine.is_simulated() {
        arguments.machine.name()
    } else {
        "machine".to_owned()
    };
    let mut written = Ok(());
    let all = run_steps(machine.as_mut(), &chosen, &mut |done| {
        if written.is_ok() {
            written = io::stdout().write_all(told(done).as_bytes());
        }
    })?;
    written.map_err(CliError::output)?;
    fs::write(&report, page(&identity, &date::today(), &name, &all)).map_err(cannot)?;
    let failed = all.iter().any(|done| done.failure.is_some());
    let verdict = if failed {
        "not commissioned"
    } else {
        "commissioned"
    };
    let seconds: f64 = all.iter().map(|done| done.seconds).sum();
    let text = format!(
        "{verdict} in {seconds:.0} s; report: {}\n",
        report.display()
    );
    (io::stdout().write_all(text.as_bytes())).map_err(CliError::output)?;
    Ok(if failed {
        ExitCode::from(FAILED)
    } else {
        ExitCode::SUCCESS
    })
}

fn told(done: &Done) -> String {
    let mut text = format!(
        "{}: {} ({:.1} s)\n",
        done.step.name, done.step.about, done.seconds
    );
    for finding in &done.found.findings {
        let verdict = match (finding.passed, finding.limit.is_empty()) {
            (true, true) => "",
            (true, false) => "ok",
            (false, _) => "FAILED",
        };
        let limit = if finding.limit.is_empty() {
            String::new()
        } else {
            format!(" ({})", finding.limit)
        };
        text += &format!(
            "  {verdict:<7} {}: {}{limit}\n",
            finding.name, finding.value
        );
    }
    if let Some(failure) = &done.failure {
        text += &format!(
            "  FAILED: {}\n  what to do: {}\n",
            failure.what, failure.advice
        );
    }
    text
}

//! `tripivot commission`, `tune` and `frf`: from a machine that nobody knows to one that moves; to one that carries something else; and what its
//! loops are.

use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

use super::FAILED;
use super::arguments::{Commission, Commissioned, Tune};
use super::error::CliError;
use super::view::endpoint;
use crate::attended::SimulatedMachine;
use desk::commission::{
    Attended, Backup, Change, Chosen, Conditions, DoTask, Done, Machine, Results, STEPS, ZerosBy,
    page, run as run_steps,
};
use desk::date;
use drawing::ReportError;
use hal_sim::machine::devices::SettingsFlash;

/// Names of the files in the folder.
const REPORT: &str = "report.html";
const RESULTS: &str = "results.json";
const BEFORE: &str = "before.txt";
const FOUND: &str = "settings.txt";
const SETTINGS: &str = "settings.flash";
/// The report of a loop that is only looked at.
const RESPONSE: &str = "frf.html";

pub(super) fn run(arguments: &Commission) -> Result<ExitCode, CliError> {
    if arguments.list {
        let text: String = (STEPS.iter())
            .map(|step| format!("{:<14}{}\n", step.name, step.about))
            .collect();
        return say(&text);
    }
    if arguments.undo {
        return undo(&arguments.on);
    }
    let zeros = ZerosBy::new(arguments.without_jig);
    let chosen = match (&arguments.from, &arguments.only) {
        (Some(name), _) => Chosen::from(name, zeros)?,
        (_, Some(name)) => Chosen::only(name)?,
        _ => Chosen::all(zeros),
    }
    .also_carrying(arguments.load.also_carries)?;
    let answer = if arguments.yes {
        || Ok(())
    } else {
        wait_for_enter
    };
    commission(&arguments.on, &chosen, answer)
}

/// A new payload.
pub(super) fn tune(arguments: &Tune) -> Result<ExitCode, CliError> {
    let chosen = Chosen::tune().also_carrying(arguments.load.also_carries)?;
    commission(&arguments.on, &chosen, wait_for_enter)
}

fn commission(
    on: &Commissioned,
    chosen: &Chosen,
    answer: fn() -> io::Result<()>,
) -> Result<ExitCode, CliError> {
    let mut machine = open(on, answer)?;
    let conditions = conditions(on, machine.as_mut())?;
    let path = on.out.join(RESULTS);
    let earlier = Results::read(&path, &conditions.identity)?;
    Backup::of(machine.as_mut())?.write(&on.out.join(BEFORE))?;
    let all = steps(machine.as_mut(), chosen)?;
    let results = Results::new(conditions.clone(), &all);
    let changes = earlier.as_ref().map(|earlier| results.changes(earlier));
    let failed = all.iter().any(|done| done.failure.is_some());
    if !failed {
        // What a run that failed has measured is in its report; what is kept is what was.
        results.write(&path, earlier.as_ref())?;
        Backup::of(machine.as_mut())?.write(&on.out.join(FOUND))?;
    }
    let verdict = if failed {
        "not commissioned"
    } else {
        "commissioned"
    };
    let report = on.out.join(REPORT);
    let text = page(&conditions, &all, changes.as_deref());
    fs::write(&report, text).map_err(unwritable(&report))?;
    tables(&on.out, &all)?;
    say(&told_changes(changes.as_deref()))?;
    end(&all, verdict, &report)
}

/// What a loop is: lines and plots, and everything as it was.
pub(super) fn frf(on: &Commissioned) -> Result<ExitCode, CliError> {
    let mut machine = open(on, wait_for_enter)?;
    let conditions = conditions(on, machine.as_mut())?;
    let all = steps(machine.as_mut(), &Chosen::response())?;
    let report = on.out.join(RESPONSE);
    fs::write(&report, page(&conditions, &all, None)).map_err(unwritable(&report))?;
    tables(&on.out, &all)?;
    end(&all, "measured", &report)
}

/// Gives back what was before the last run into this folder.
fn undo(on: &Commissioned) -> Result<ExitCode, CliError> {
    let backup = Backup::read(&on.out.join(BEFORE))?;
    let changed = backup.give_back(open(on, wait_for_enter)?.as_mut())?;
    say(&format!(
        "{} parameters and {} macros are what they were before, and kept\n",
        changed.parameters, changed.macros
    ))
}

/// The person's answer. Nobody there is none: what was asked for may not be done.
pub(super) fn wait_for_enter() -> io::Result<()> {
    match io::stdin().read_line(&mut String::new())? {
        0 => Err(io::Error::new(
            io::ErrorKind::UnexpectedEof,
            "nobody is there to press Enter",
        )),
        _ => Ok(()),
    }
}

/// The machine, and the folder. `answer` is waited for where a person has to say that something is done.
fn open(on: &Commissioned, answer: fn() -> io::Result<()>) -> Result<Box<dyn Machine>, CliError> {
    // Before anything moves: a report that cannot be written is of no use.
    fs::create_dir_all(&on.out).map_err(unwritable(&on.out.join(REPORT)))?;
    if on.machine.is_simulated() {
        let mut stage = on.machine.parameters()?;
        stage.seed = on.seed;
        let flash = SettingsFlash::open(&on.out.join(SETTINGS))?;
        return Ok(Box::new(SimulatedMachine::new(&stage, flash)));
    }
    let machine = Attended::open(&endpoint(&on.controller)?, by_hand(answer))?;
    Ok(Box::new(machine.with_scale_periods(on.scale_periods)))
}

/// Whoever reads standard error does it; `answer` is waited for where it has to be said that it is done.
pub(super) fn by_hand(answer: fn() -> io::Result<()>) -> DoTask {
    Box::new(move |task| {
        eprintln!("{}", task.words());
        if task.is_said_to_be_done() {
            eprintln!("Press Enter when that is done.");
            answer()?;
        }
        Ok(())
    })
}

fn conditions(on: &Commissioned, machine: &mut dyn Machine) -> Result<Conditions, CliError> {
    let name = if on.machine.is_simulated() {
        on.machine.name()
    } else {
        "machine".to_owned()
    };
    Ok(Conditions {
        machine: name,
        identity: machine.ask("*IDN?")?.unwrap_or_default(),
        date: date::today(),
        temperature_c: on.temperature,
    })
}

/// Runs the steps, and tells each as it ends.
fn steps(machine: &mut dyn Machine, chosen: &Chosen) -> Result<Vec<Done>, CliError> {
    let mut written = Ok(());
    let ran = run_steps(machine, chosen, &mut |done| {
        if written.is_ok() {
            written = io::stdout().write_all(told(done).as_bytes());
        }
    })?;
    written.map_err(CliError::output)?;
    Ok(ran.done)
}

/// Tables of the steps as files; a later step's replaces an earlier one's.
fn tables(folder: &Path, all: &[Done]) -> Result<(), CliError> {
    for table in all.iter().flat_map(|done| &done.found.tables) {
        let path = folder.join(format!("{}.csv", table.name));
        fs::write(&path, &table.csv).map_err(unwritable(&path))?;
    }
    Ok(())
}

fn unwritable(path: &Path) -> impl Fn(io::Error) -> ReportError {
    let path = path.to_owned();
    move |source| ReportError::Unwritable {
        path: path.clone(),
        source,
    }
}

fn say(text: &str) -> Result<ExitCode, CliError> {
    (io::stdout().write_all(text.as_bytes())).map_err(CliError::output)?;
    Ok(ExitCode::SUCCESS)
}

fn end(all: &[Done], verdict: &str, report: &Path) -> Result<ExitCode, CliError> {
    let seconds: f64 = all.iter().map(|done| done.seconds).sum();
    let failed = all.iter().any(|done| done.failure.is_some());
    let verdict = if failed && verdict == "measured" {
        "not measured"
    } else {
        verdict
    };
    say(&format!(
        "{verdict} in {seconds:.0} s; report: {}\n",
        report.display()
    ))?;
    Ok(if failed {
        ExitCode::from(FAILED)
    } else {
        ExitCode::SUCCESS
    })
}

fn told_changes(changes: Option<&[Change]>) -> String {
    match changes {
        None => String::new(),
        Some([]) => "nothing has changed by a hundredth or more since the last time\n".to_owned(),
        Some(changes) => (changes.iter())
            .map(|change| format!("changed: {}\n", change.words()))
            .collect(),
    }
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

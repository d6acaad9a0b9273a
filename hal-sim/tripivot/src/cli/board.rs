//! `tripivot board`: the tests that are to be repeated on every board.

use std::io::{self, Write};
use std::process::ExitCode;

use super::FAILED;
use super::arguments::BoardRun;
use super::error::CliError;
use super::view::endpoint;
use desk::board::{Done, Found, PLAN, PlanOptions, Test, Verdict, page, run as run_plan};
use desk::date;
use drawing::WholeFile;

pub(super) fn run(arguments: &BoardRun) -> Result<ExitCode, CliError> {
    if arguments.list {
        let text: String = PLAN.iter().map(listed).collect();
        (io::stdout().write_all(text.as_bytes())).map_err(CliError::output)?;
        return Ok(ExitCode::SUCCESS);
    }
    let options = PlanOptions {
        moves: arguments.moves,
        emulated: arguments.emulated,
    };
    // What cannot be written is found out before the tests, not after them.
    let unwritable = |error| CliError::unwritable(arguments.out.as_deref(), &error);
    let file = (arguments.out.as_deref().map(WholeFile::create).transpose()).map_err(unwritable)?;
    let (mut written, mut all) = (Ok(()), Vec::<Done>::new());
    let outcome = run_plan(
        &endpoint(&arguments.controller)?,
        options,
        &mut |test, found| {
            let text = told(test, found.as_ref());
            all.push((test, found));
            if written.is_ok() {
                written = io::stdout().write_all(text.as_bytes());
            }
        },
    )?;
    written.map_err(CliError::output)?;
    if let Some(file) = file {
        let text = page(&date::today(), &outcome, &all);
        file.finish(text.as_bytes()).map_err(unwritable)?;
    }
    Ok(if outcome.passed {
        ExitCode::SUCCESS
    } else {
        ExitCode::from(FAILED)
    })
}

fn listed(test: &Test) -> String {
    let moves = if test.moves { "moves " } else { "" };
    format!("{:<14}{moves:<6}{}\n", test.name, test.expected)
}

fn told(test: &Test, found: Option<&Found>) -> String {
    let name = test.name;
    let Some(Found { text, verdict }) = found else {
        return format!("{name:<14}left out: it moves the stage (--move)\n");
    };
    match verdict {
        Verdict::Passed => format!("{name:<14}ok      {text}\n"),
        Verdict::NotJudged => format!("{name:<14}-       not judged on an emulated chip: {text}\n"),
        Verdict::Failed => format!(
            "{name:<14}FAILED  {text}\n{:<22}expected: {}\n",
            "", test.expected
        ),
    }
}

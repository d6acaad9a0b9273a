//! `tripivot board`: the tests that are to be repeated on every board.

use std::io::{self, Write};
use std::process::ExitCode;

use super::FAILED;
use super::arguments::BoardRun;
use super::error::CliError;
use super::view::endpoint;
use desk::board::{Found, PLAN, PlanOptions, Test, Verdict, run as run_plan};

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
    let mut written = Ok(());
    let all = run_plan(
        &endpoint(&arguments.controller)?,
        options,
        &mut |test, found| {
            let text = told(test, found);
            if written.is_ok() {
                written = io::stdout().write_all(text.as_bytes());
            }
        },
    )?;
    written.map_err(CliError::output)?;
    Ok(if all {
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

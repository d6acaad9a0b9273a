//! `tripivot completions` and `tripivot man`: the command line as shells and `man` know it, made from the same declaration.

use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;

use clap::CommandFactory;
use clap_complete::Shell;

use super::arguments::Arguments;
use super::error::CliError;
use drawing::{make_folder, unwritable};

const PROGRAM: &str = "tripivot";

/// Prints the completions of a shell.
pub(super) fn completions(shell: Shell) -> Result<ExitCode, CliError> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), PROGRAM, &mut text);
    io::stdout().write_all(&text).map_err(CliError::output)?;
    Ok(ExitCode::SUCCESS)
}

/// Writes `tripivot.1`, and `tripivot-COMMAND.1` for every command.
pub(super) fn man(folder: &Path) -> Result<ExitCode, CliError> {
    make_folder(folder)?;
    let command = Arguments::command().name(PROGRAM);
    clap_mangen::generate_to(command, folder).map_err(unwritable(folder))?;
    Ok(ExitCode::SUCCESS)
}

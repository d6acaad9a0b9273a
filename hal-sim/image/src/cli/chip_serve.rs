//! `cargo chip-serve`: the emulated chip's serial line for GCS clients, until Ctrl-C.

use std::io::{self, Write};
use std::process::ExitCode;

use super::arguments::ChipServe;
use super::error::CliError;
use crate::chip::LineServer;
use desk::serve::{REMOTE_MEANS, ServeError, check_address};
use tripivot::cli::signal::until_signal;
use tripivot::cli::stage::stage_options;

pub(super) fn run(arguments: &ChipServe) -> Result<ExitCode, CliError> {
    let listen = |error| ServeError::Listen {
        listen: arguments.listen.clone(),
        error,
    };
    if check_address(&arguments.listen, arguments.allow_remote)? {
        eprintln!("{}: {REMOTE_MEANS}", arguments.listen);
    }
    let server = LineServer::bind(&arguments.listen).map_err(listen)?;
    let stop = until_signal()?;
    let text = format!(
        "listening at {}\nCtrl-C ends it\n",
        server.address().map_err(listen)?
    );
    (io::stdout().write_all(text.as_bytes())).map_err(CliError::output)?;
    let options = stage_options(&arguments.stage)?;
    server.run(&options, stop, |notice| eprintln!("{notice}"))?;
    Ok(ExitCode::SUCCESS)
}

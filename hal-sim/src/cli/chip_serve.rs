//! `tripivot chip-serve`: the emulated chip's serial line for GCS clients, until Ctrl-C.

use std::io::{self, Write};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::{SIGINT, SIGTERM};

use super::arguments::ChipServe;
use super::error::CliError;
use super::simulate::imperfections;
use crate::chip::LineServer;
use crate::run::RunOptions;
use crate::serve::ServeError;

pub(super) fn run(arguments: &ChipServe) -> Result<ExitCode, CliError> {
    let stage = &arguments.stage;
    let options = RunOptions {
        seed: stage.seed,
        mismatch_percent: stage.mismatch,
        payload_kg: stage.payload,
        imperfections: imperfections(stage),
        ..RunOptions::default()
    };
    let listen = |error| ServeError::Listen {
        listen: arguments.listen.clone(),
        error,
    };
    let server = LineServer::bind(&arguments.listen).map_err(listen)?;
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        signal_hook::flag::register(signal, Arc::clone(&stop)).map_err(ServeError::Signals)?;
    }
    let mut out = io::stdout().lock();
    writeln!(
        out,
        "listening at {}\nCtrl-C ends it",
        server.address().map_err(listen)?
    )
    .map_err(CliError::output)?;
    drop(out);
    server.run(&options, stop, |notice| eprintln!("{notice}"))?;
    Ok(ExitCode::SUCCESS)
}

//! `tripivot serve`: the simulated stage in real time, until Ctrl-C.

use std::io::{self, Write};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::{SIGINT, SIGTERM};

use super::arguments::Serve;
use super::error::CliError;
use super::simulate::imperfections;
use crate::run::{RunOptions, controller_parameters, stage_parameters};
use crate::serve::{Printer, ServeError, ServeOptions, Server};

pub(super) fn run(arguments: &Serve) -> Result<ExitCode, CliError> {
    let server = Server::bind(options(arguments))?;
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        signal_hook::flag::register(signal, Arc::clone(&stop)).map_err(ServeError::Signals)?;
    }
    announce(&server).map_err(CliError::output)?;
    let mut printer = Printer::start();
    let result = server.run(&stop, &mut |notice| printer.print(&notice));
    printer.finish();
    result?;
    Ok(ExitCode::SUCCESS)
}

fn options(arguments: &Serve) -> ServeOptions {
    let stage = &arguments.stage;
    let options = RunOptions {
        seed: stage.seed,
        mismatch_percent: stage.mismatch,
        payload_kg: stage.payload,
        imperfections: imperfections(stage),
        ..RunOptions::default()
    };
    ServeOptions {
        listen: arguments.listen.clone(),
        speed: arguments.speed,
        terminal: arguments.pty,
        parameters: controller_parameters(&options),
        stage: stage_parameters(&options),
    }
}

fn announce(server: &Server) -> io::Result<()> {
    let mut out = io::stdout().lock();
    writeln!(out, "listening at {}", server.address()?)?;
    if let Some(path) = server.terminal() {
        writeln!(out, "terminal at {}", path.display())?;
    }
    writeln!(out, "Ctrl-C ends it")
}

//! `tripivot serve`: the simulated stage in real time, and its page, until Ctrl-C.

use std::io::{self, Write};
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::{SIGINT, SIGTERM};

use super::arguments::Serve;
use super::error::CliError;
use super::simulate::stage_options;
use super::view::page;
use crate::run::{controller_parameters, stage_parameters};
use crate::serve::{Printer, ServeError, ServeOptions, Server};
use crate::web::{Endpoint, Page};

/// In place of the page's address: no page.
const OFF: &str = "off";

pub(super) fn run(arguments: &Serve) -> Result<ExitCode, CliError> {
    let server = Server::bind(options(arguments))?;
    let stop = until_signal()?;
    let own = server.address().map_err(CliError::output)?;
    let page = match arguments.web.as_deref() {
        Some(OFF) => None,
        web => Some(page(web, Endpoint::Tcp(reached_at(own).to_string()))?),
    };
    announce(&server, page.as_ref()).map_err(CliError::output)?;
    let mut printer = Printer::start();
    let result = server.run(&stop, &mut |notice| printer.print(&notice));
    printer.finish();
    result?;
    Ok(ExitCode::SUCCESS)
}

fn options(arguments: &Serve) -> ServeOptions {
    let options = stage_options(&arguments.stage);
    ServeOptions {
        listen: arguments.listen.clone(),
        speed: arguments.speed,
        terminal: arguments.pty,
        parameters: controller_parameters(&options),
        stage: stage_parameters(&options),
        settings: arguments.settings.clone(),
    }
}

/// Set once Ctrl-C is pressed or the process is asked to end.
pub(super) fn until_signal() -> Result<Arc<AtomicBool>, CliError> {
    let stop = Arc::new(AtomicBool::new(false));
    for signal in [SIGINT, SIGTERM] {
        signal_hook::flag::register(signal, Arc::clone(&stop)).map_err(ServeError::Signals)?;
    }
    Ok(stop)
}

/// Where this machine itself reaches a server that listens at `address`.
fn reached_at(address: SocketAddr) -> SocketAddr {
    let ip = match address.ip() {
        IpAddr::V4(ip) if ip.is_unspecified() => Ipv4Addr::LOCALHOST.into(),
        IpAddr::V6(ip) if ip.is_unspecified() => Ipv6Addr::LOCALHOST.into(),
        ip => ip,
    };
    SocketAddr::new(ip, address.port())
}

fn announce(server: &Server, page: Option<&Page>) -> io::Result<()> {
    let mut out = io::stdout().lock();
    writeln!(out, "listening at {}", server.address()?)?;
    if let Some(page) = page {
        writeln!(out, "page at http://{}/", page.address())?;
    }
    if let Some(path) = server.terminal() {
        writeln!(out, "terminal at {}", path.display())?;
    }
    writeln!(out, "Ctrl-C ends it")
}

//! `tripivot serve`: the simulated stage in real time, and its page, until Ctrl-C.

use std::io::{self, Write};
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::process::ExitCode;
use std::sync::Arc;

use calibration::Instrument;

use super::arguments::Serve;
use super::calibrate::reader::{self, TruePose};
use super::error::CliError;
use super::signal::until_signal;
use super::stage::stage_options;
use super::view::{Beside, page};
use desk::calibrate::Reader;
use desk::line::Endpoint;
use desk::serve::{Printer, REMOTE_MEANS, ServeOptions, Server, check_address};
use desk::web::{Instruments, Page};
use hal_sim::machine::devices::{SettingsFlash, StageParameters};
use hal_sim::machine::instruments;
use hal_sim::rig::ControllerMemory;
use hal_sim::rig::run::stage_parameters;

use crate::simulated::Simulated;

/// Of how simulated instruments are set up: the same plate as long as it serves.
const INSTRUMENT_SEED: u64 = 1;
/// In place of the page's address: no page.
const OFF: &str = "off";

pub(super) fn run(arguments: &Serve) -> Result<ExitCode, CliError> {
    let is_remote = check_address(&arguments.listen, arguments.access.allow_remote)?;
    let flash = (arguments.settings.as_deref())
        .map_or_else(|| Ok(SettingsFlash::in_memory()), SettingsFlash::open)?;
    let settings = settings_text(arguments, &flash);
    let mut memory = ControllerMemory::new();
    let options = stage_options(&arguments.stage)?;
    let mut stage = Simulated::new(&mut memory, &options, flash);
    let server = Server::bind(ServeOptions {
        listen: arguments.listen.clone(),
        speed: arguments.speed,
        terminal: arguments.pty,
    })?;
    let stop = until_signal()?;
    let own = server.address().map_err(CliError::output)?;
    let page = match arguments.web.as_deref() {
        Some(OFF) => None,
        web => {
            let endpoint = Endpoint::Tcp(reached_at(own).to_string());
            let beside = Beside {
                person: Some(stage.person()),
                instruments: Some(instruments(&mut stage, &stage_parameters(&options))),
            };
            Some(page(web, &arguments.access, endpoint, beside)?)
        }
    };
    announce(&server, page.as_ref(), is_remote, &settings).map_err(CliError::output)?;
    let mut printer = Printer::start();
    let result = server.run(&mut stage, &stop, &mut |notice| printer.print(&notice));
    printer.finish();
    result?;
    Ok(ExitCode::SUCCESS)
}

/// The simulated instruments, which see the true pose.
fn instruments(stage: &mut Simulated<'_>, built: &StageParameters) -> Instruments {
    let (true_pose, wiring) = (stage.true_pose(), built.wiring);
    let radius_m = built.plant.track_radius_m;
    let set_up = move |instrument: &Instrument| -> Option<Box<dyn Reader>> {
        Some(Box::new(reader::Simulated {
            instrument: instruments::Beside::set_up(instrument, radius_m, INSTRUMENT_SEED)?,
            true_pose: TruePose::new(true_pose.clone(), &wiring),
        }))
    };
    Instruments {
        words: "the simulated instrument",
        set_up: Arc::new(set_up),
    }
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

/// With which settings the controller starts, and where it keeps them.
fn settings_text(arguments: &Serve, flash: &SettingsFlash) -> String {
    let kept = (arguments.settings.as_deref()).map_or_else(
        || "kept until it ends".to_owned(),
        |file| format!("kept in {}", file.display()),
    );
    let which = match (flash.is_erased(), arguments.stage.uncommissioned) {
        (false, _) => "those that were kept",
        (true, false) => "those that the simulated machine comes with",
        (true, true) => "none, the machine is not commissioned",
    };
    format!("settings: {which}; {kept}")
}

fn announce(
    server: &Server,
    page: Option<&Page>,
    is_remote: bool,
    settings: &str,
) -> io::Result<()> {
    let mut out = io::stdout().lock();
    writeln!(out, "listening at {}", server.address()?)?;
    if is_remote {
        writeln!(out, "{REMOTE_MEANS}")?;
    }
    if let Some(page) = page {
        writeln!(out, "page at http://{}/", page.address())?;
    }
    if let Some(path) = server.terminal() {
        writeln!(out, "terminal at {}", path.display())?;
    }
    writeln!(out, "{settings}")?;
    writeln!(out, "Ctrl-C ends it")
}

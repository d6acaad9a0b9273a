//! `tripivot view`: the page for a controller that runs already, until Ctrl-C.

use std::io::{self, Write};
use std::process::ExitCode;
use std::sync::atomic::Ordering;
use std::thread;
use std::time::Duration;

use super::arguments::{Controller, View};
use super::error::CliError;
use super::signal::until_signal;
use desk::web::{Endpoint, Page, PageError};

/// Where the page is unless it is told otherwise.
const ADDRESS: &str = "127.0.0.1:8080";
/// Where it is when that is taken.
const FREE_ADDRESS: &str = "127.0.0.1:0";
/// How often Ctrl-C is looked for.
const LOOK_EVERY: Duration = Duration::from_millis(50);

pub(super) fn run(arguments: &View) -> Result<ExitCode, CliError> {
    let endpoint = endpoint(&arguments.controller)?;
    let stop = until_signal()?;
    let place = endpoint.to_string();
    let page = page(arguments.web.as_deref(), endpoint)?;
    let text = format!(
        "page at http://{}/ for the controller at {place}\nCtrl-C ends it\n",
        page.address()
    );
    (io::stdout().write_all(text.as_bytes())).map_err(CliError::output)?;
    while !stop.load(Ordering::Relaxed) {
        thread::sleep(LOOK_EVERY);
    }
    Ok(ExitCode::SUCCESS)
}

/// Where a controller is. A device that is not there is more likely misspelt than unplugged.
pub(super) fn endpoint(controller: &Controller) -> Result<Endpoint, CliError> {
    let Some(device) = &controller.port else {
        return Ok(Endpoint::Tcp(controller.connect.clone()));
    };
    // Devices of Unix are files; those of Windows are found out about by opening them.
    if cfg!(unix) && !device.exists() {
        let device = device.display();
        return Err(CliError::Value(format!(
            "{device}: there is no such device"
        )));
    }
    Ok(Endpoint::Serial {
        device: device.clone(),
        baud: controller.baud,
    })
}

/// The page where it was asked for, or at its usual place or a free port.
pub(super) fn page(address: Option<&str>, endpoint: Endpoint) -> Result<Page, PageError> {
    match address {
        Some(address) => Page::start(address, endpoint),
        None => match Page::start(ADDRESS, endpoint.clone()) {
            Err(PageError::Listen { error, .. }) if error.kind() == io::ErrorKind::AddrInUse => {
                Page::start(FREE_ADDRESS, endpoint)
            }
            result => result,
        },
    }
}

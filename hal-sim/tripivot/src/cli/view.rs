//! `tripivot view`: the page for a controller that runs already, until Ctrl-C, or until what is at the line is found to be none.

use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread;
use std::time::Duration;

use super::arguments::{Access, Controller, View};
use super::calibrate::reader::Asked;
use super::error::CliError;
use super::signal::until_signal;
use desk::line::Endpoint;
use desk::serve::{REMOTE_PAGE_MEANS, check_address};
use desk::web::{Instruments, Page, PageError, PageOptions, Person, new_password};

/// Where the page is unless it is told otherwise.
const ADDRESS: &str = "127.0.0.1:8080";
/// Where it is when that is taken.
const FREE_ADDRESS: &str = "127.0.0.1:0";
/// Characters of a password that is given.
const SHORTEST_PASSWORD: usize = 8;
/// How often Ctrl-C is looked for.
const LOOK_EVERY: Duration = Duration::from_millis(50);

pub(super) fn run(arguments: &View) -> Result<ExitCode, CliError> {
    let endpoint = endpoint(&arguments.controller)?;
    let stop = until_signal()?;
    let place = endpoint.to_string();
    let instruments = arguments.reader.as_deref().map(asked);
    let beside = Beside {
        person: None,
        instruments,
    };
    let page = page(
        arguments.web.as_deref(),
        &arguments.access,
        endpoint,
        beside,
    )?;
    let text = format!(
        "page at http://{}/ for the controller at {place}\nCtrl-C ends it\n",
        page.address()
    );
    (io::stdout().write_all(text.as_bytes())).map_err(CliError::output)?;
    while !stop.load(Ordering::Relaxed) {
        if let Some(reason) = page.no_controller() {
            let reason = reason.to_owned();
            return Err(PageError::NoController { place, reason }.into());
        }
        thread::sleep(LOOK_EVERY);
    }
    Ok(ExitCode::SUCCESS)
}

/// What is beside a machine, in place of whoever looks at its page.
pub(super) struct Beside {
    pub(super) person: Option<Person>,
    pub(super) instruments: Option<Instruments>,
}

/// Instruments that this command reads.
fn asked(command: &str) -> Instruments {
    let command = command.to_owned();
    Instruments {
        words: "the command of --reader",
        set_up: Arc::new(move |instrument| {
            Some(Box::new(Asked {
                command: command.clone(),
                instrument: instrument.clone(),
            }))
        }),
    }
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

/// The page where it was asked for, or at its usual place or a free port; with a password where others than this machine may
/// reach it.
pub(super) fn page(
    address: Option<&str>,
    access: &Access,
    endpoint: Endpoint,
    beside: Beside,
) -> Result<Page, CliError> {
    let is_remote = check_address(address.unwrap_or(ADDRESS), access.allow_remote)?;
    if is_remote {
        writeln!(io::stdout(), "{REMOTE_PAGE_MEANS}").map_err(CliError::output)?;
    }
    let password = password(access, is_remote)?;
    let options = |address: &str| PageOptions {
        address: address.to_owned(),
        password: password.clone(),
        public_url: access.public_url.clone(),
        person: beside.person.clone(),
        instruments: beside.instruments.clone(),
    };
    let page = match address {
        Some(address) => Page::start(&options(address), endpoint),
        None => match Page::start(&options(ADDRESS), endpoint.clone()) {
            Err(PageError::Listen { error, .. }) if error.kind() == io::ErrorKind::AddrInUse => {
                Page::start(&options(FREE_ADDRESS), endpoint)
            }
            result => result,
        },
    }?;
    Ok(page)
}

/// The password that the page asks for, if it does; one that was made is printed.
fn password(access: &Access, is_remote: bool) -> Result<Option<String>, CliError> {
    if let Some(file) = &access.password_file {
        return read_password(file).map(Some);
    }
    if !is_remote && access.public_url.is_none() {
        return Ok(None);
    }
    let password = new_password().map_err(PageError::Start)?;
    writeln!(io::stdout(), "password of the page: {password}").map_err(CliError::output)?;
    Ok(Some(password))
}

fn read_password(file: &Path) -> Result<String, CliError> {
    let text = fs::read_to_string(file)
        .map_err(|error| CliError::Value(format!("{}: {error}", file.display())))?;
    let password = text.lines().next().unwrap_or_default().trim_end();
    if password.len() < SHORTEST_PASSWORD {
        let reason = format!("the password has less than {SHORTEST_PASSWORD} characters");
        return Err(CliError::Value(format!("{}: {reason}", file.display())));
    }
    Ok(password.to_owned())
}

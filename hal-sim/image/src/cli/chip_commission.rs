//! `cargo chip-commission`: an unknown machine, commissioned over the emulated chip's serial line.
//!
//! The chip's emulated flash takes nothing (`WPA` is refused, 4001). So what is in force when the last step wants it kept is read over the line;
//! a simulated controller is given that, and keeps it; and a chip that starts with that flash has to move the machine.

use std::fs;
use std::path::Path;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

use desk::commission::{
    Attended, Backup, Chosen, Conditions, Done, Finding, Machine, Ran, Task, ZerosBy,
};
use desk::commission::{page, run as run_steps};
use desk::date::today;
use desk::line::Endpoint;
use desk::record::RecordError;
use drawing::unwritable;
use hal_sim::machine::devices::SettingsFlash;
use hal_sim::machine::unknown;
use hal_sim::rig::Told;
use hal_sim::rig::run::{RunOptions, stage_parameters};
use tripivot::attended::SimulatedMachine;

use super::arguments::ChipCommission;
use super::error::CliError;
use crate::chip::LineServer;

const REPORT: &str = "report.html";
const SETTINGS: &str = "settings.txt";
const FLASH: &str = "settings.flash";
/// How long a chip may be silent that is emulated many times slower than it would be.
const PATIENCE: Duration = Duration::from_secs(120);
/// The last step, and how the emulated chip answers it.
const KEEP: &str = "keep";
const NOT_KEPT: u16 = 4001;
const NOT_KEPT_SAID: &str =
    "the emulated flash keeps nothing, as expected; what is in force was read";
/// Moves of the chip that keeps what was found.
const VERIFICATION: &str = "verification";

pub(super) fn run(arguments: &ChipCommission) -> Result<ExitCode, CliError> {
    let out = &arguments.out;
    fs::create_dir_all(out).map_err(unwritable(out))?;
    let options = RunOptions {
        machine: unknown(arguments.unknown),
        imperfections: unknown(arguments.unknown).plant.imperfections,
        mismatch_percent: 0.0,
        told: Told::Nothing,
        uncommissioned: true,
        ..RunOptions::default()
    };
    let (done, found) = on_chip(&options, None, &Chosen::all(ZerosBy::Jig))?;
    let conditions = Conditions {
        machine: format!("unknown machine {}, emulated chip", arguments.unknown),
        date: today(),
        ..Conditions::default()
    };
    let report = out.join(REPORT);
    fs::write(&report, page(&conditions, &done, None)).map_err(unwritable(&report))?;
    let found = found.ok_or_else(|| failed(&done))?;
    found.write(&out.join(SETTINGS))?;
    let flash = kept(&options, &found, &out.join(FLASH))?;
    let chosen = Chosen::only(VERIFICATION).map_err(|error| CliError::Value(error.to_string()))?;
    let (verified, keeps) = on_chip(&options, Some(flash), &chosen)?;
    keeps.ok_or_else(|| failed(&verified))?;
    let seconds: f64 = done.iter().map(|done| done.seconds).sum();
    println!(
        "commissioned in {seconds:.0} s of the chip's time; a chip that keeps {} moves the machine; report: {}",
        out.join(SETTINGS).display(),
        report.display()
    );
    Ok(ExitCode::SUCCESS)
}

/// The steps on a chip that starts with this flash, or with nothing; what was in force when they ended, where no other than the last failed.
fn on_chip(
    options: &RunOptions,
    flash: Option<SettingsFlash>,
    chosen: &Chosen,
) -> Result<(Vec<Done>, Option<Backup>), CliError> {
    let listen = |error| desk::serve::ServeError::Listen {
        listen: "127.0.0.1:0".to_owned(),
        error,
    };
    let (tasks, asked) = mpsc::channel();
    let mut server = LineServer::bind("127.0.0.1:0")
        .map_err(listen)?
        .with_person(asked);
    let address = server.address().map_err(listen)?;
    if let Some(flash) = flash {
        server = server.with_settings(flash);
    }
    let stop = Arc::new(AtomicBool::new(false));
    let chip = {
        let (options, stop) = (options.clone(), Arc::clone(&stop));
        thread::spawn(move || server.run(&options, stop, |_| ()))
    };
    let do_task = Box::new(move |task: Task| {
        // A chip that is gone does not answer either.
        let _ = tasks.send(task);
        Ok(())
    });
    let line = Attended::open(&Endpoint::Tcp(address.to_string()), do_task);
    let ran = line.and_then(|line| {
        let periods = stage_parameters(options).encoders[0].scale_periods_per_turn;
        let mut machine = Unkept {
            line: line
                .with_scale_periods(Some(periods))
                .with_patience(PATIENCE),
            in_force: None,
        };
        let ran = run_steps(&mut machine, chosen, &mut tell)?;
        Ok((ran, machine.in_force))
    });
    stop.store(true, Ordering::Relaxed);
    let served = chip.join();
    let (Ran { mut done, .. }, in_force) = ran?;
    served.map_err(|_| CliError::Fault("the emulator has panicked".to_owned()))??;
    let last = done.last_mut().filter(|done| done.step.name == KEEP);
    let kept = last.and_then(|keep| {
        let in_force = in_force?;
        // Refused as expected: the file is what is kept.
        keep.failure = None;
        keep.found.push(Finding::told(NOT_KEPT_SAID, SETTINGS));
        Some(in_force)
    });
    Ok((done, kept))
}

/// A line whose controller cannot keep anything: what is in force when it is asked to is read instead.
struct Unkept {
    line: Attended,
    in_force: Option<Backup>,
}

impl Machine for Unkept {
    fn ask(&mut self, line: &str) -> Result<Option<String>, RecordError> {
        if line.starts_with("WPA") {
            self.in_force = Some(Backup::of(&mut self.line)?);
        }
        let answer = self.line.ask(line);
        if let Err(RecordError::Refused { code: NOT_KEPT, .. }) = &answer
            && line.starts_with("WPA")
        {
            println!("  {NOT_KEPT_SAID}");
        }
        answer
    }

    fn delay(&mut self, seconds: f64) -> Result<(), RecordError> {
        self.line.delay(seconds)
    }

    fn request(&mut self, task: Task) -> Result<(), RecordError> {
        self.line.request(task)
    }

    fn scale_periods(&self) -> Option<u32> {
        self.line.scale_periods()
    }
}

/// A flash that keeps what was found: a simulated controller of the same machine is given it.
fn kept(options: &RunOptions, found: &Backup, path: &Path) -> Result<SettingsFlash, CliError> {
    let opened = || SettingsFlash::open(path).map_err(|error| CliError::Value(error.to_string()));
    // One of an earlier run is not this one's.
    if path.exists() {
        fs::remove_file(path).map_err(unwritable(path))?;
    }
    found.give_back(&mut SimulatedMachine::new(
        &stage_parameters(options),
        opened()?,
    ))?;
    opened()
}

fn tell(done: &Done) {
    let verdict = done
        .failure
        .as_ref()
        .map_or("done", |failure| &failure.what);
    println!("{}: {verdict} ({:.1} s)", done.step.name, done.seconds);
}

fn failed(done: &[Done]) -> CliError {
    let last = done.last();
    let failure = last.and_then(|done| Some((done.step.name, done.failure.as_ref()?)));
    CliError::Fault(failure.map_or_else(
        || "the last step has kept nothing".to_owned(),
        |(step, failure)| format!("step {step}: {}", failure.what),
    ))
}

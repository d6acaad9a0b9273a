//! Running a script on the emulated chip: the image's own tick moves the stage, the script comes over its USART, and a twin
//! on the host has to agree with it to the bit at every tick.

use std::fmt;
use std::ops::ControlFlow::{self, Break, Continue};
use std::path::{Path, PathBuf};
use std::sync::mpsc;

use firmware::mode::Mode;
use firmware::parameters::Parameters;

use super::{Bench, BenchError, Divergence, Period, TickCost, Twin, elf_file};
use crate::proof::ProofError;
use drawing::Progress;
use hal_sim::machine::devices::{SettingsFlash, Stage};
use hal_sim::report::{Conditions, Run};
use hal_sim::rig::client::{Client, Event};
use hal_sim::rig::observer::Observer;
use hal_sim::rig::run::{RunOptions, stage_parameters, stuck_text};
use hal_sim::rig::script::{Script, ScriptError};
use hal_sim::rig::{Disturbances, Told, machine_name, run_conditions, with_settings_over};

/// A run on the chip that came to its end, one way or another.
#[derive(Debug)]
pub struct ChipOutcome {
    /// Statistics, trace and moves.
    pub run: Run,
    /// The fault or the refused line that ended it, or where chip and host went apart.
    pub fault: Option<String>,
    /// Answers of the script's queries, with their lines.
    pub answers: Vec<(String, String)>,
    /// The plant's pose (m, m, rad) at the end.
    pub pose: [f64; 3],
    /// Ticks in which chip and host agreed.
    pub agreed: u64,
    /// The running hash over them.
    pub hash: u32,
    /// What the ticks cost.
    pub cost: TickCost,
}

/// Why there was no run, or none that counts.
#[derive(Debug)]
pub enum ChipError {
    /// There is no image.
    NoImage,
    /// The bench could not run it.
    Bench(PathBuf, BenchError),
    /// It could not be taken apart.
    Proof(PathBuf, ProofError),
    /// Its functions' names and places could not be read.
    Lines(PathBuf, String),
    /// The image touched what the emulator does not model.
    Gaps(Vec<String>),
    /// Its lines were answered with these, and not with those.
    Answers(Vec<String>, String),
    /// The run ended without a result.
    Lost,
    /// The lines of an exercise are no script.
    Script(ScriptError),
}

impl fmt::Display for ChipError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoImage => write!(f, "no image: build it with `cargo stage` first"),
            Self::Bench(path, error) => write!(f, "{}: {error}", path.display()),
            Self::Proof(path, error) => write!(f, "{}: {error}", path.display()),
            Self::Lines(path, error) => write!(f, "{}: {error}", path.display()),
            Self::Gaps(gaps) => {
                write!(
                    f,
                    "the image touched what the emulator does not model: {}",
                    gaps.join("; ")
                )
            }
            Self::Answers(answers, wanted) => write!(
                f,
                "the lines were answered with {}, which has to be {wanted}",
                answers.join(" ")
            ),
            Self::Lost => write!(f, "the emulator ended before the script"),
            Self::Script(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for ChipError {}

/// Everything that the run carries from period to period.
struct Runner {
    script: Script,
    client: Client,
    twin: Twin,
    observer: Observer,
    progress: Progress,
    period_s: f64,
    disturbances: Disturbances,
    answers: Vec<(String, String)>,
    agreed: u64,
    hash: u32,
    pose: [f64; 3],
    moving: bool,
}

/// Periods before the first line: what the image needs to start its interpreter is not the script's to wait for.
const WARM_UP: u64 = 20;
const PROGRESS_EVERY: u64 = 500;

/// Runs a script on the image that lies in the target folder.
///
/// # Errors
/// [`ChipError`]; a fault or a divergence is part of the outcome.
pub fn run(script: &Script, options: &RunOptions) -> Result<ChipOutcome, ChipError> {
    let path = elf_file::find().ok_or(ChipError::NoImage)?;
    run_image(&path, script, options)
}

/// What the board's flash keeps the settings of.
pub(super) fn machine_parameters(options: &RunOptions) -> Parameters {
    match options.told {
        Told::Nothing if options.uncommissioned => Parameters::REFERENCE.uncommissioned(),
        told => told.parameters(&Parameters::REFERENCE, &stage_parameters(options)),
    }
}

/// The board's flash with it.
pub(super) fn machine_settings(options: &RunOptions) -> SettingsFlash {
    let stage = stage_parameters(options);
    let calibration = options.told.calibration(&stage);
    let flash = SettingsFlash::in_memory();
    let parameters = machine_parameters(options);
    with_settings_over(
        &Parameters::REFERENCE,
        flash,
        &parameters,
        calibration.as_ref(),
    )
}

fn run_image(path: &Path, script: &Script, options: &RunOptions) -> Result<ChipOutcome, ChipError> {
    let parameters = machine_parameters(options);
    let stage = Stage::new(&stage_parameters(options));
    let mut runner = Some(Runner {
        script: script.clone(),
        client: Client::new(script),
        twin: Twin::with_settings(&parameters, machine_settings(options)),
        observer: Observer::new(&parameters, options.every),
        progress: Progress::new(script.lines.len() as u64, options.quiet),
        period_s: stage.period_s(),
        disturbances: Disturbances::default(),
        answers: Vec::new(),
        agreed: 0,
        hash: 0,
        pose: [0.0; 3],
        moving: false,
    });
    let (send, receive) = mpsc::channel();
    let bench = |error| ChipError::Bench(path.to_owned(), error);
    let outcome = Bench::load(path, stage)
        .map_err(bench)?
        .with_settings(machine_settings(options))
        .run(move |period| {
            let Some(now) = &mut runner else {
                return Break(());
            };
            let flow = now.period(period);
            match flow {
                Continue(()) => Continue(()),
                Break(fault) => {
                    // Nobody to send to means that the caller has given up.
                    let _ = send.send((runner.take(), fault));
                    Break(())
                }
            }
        })
        .map_err(|error| ChipError::Bench(path.to_owned(), error))?;
    if !outcome.gaps.is_empty() {
        return Err(ChipError::Gaps(outcome.gaps));
    }
    let (Some(runner), fault) = receive.try_recv().map_err(|_| ChipError::Lost)? else {
        return Err(ChipError::Lost);
    };
    Ok(ChipOutcome {
        run: Run {
            name: format!("{} on the emulated chip", runner.script.name),
            geometry: parameters.geometry,
            limits: parameters.limits,
            trace: runner.observer.trace,
            moves: runner.observer.moves,
            conditions: Conditions {
                machine: format!(
                    "simulated {}, controller's image on the emulated chip",
                    machine_name(options)
                ),
                ..run_conditions(options)
            },
            wall_s: runner.progress.finish(),
        },
        fault,
        answers: runner.answers,
        pose: runner.pose,
        agreed: runner.agreed,
        hash: runner.hash,
        cost: outcome.cost,
    })
}

impl Runner {
    /// One control period; breaks at the end of the script, or with what ended it early.
    fn period(&mut self, period: &mut Period<'_>) -> ControlFlow<Option<String>> {
        self.follow(period)?;
        (self.disturbances).act(&mut period.stage.plant, self.period_s);
        self.pose = period.stage.plant.pose();
        let received = period.received();
        if period.tick < WARM_UP {
            return Continue(());
        }
        let (bytes, event) = self.client.poll(&received, self.moving);
        period.send(&bytes);
        self.twin.receive(&bytes);
        if period.tick.is_multiple_of(PROGRESS_EVERY) {
            let simulated_s = period.tick as f64 * self.period_s;
            self.progress.update(self.client.done() as u64, simulated_s);
        }
        match event {
            Some(Event::Disturbed(disturbance)) => {
                self.disturbances.begin(disturbance);
                Continue(())
            }
            Some(Event::Finished) => Break(None),
            Some(Event::Stuck(line)) => Break(Some(stuck_text(&self.script, &line))),
            Some(Event::Refused(line, error)) => Break(Some(format!(
                "{}:{}: {}: refused with GCS error {error}",
                self.script.name, line.number, line.text
            ))),
            Some(Event::Done(line, Some(answer))) => {
                self.answers.push((line.text, answer));
                Continue(())
            }
            _ => Continue(()),
        }
    }

    fn follow(&mut self, period: &mut Period<'_>) -> ControlFlow<Option<String>> {
        let apart = |divergence| Break(Some(apart(&divergence)));
        if let Err(divergence) = self.twin.look(period) {
            return apart(divergence);
        }
        loop {
            let (record, pose) = match self.twin.catch_up() {
                Err(divergence) => return apart(divergence),
                Ok(None) => return Continue(()),
                Ok(Some(agreed)) => (agreed.record, agreed.pose),
            };
            self.agreed += 1;
            self.hash = record.hash.0;
            let Some(sample) = &record.sample else {
                continue;
            };
            self.observer.look(sample, pose);
            self.moving = sample.mode == Mode::Moving;
            if sample.mode == Mode::Fault {
                return Break(Some(format!("fault at tick {}", sample.tick)));
            }
        }
    }
}

fn apart(divergence: &Divergence) -> String {
    format!(
        "chip and host differ: {divergence}; is the image older than the sources (`cargo stage` builds it)?"
    )
}

//! An exercise: demanding motion from a seed on the image, and its twin on the host beside it at every tick.
//!
//! | file | idea |
//! |---|---|
//! | `tally` | what ticks cost, by what they did |
//!
//! The lines are those of [`hal_sim::rig::exercise`].
//!
//! Besides what the lines do, an encoder is broken now and then: in motion for as many frames as are bridged, at rest for more,
//! which is a fault that the lines acknowledge.

mod tally;

pub use tally::{Cost, Doing, Tally, Worst};

use std::collections::BTreeMap;
use std::ops::ControlFlow::{self, Break, Continue};
use std::path::Path;
use std::sync::mpsc;

use firmware::mode::Mode;
use firmware::parameters::Parameters;

use super::run::{ChipError, machine_parameters};
use super::{Bench, Divergence, Period, Twin, elf_file};
use drawing::Progress;
use hal_sim::machine::devices::{EncoderFault, SettingsFlash, Stage};
use hal_sim::rig::client::{Client, Event};
use hal_sim::rig::exercise::{Patience, script};
use hal_sim::rig::run::{RunOptions, stage_parameters};
use hal_sim::rig::{built_stage, calibration_told, with_settings_over};

/// What to do.
#[derive(Clone, Debug)]
pub struct ExerciseOptions {
    /// Ticks to compare.
    pub ticks: u64,
    /// The simulated stage, and the seed of the lines.
    pub run: RunOptions,
    /// Before this tick (from 0) the host's encoder count differs in one bit: a comparison that is one finds it.
    pub flip: Option<u64>,
    /// The stage is off its drawing as a workshop builds it, and the controller keeps its calibration.
    pub calibrated: bool,
}

/// What came of it.
#[derive(Debug, Default)]
pub struct Exercise {
    /// Ticks in which chip and host agreed.
    pub agreed: u64,
    /// The running hash over them.
    pub hash: u32,
    /// Where the two went apart.
    pub divergence: Option<Divergence>,
    /// The line that was waited for in vain for a minute.
    pub stuck: Option<String>,
    /// What the ticks cost.
    pub tally: Tally,
    /// Lines carried out, and lines refused, by error number.
    pub lines: usize,
    /// See `lines`.
    pub refused: BTreeMap<String, u32>,
    /// Plans and other commands that the tick took.
    pub commands: u64,
    /// Faults latched.
    pub faults: u32,
    /// Most ticks that the host was behind the chip: how long the chip's command side took to send a command and be done.
    pub behind: u64,
    /// Wall-clock time, s.
    pub wall_s: f64,
}

struct Runner {
    client: Client,
    twin: Twin,
    progress: Progress,
    ticks: u64,
    period_s: f64,
    mode: Mode,
    mended_at: u64,
    patience: Patience,
    exercise: Exercise,
}

/// Periods before the first line: what the image needs to start its interpreter.
const WARM_UP: u64 = 20;
const PROGRESS_EVERY: u64 = 500;
/// Ticks from one broken encoder to the next.
const BREAK_EVERY: u64 = 25_000;
/// Frames that are bridged, and frames that are not.
const FEW: u64 = 4;
const MANY: u64 = 8;

/// Runs an exercise on the image that lies in the target folder.
///
/// # Errors
/// [`ChipError`]; a divergence is part of what comes of it.
pub fn exercise(options: &ExerciseOptions) -> Result<Exercise, ChipError> {
    let path = elf_file::find().ok_or(ChipError::NoImage)?;
    run_image(&path, options)
}

fn run_image(path: &Path, options: &ExerciseOptions) -> Result<Exercise, ChipError> {
    let parameters = machine_parameters(&options.run);
    let mut stage = stage_parameters(&options.run);
    let mut calibration = options.run.told.calibration(&stage);
    if options.calibrated {
        stage = built_stage(&stage);
        calibration = Some(calibration_told(&stage));
    }
    let settings = || {
        with_settings_over(
            &Parameters::REFERENCE,
            SettingsFlash::in_memory(),
            &parameters,
            calibration.as_ref(),
        )
    };
    let stage = Stage::new(&stage);
    let lines = script(options.run.seed, options.ticks).map_err(ChipError::Script)?;
    let mut runner = Some(Runner {
        client: Client::new(&lines),
        twin: Twin::with_settings(&parameters, settings()).with_flip(options.flip),
        progress: Progress::new(options.ticks, options.run.quiet),
        ticks: options.ticks,
        period_s: stage.period_s(),
        mode: Mode::Off,
        mended_at: 0,
        patience: Patience::default(),
        exercise: Exercise::default(),
    });
    let (send, receive) = mpsc::channel();
    let bench = |error| ChipError::Bench(path.to_owned(), error);
    let outcome = Bench::load(path, stage)
        .map_err(bench)?
        .with_settings(settings())
        .run(move |period| {
            let flow = (runner.as_mut()).map_or(Break(()), |runner| runner.period(period));
            if flow.is_break()
                && let Some(runner) = runner.take()
            {
                // Nobody to send to means that the caller has given up.
                let _ = send.send(runner);
            }
            flow
        })
        .map_err(bench)?;
    if !outcome.gaps.is_empty() {
        return Err(ChipError::Gaps(outcome.gaps));
    }
    let runner = receive.try_recv().map_err(|_| ChipError::Lost)?;
    let mut exercise = runner.exercise;
    exercise.wall_s = runner.progress.finish();
    exercise.lines = runner.client.done();
    Ok(exercise)
}

impl Runner {
    fn period(&mut self, period: &mut Period<'_>) -> ControlFlow<()> {
        if let Err(divergence) = self.compare(period) {
            self.exercise.divergence = Some(divergence);
            return Break(());
        }
        if self.exercise.agreed >= self.ticks {
            return Break(());
        }
        let received = period.received();
        if period.tick < WARM_UP {
            return Continue(());
        }
        self.break_an_encoder(period);
        let (mut bytes, event) = self.client.poll(&received, self.mode == Mode::Moving);
        bytes.extend(self.patience.poll(&self.client, self.mode));
        period.send(&bytes);
        self.twin.receive(&bytes);
        if period.tick.is_multiple_of(PROGRESS_EVERY) {
            let simulated_s = period.tick as f64 * self.period_s;
            self.progress.update(self.exercise.agreed, simulated_s);
        }
        match event {
            Some(Event::Refused(_, error)) => {
                *self.exercise.refused.entry(error).or_default() += 1;
            }
            Some(Event::Stuck(line)) => {
                self.exercise.stuck = Some(line.text);
                return Break(());
            }
            Some(Event::Finished) => return Break(()),
            _ => {}
        }
        Continue(())
    }

    fn compare(&mut self, period: &mut Period<'_>) -> Result<(), Divergence> {
        self.twin.look(period)?;
        let now = &mut self.exercise;
        while now.agreed < self.ticks
            && let Some(agreed) = self.twin.catch_up()?
        {
            let Some(sample) = &agreed.record.sample else {
                continue;
            };
            if sample.mode == Mode::Fault && self.mode != Mode::Fault {
                now.faults += 1;
            }
            self.mode = sample.mode;
            let doing = Doing {
                mode: sample.mode,
                commanded: agreed.commanded,
            };
            let line =
                || (self.client.current()).map_or_else(String::new, |line| line.text.clone());
            (now.tally).add(now.agreed, agreed.instructions, doing, line);
            now.commands += u64::from(agreed.commanded);
            now.hash = agreed.record.hash.0;
            now.agreed += 1;
        }
        now.behind = now.behind.max(period.tick - now.agreed);
        Ok(())
    }

    /// Breaks one of the encoders, or mends it.
    fn break_an_encoder(&mut self, period: &mut Period<'_>) {
        let encoder = &mut period.stage.encoders[(period.tick / BREAK_EVERY % 3) as usize];
        if period.tick % BREAK_EVERY == BREAK_EVERY / 2 {
            let at_rest = self.mode == Mode::Holding;
            self.mended_at = period.tick + if at_rest { MANY } else { FEW };
            encoder.set_fault(EncoderFault::ErrorBit);
        } else if period.tick == self.mended_at {
            encoder.set_fault(None);
        }
    }
}

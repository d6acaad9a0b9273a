//! What crosses crates: long scenarios, real clients, target runs.
//!
//! [`Bench`] is the stage as a user has it, one command connection to a controller that runs the simulated machine through
//! its own drivers, with a hand on every part that can be broken.
//!
//! | module | idea |
//! |---|---|
//! | [`calibrated`] | a calibration of a machine as drawn |
//! | [`trouble`] | ways to break a bench |
//! | [`reactions`] | the worst machine, and how each reaction brings it to rest |
//! | [`repeated`] | a way that is repeated, for iterative learning |
//! | [`ideal`] | the controller on a stage without flaws, cheap enough for millions of ticks |
//! | [`fuzz`] | random sessions and settings, and what has to hold whatever is sent |
//! | [`measured`] | `hal-sim/MEASURED.md`: figures with the commands that give them |

pub mod calibrated;
pub mod fuzz;
pub mod ideal;
pub mod measured;
pub mod reactions;
pub mod repeated;
pub mod trouble;

use firmware::control::Outputs;
use firmware::fault::{Fault, FaultKind};
use firmware::gcs::Session;
use firmware::mode::Mode;
use firmware::parameters::Parameters;
use firmware::recorder::Sample;
use hal_sim::machine::devices::{SettingsFlash, StageParameters};
use hal_sim::rig::observer::TickRecord;
use hal_sim::rig::run::{RunOptions, stage_parameters};
use hal_sim::rig::{ControllerMemory, Rig};

/// Encoder counts in 2^-32 turns.
const UNITS_PER_COUNT: i64 = 64;
/// Ticks that anything may take before a test gives up: 200 seconds of the stage's time.
const PATIENCE: u32 = 4_000_000;

/// A simulated stage, its controller, and a connection to it.
pub struct Bench {
    /// Stage and controller: `rig.front` is the machine with the loop.
    pub rig: Rig<'static>,
    /// What the last tick put out.
    pub outputs: Outputs,
    session: Session,
    record: TickRecord,
    answers: Vec<u8>,
    /// Largest following error of a pivot since [`Bench::forget_errors`], encoder counts.
    worst_error_counts: u64,
}

impl Default for Bench {
    fn default() -> Self {
        Self::new(&stage_parameters(&RunOptions::default()))
    }
}

impl Bench {
    /// A stage that has just been switched on.
    #[must_use]
    pub fn new(stage: &StageParameters) -> Self {
        Self::told(stage, &Parameters::REFERENCE)
    }

    /// The same with a controller whose machine comes with these parameters.
    #[must_use]
    pub fn told(stage: &StageParameters, parameters: &Parameters) -> Self {
        // A test has a few of them.
        let memory = ControllerMemory::endless();
        let flash = SettingsFlash::in_memory();
        Self {
            rig: Rig::simulated(memory, stage, parameters, flash),
            outputs: Outputs::default(),
            session: Session::new(),
            record: TickRecord::default(),
            answers: Vec::new(),
            worst_error_counts: 0,
        }
    }

    /// What a reset of the chip leaves: the machine as it is, the controller started anew for this cause, the retained memory.
    pub fn reset(&mut self, cause: &'static str) {
        self.rig.reset(cause);
        self.session = Session::new();
    }

    /// Ends the connection, and makes another one.
    pub fn reconnect(&mut self) {
        self.rig.disconnect(&mut self.session);
        self.session = Session::new();
    }

    /// Referenced, holding and settled.
    ///
    /// # Panics
    /// When referencing fails.
    #[must_use]
    pub fn ready() -> Self {
        let mut bench = Self::default();
        assert_eq!(bench.error_after("FRF"), "0");
        bench.settle();
        bench
    }

    /// One tick, and one turn of the command side.
    pub fn tick(&mut self) {
        self.outputs = self.rig.tick(&mut self.record);
        if matches!(self.mode(), Mode::Holding | Mode::Moving | Mode::Stopping) {
            self.worst_error_counts = self.worst_error_counts.max(self.error_counts());
        }
        // Writing to a vector does not fail.
        let _ = (self.rig).service(&mut self.session, &mut self.answers);
        self.rig.keep();
    }

    /// So many ticks.
    pub fn run(&mut self, ticks: u32) {
        for _ in 0..ticks {
            self.tick();
        }
    }

    /// Ticks until `done`.
    ///
    /// # Panics
    /// When that takes too long.
    pub fn run_until(&mut self, what: &str, mut done: impl FnMut(&Self) -> bool) {
        for _ in 0..PATIENCE {
            if done(self) {
                return;
            }
            self.tick();
        }
        panic!("{what}: not after {PATIENCE} ticks; {:?}", self.fault());
    }

    /// Sends lines, which the next ticks carry out.
    ///
    /// # Panics
    /// When there is no room for them.
    pub fn send(&mut self, text: &str) {
        assert_eq!(self.session.receive(text.as_bytes()), text.len(), "no room");
    }

    /// Sends lines and runs until they are carried out; their answers.
    ///
    /// # Panics
    /// When that takes too long.
    pub fn say(&mut self, text: &str) -> String {
        let mut bytes = text.as_bytes();
        for _ in 0..PATIENCE {
            let taken = self.session.receive(bytes);
            bytes = &bytes[taken..];
            self.tick();
            if bytes.is_empty() && self.session.is_idle() {
                return String::from_utf8_lossy(&std::mem::take(&mut self.answers)).into_owned();
            }
        }
        panic!("{text:?} is not done after {PATIENCE} ticks");
    }

    /// The error that a line leaves.
    pub fn error_after(&mut self, line: &str) -> String {
        self.say(&format!("{line}\nERR?\n")).trim_end().to_owned()
    }

    /// The number that a query of one axis answers.
    ///
    /// # Panics
    /// When it is no number.
    pub fn value(&mut self, query: &str) -> f64 {
        let answer = self.say(&format!("{query}\n"));
        let number = answer.trim_end().split('=').nth(1);
        number
            .and_then(|number| number.parse().ok())
            .unwrap_or_else(|| panic!("{query} answers {answer:?}"))
    }

    /// What condition monitoring has found of a drive last, by `LST?`: motor constant over its parameter, A of the current sensor, N m of friction.
    ///
    /// # Panics
    /// When its line is no three numbers.
    pub fn drive_condition(&mut self, pivot: usize) -> Option<[f64; 3]> {
        let lines = self.say("LST?\n");
        let name = format!("DRIVE{}=", pivot + 1);
        let line = lines.lines().find_map(|line| line.strip_prefix(&name))?;
        let mut numbers = line.split_whitespace().map(str::parse);
        Some([(); 3].map(|()| numbers.next().expect("three").expect("a number")))
    }

    /// Runs until the stage has settled.
    pub fn settle(&mut self) {
        self.say("WAC ONT? W = 1\n");
    }

    /// What the last tick computed.
    ///
    /// # Panics
    /// Before the first tick.
    #[must_use]
    pub fn sample(&self) -> &Sample {
        self.record.sample.as_ref().expect("a tick has run")
    }

    /// Following errors of the pivots in the last tick, encoder counts.
    #[must_use]
    pub fn following_errors(&self) -> [f64; 3] {
        let sample = self.sample();
        [0, 1, 2].map(|i| {
            (sample.pivots[i] - sample.pivot_setpoints[i]).units() as f64 / UNITS_PER_COUNT as f64
        })
    }

    /// Their root mean square over so many ticks.
    pub fn rms_error(&mut self, ticks: u32) -> f64 {
        let mut sum = 0.0;
        for _ in 0..ticks {
            self.tick();
            sum += self
                .following_errors()
                .map(|error| error * error)
                .iter()
                .sum::<f64>();
        }
        (sum / f64::from(3 * ticks)).sqrt()
    }

    /// State of the supervisor.
    #[must_use]
    pub fn mode(&self) -> Mode {
        self.record.sample.as_ref().map_or(Mode::Off, |s| s.mode)
    }

    /// The latched fault.
    #[must_use]
    pub fn fault(&self) -> Option<Fault> {
        self.rig.front.fault()
    }

    /// Its kind.
    #[must_use]
    pub fn fault_kind(&self) -> Option<FaultKind> {
        self.fault().map(|fault| fault.kind)
    }

    /// Hash of all ticks so far.
    #[must_use]
    pub fn hash(&self) -> u32 {
        self.record.hash.0
    }

    /// Starts a new peak of the following error.
    pub fn forget_errors(&mut self) {
        self.worst_error_counts = 0;
    }

    /// Largest following error of a pivot (measured, encoder counts) since then.
    #[must_use]
    pub fn worst_error_counts(&self) -> u64 {
        self.worst_error_counts
    }

    fn error_counts(&self) -> u64 {
        let sample = self.sample();
        let error = |i: usize| {
            (sample.pivots[i] - sample.pivot_setpoints[i])
                .units()
                .unsigned_abs()
        };
        (0..3).map(error).max().unwrap_or_default() / UNITS_PER_COUNT.unsigned_abs()
    }
}

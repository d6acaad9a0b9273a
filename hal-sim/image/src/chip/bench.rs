//! The bench as its callers see it. The board comes commissioned: its flash keeps the settings of the simulated machine.

use super::board::{BoardKind, ChipBoard, STAGE_RATE};
use super::cost::TickCost;
use super::driver::{Landmarks, StageDriver};
use super::gaps;
use super::period::{Period, Reset};
use firmware::parameters::Parameters;
use hal_sim::machine::devices::{SettingsFlash, Stage};
use hal_sim::rig::{with_machine_settings, with_settings_over};
use rigless::emulator::{self, Start, Watch};
use rigless::image::{self, Image};
use rigless::session::Session;
use rigless::symbols::{self, Symbols};
use rigless::time::VirtualNanos;
use std::fmt;
use std::num::NonZeroU64;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Symbols of the image: the handler of the tick, where its cost ends, the record.
pub(super) const TICK_BEGIN: &str = "TIM1_CC";
pub(super) const TICK_END: &str = "stage_tick_end";
pub(super) const HANDLER_END: &str = "stage_handler_end";
const TRACE: &str = "TRACE";
/// Where the image keeps its settings: at the beginning of bank 2.
const SETTINGS_AT: u64 = 0x0810_0000;
/// The number that the maker burns into a chip, and where: here it says what the chip is.
const CHIP_NUMBER: &[u8; 12] = b"emulated F42";
const CHIP_NUMBER_AT: u64 = 0x1FFF_7A10;

/// An image, ready to boot.
pub struct Bench {
    image: Image,
    symbols: Symbols,
    stage: Stage,
    kind: BoardKind,
    instructions_per_second: NonZeroU64,
    has_crystal: bool,
    watchdog_hz: Option<u64>,
    options: Option<u32>,
    flash_kib: Option<u16>,
    converter_supply: Option<f64>,
    /// What the settings' flash holds at the start.
    settings: SettingsFlash,
}

/// What a run leaves behind.
#[derive(Debug)]
pub struct Outcome {
    /// The stage at the end.
    pub stage: Stage,
    /// What the ticks cost.
    pub cost: TickCost,
    /// Restarts.
    pub resets: Vec<Reset>,
    /// Instructions executed.
    pub instructions: u64,
    /// Virtual time, ns.
    pub at_ns: u64,
    /// Accesses that the emulator does not model, beyond those allowed: any one makes the run worthless.
    pub gaps: Vec<String>,
}

/// Why there was no run.
#[derive(Debug)]
pub enum BenchError {
    /// The image could not be read.
    Image(image::Error),
    /// Its symbols could not be read, or one is missing.
    Symbols(symbols::Error),
    /// The emulated part could not be built.
    Part(rigless::soc::Error),
    /// The board could not be set up.
    Board(rigless::soc::Fault),
    /// The emulator gave up.
    Emulator(emulator::Error),
    /// The image did not start its timers within a second.
    NeverStarted {
        /// What it touched that the emulator does not model.
        gaps: Vec<String>,
    },
}

impl Bench {
    /// Reads the image.
    pub fn load(path: &Path, stage: Stage) -> Result<Self, BenchError> {
        Self::new(Image::read(path, None).map_err(BenchError::Image)?, stage)
    }

    /// Takes the image from memory.
    pub fn from_elf(elf: Vec<u8>, stage: Stage) -> Result<Self, BenchError> {
        let name = PathBuf::from("stage");
        Self::new(
            Image::new(&name, elf, None).map_err(BenchError::Image)?,
            stage,
        )
    }

    fn new(image: Image, stage: Stage) -> Result<Self, BenchError> {
        let symbols = Symbols::read(image.bytes(), even).map_err(BenchError::Symbols)?;
        Ok(Self {
            image,
            symbols,
            stage,
            kind: BoardKind::REFERENCE,
            instructions_per_second: STAGE_RATE,
            has_crystal: true,
            watchdog_hz: None,
            options: None,
            flash_kib: None,
            converter_supply: None,
            settings: with_machine_settings(
                SettingsFlash::in_memory(),
                &Parameters::REFERENCE,
                None,
            ),
        })
    }

    /// The same on a chip that executes so many instructions in a second, instead of one a cycle.
    #[must_use]
    pub fn at_rate(self, instructions_per_second: NonZeroU64) -> Self {
        Self {
            instructions_per_second,
            ..self
        }
    }

    /// The same on another board.
    #[must_use]
    pub fn on(self, kind: BoardKind) -> Self {
        Self { kind, ..self }
    }

    /// The same with a crystal that does not start.
    #[must_use]
    pub fn without_crystal(self) -> Self {
        Self {
            has_crystal: false,
            ..self
        }
    }

    /// The same with a watchdog's oscillator of so many Hz, 17,000 to 47,000.
    #[must_use]
    pub fn with_watchdog_hz(self, hz: u64) -> Self {
        Self {
            watchdog_hz: Some(hz),
            ..self
        }
    }

    /// The same with these option bytes, as the chip's register shows them.
    #[must_use]
    pub fn with_options(self, options: u32) -> Self {
        Self {
            options: Some(options),
            ..self
        }
    }

    /// The same on a chip whose manufacturer says that it has so many KiB of flash.
    #[must_use]
    pub fn with_flash_kib(self, flash_kib: u16) -> Self {
        Self {
            flash_kib: Some(flash_kib),
            ..self
        }
    }

    /// The same with a converter supplied with so much of 3.3 V.
    #[must_use]
    pub fn with_converter_supply(self, share: f64) -> Self {
        Self {
            converter_supply: Some(share),
            ..self
        }
    }

    /// The same on a board whose flash keeps the settings of this machine; nothing, if nobody has commissioned it yet.
    #[must_use]
    pub fn commissioned_as(self, parameters: &Parameters) -> Self {
        self.with_settings(with_settings_over(
            &Parameters::REFERENCE,
            SettingsFlash::in_memory(),
            parameters,
            None,
        ))
    }

    /// The same on a board whose flash keeps these settings.
    #[must_use]
    pub fn with_settings(self, settings: SettingsFlash) -> Self {
        Self { settings, ..self }
    }

    /// Address of a symbol of the image, for [`Period::word`].
    pub fn symbol(&self, name: &str) -> Result<u64, BenchError> {
        self.symbols.get(name).map_err(BenchError::Symbols)
    }

    /// Boots the image and runs it, calling back once a control period, until the callback breaks.
    pub fn run<F>(self, on_period: F) -> Result<Outcome, BenchError>
    where
        F: FnMut(&mut Period<'_>) -> ControlFlow<()> + Send + 'static,
    {
        let landmarks = Landmarks {
            tick_begin: self.symbol(TICK_BEGIN)?,
            tick_end: self.symbol(TICK_END)?,
            handler_end: self.symbol(HANDLER_END)?,
            trace: self.symbol(TRACE)?,
        };
        let board = ChipBoard::new(self.kind).map_err(BenchError::Part)?;
        let mut board = board.at_rate(self.instructions_per_second);
        if !self.has_crystal {
            board = board.without_crystal();
        }
        if let Some(flash_kib) = self.flash_kib {
            board = board.with_flash_kib(flash_kib);
        }
        if let Some(share) = self.converter_supply {
            board = board.with_converter_supply(share);
        }
        if let Some(hz) = self.watchdog_hz {
            board = board.with_watchdog_hz(hz);
        }
        if let Some(options) = self.options {
            board = board.with_options(options).map_err(BenchError::Board)?;
        }
        let mut session =
            Session::new(Box::new(board), 0, VirtualNanos(1)).map_err(BenchError::Emulator)?;
        session.watch(Watch::Instruction(landmarks.tick_begin));
        session.watch(Watch::Instruction(landmarks.tick_end));
        session.watch(Watch::Instruction(landmarks.handler_end));
        let driver = StageDriver::new(on_period, self.stage, landmarks);
        let settings = self.settings.bytes().to_vec();
        let settings = Image::new(Path::new("settings"), settings, Some(SETTINGS_AT));
        let number = Image::new(
            Path::new("number"),
            CHIP_NUMBER.to_vec(),
            Some(CHIP_NUMBER_AT),
        );
        let images = [
            self.image,
            settings.map_err(BenchError::Image)?,
            number.map_err(BenchError::Image)?,
        ];
        let finished =
            emulator::run(session, &Start::new(&images), driver).map_err(BenchError::Emulator)?;
        let mut gaps = gaps::unexpected(&finished.session);
        let driver = finished.driver;
        if driver.not_mapped {
            gaps.push(
                "the loop was started without RAM at address 0, where its code is".to_owned(),
            );
        }
        if driver.never_started {
            return Err(BenchError::NeverStarted { gaps });
        }
        let stop = finished.stop;
        Ok(Outcome {
            stage: driver.stage,
            cost: driver.cost,
            resets: driver.resets,
            instructions: stop.map_or(0, |stop| stop.instruction_count),
            at_ns: stop.map_or(0, |stop| stop.at.0),
            gaps,
        })
    }
}

/// A function's symbol has the lowest bit set, which says Thumb and is no part of the address.
fn even(value: u64) -> u64 {
    value & !1
}

impl fmt::Display for BenchError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Image(error) => write!(f, "image: {error}"),
            Self::Symbols(error) => write!(f, "image: {error}"),
            Self::Part(error) => write!(f, "emulated part: {error}"),
            Self::Board(fault) => write!(f, "board: {fault}"),
            Self::Emulator(error) => write!(f, "emulator: {error}"),
            Self::NeverStarted { gaps } => {
                write!(f, "the image did not start its timers within a second")?;
                gaps.iter().try_for_each(|gap| write!(f, "\n  {gap}"))
            }
        }
    }
}

impl std::error::Error for BenchError {}

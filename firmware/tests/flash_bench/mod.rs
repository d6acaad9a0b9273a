//! A flash that loses its power in the middle of a word or of an erase, and a command side whose settings it keeps.
#![allow(dead_code)] // Each test file uses its part.

#[path = "../gcs_bench/mod.rs"]
pub mod gcs_bench;

use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash, check_erase, check_read,
    check_write,
};
use firmware::fault::FaultKind;
use firmware::gcs::{Identity, Interpreter, PARAMETERS};
use firmware::iterative_learning::TrialMemory;
use firmware::parameters::Parameters;
use firmware::settings_store::{SettingsStore, StoreError};
use gcs_bench::Bench;

pub const SECTORS: usize = 4;
const WORD: usize = 4;

/// SplitMix64.
#[derive(Clone)]
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }
}

/// Four sectors of `SECTOR` bytes, erased.
#[derive(Clone)]
pub struct Flash<const SECTOR: usize> {
    pub bytes: Vec<u8>,
    /// Words written and sectors erased so far.
    pub steps: u64,
    /// The step in the middle of which the power fails; nothing happens after it.
    cut: Option<u64>,
    random: Random,
    /// Writing and erasing fail and do nothing, as of a worn sector.
    pub worn: Option<usize>,
    /// Writing does not change this byte.
    pub stuck: Option<usize>,
}

impl<const SECTOR: usize> Flash<SECTOR> {
    pub fn new() -> Self {
        Self {
            bytes: vec![0xFF; SECTORS * SECTOR],
            steps: 0,
            cut: None,
            random: Random(0),
            worn: None,
            stuck: None,
        }
    }

    /// The power will fail in the middle of this step from now, which leaves random bits behind.
    pub fn cut_in(&mut self, step: u64, seed: u64) {
        self.cut = Some(self.steps + step);
        self.random = Random(seed);
    }

    /// As it is when the power comes back.
    pub fn powered(&self) -> Self {
        Self {
            cut: None,
            ..self.clone()
        }
    }

    /// Takes the next step: whether it is done whole, in part or not at all.
    fn step(&mut self) -> Option<bool> {
        let step = self.steps;
        self.steps += 1;
        match self.cut {
            Some(cut) if step > cut => None,
            Some(cut) if step == cut => Some(false),
            _ => Some(true),
        }
    }

    /// Which bits of a byte are changed by a step that is cut off; of all bytes alike nothing, all or any.
    fn torn(&mut self, kind: usize) -> u8 {
        match kind {
            0 => 0,
            1 => 0xFF,
            _ => self.random.bits() as u8,
        }
    }
}

#[derive(Debug)]
pub struct PowerCut;

impl NorFlashError for PowerCut {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

impl<const SECTOR: usize> ErrorType for Flash<SECTOR> {
    type Error = PowerCut;
}

impl<const SECTOR: usize> ReadNorFlash for Flash<SECTOR> {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), PowerCut> {
        check_read(self, offset, bytes.len()).expect("a range of the flash");
        bytes.copy_from_slice(&self.bytes[offset as usize..][..bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.bytes.len()
    }
}

impl<const SECTOR: usize> NorFlash for Flash<SECTOR> {
    const WRITE_SIZE: usize = WORD;
    const ERASE_SIZE: usize = SECTOR;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), PowerCut> {
        check_erase(self, from, to).expect("whole sectors");
        for sector in (from as usize..to as usize).step_by(SECTOR) {
            if self.worn == Some(sector / SECTOR) {
                continue;
            }
            let whole = self.step().ok_or(PowerCut)?;
            let kind = if whole { 1 } else { self.random.below(4) };
            // A cell on its way may read as anything.
            for at in sector..sector + SECTOR {
                let changed = self.torn(kind);
                let noise = if kind == 3 { self.torn(3) } else { 0xFF };
                self.bytes[at] = (self.bytes[at] & !changed) | (noise & changed);
            }
            if !whole {
                return Err(PowerCut);
            }
        }
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), PowerCut> {
        check_write(self, offset, bytes.len()).expect("whole words");
        for (number, word) in bytes.chunks_exact(WORD).enumerate() {
            let at = offset as usize + number * WORD;
            if self.worn == Some(at / SECTOR) {
                continue;
            }
            let whole = self.step().ok_or(PowerCut)?;
            let kind = if whole { 1 } else { self.random.below(3) };
            let free = self.bytes[at..at + WORD].iter().all(|&byte| byte == 0xFF);
            assert!(free, "the word at {at} is written twice");
            for (place, &byte) in (at..).zip(word) {
                let changed = self.torn(kind);
                if self.stuck != Some(place) {
                    self.bytes[place] &= byte | !changed;
                }
            }
            if !whole {
                return Err(PowerCut);
            }
        }
        Ok(())
    }
}

/// Everything that is kept, to be compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Kept {
    pub parameters: Vec<(u32, f64)>,
    pub macros: Vec<(String, String)>,
}

/// What a command side has of it now.
pub fn kept(panel: &Interpreter, parameters: &Parameters) -> Kept {
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
    let mut macros: Vec<_> = (panel.macros())
        .map(|(name, lines)| (name.to_string(), text(lines)))
        .collect();
    macros.sort();
    Kept {
        parameters: (PARAMETERS.iter())
            .filter_map(|p| Some((p.id, p.number(parameters)?)))
            .collect(),
        macros,
    }
}

/// Gives a command side what is stored; tables of repeated moves are left.
pub fn restore<F: NorFlash>(
    keeper: &mut SettingsStore<F>,
    panel: &mut Interpreter,
) -> Option<FaultKind> {
    let mut memory = Box::new(TrialMemory::new());
    keeper.restore(&mut panel.contents(&mut memory.split().0))
}

/// Stores what a command side has besides tables of repeated moves.
pub fn write<F: NorFlash>(
    keeper: &mut SettingsStore<F>,
    panel: &mut Interpreter,
) -> Result<(), StoreError> {
    let mut memory = Box::new(TrialMemory::new());
    keeper.write(&panel.contents(&mut memory.split().0))
}

pub fn fresh() -> Interpreter {
    let identity = Identity {
        serial: "4711",
        version: "0.1.0",
    };
    Interpreter::new(&Parameters::REFERENCE, identity)
}

/// A command side whose settings are kept, with its tick.
pub struct KeptBench<const SECTOR: usize> {
    pub bench: Bench,
    pub keeper: SettingsStore<Flash<SECTOR>>,
}

impl<const SECTOR: usize> KeptBench<SECTOR> {
    /// Started with this flash, referenced.
    pub fn start(flash: Flash<SECTOR>) -> Self {
        let mut panel = fresh();
        let mut keeper = SettingsStore::new(flash);
        assert_eq!(restore(&mut keeper, &mut panel), None);
        let mut bench = Bench::with(panel);
        bench.run(2);
        bench.say("FRF\n");
        bench.run(100);
        Self { bench, keeper }
    }

    /// Sends, keeps what is to be kept, and returns the answers.
    pub fn say(&mut self, bytes: &str) -> String {
        assert!(self.bench.offer(0, bytes.as_bytes()), "no room");
        for _ in 0..6 {
            self.bench.run(1);
            self.keeper.store_pending(&mut self.bench.contents());
        }
        let answers = self.bench.answers_of(0);
        answers.iter().map(|&byte| char::from(byte)).collect()
    }

    /// The error after these lines.
    pub fn error_after(&mut self, lines: &str) -> String {
        self.say(&format!("{lines}\nERR?\n")).trim_end().to_string()
    }

    /// What `RBT` does.
    pub fn restart(self) -> Self {
        Self::start(self.keeper_flash())
    }

    fn keeper_flash(mut self) -> Flash<SECTOR> {
        self.keeper.flash().powered()
    }
}

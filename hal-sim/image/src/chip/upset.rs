//! Upsets: single bits of the chip's RAM that flip while it works, and what the controller makes of each.
//!
//! The image is the unmodified one, the machine the reference stage. A run is compared with the one in which nothing flips: the pins in
//! every period, and where the platform is.

use super::{Bench, ChipError, Period, elf_file};
use hal_sim::machine::devices::{BridgeState, Stage, StageParameters};
use hal_sim::random::Random;
use parallel::of_all;
use std::fmt;
use std::ops::ControlFlow::{self, Break, Continue};
use std::ops::Range;
use std::path::Path;
use std::sync::mpsc::{Sender, channel};

/// What is sent, and when: it is referenced, held, and moved for some 0.4 s.
const LINES: [(u64, &[u8]); 2] = [(20, b"FRF X\n"), (600, b"MOV X 30 Y 10 W 60\n")];
/// The ticks in which a bit flips, and for how long what comes of it is watched: 75 ms.
const FLIPS: Range<u64> = 200..3_000;
const WATCHED: u64 = 1_500;
/// For how long an answer is waited for then. A command side that hangs is reset after half a second.
const ANSWERED: u64 = 12_000;
/// Way of the platform from where it should be that is none, mm.
const NOTHING_MM: f64 = 1e-3;

/// A part of the RAM.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// What lies there.
    pub name: &'static str,
    /// Part of the symbol under which it does.
    symbol: &'static str,
}

/// What is looked at, part by part: what the loop reads in every tick. Not its code and tables, which are compared with their copy in flash, and
/// not the command side's memory, most of which nothing reads for long.
pub const REGIONS: [Region; 3] = [
    Region {
        name: "state of the loop",
        symbol: "local_init_state_place",
    },
    Region {
        name: "constants of the loop",
        symbol: "local_init_config_place",
    },
    Region {
        name: "the tick's ends of queues",
        symbol: "local_resource_tick_queues",
    },
];

/// One bit that flips.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Upset {
    /// All of it comes from this.
    pub seed: u64,
    /// Its place in [`REGIONS`].
    pub region: usize,
    /// Word and bit.
    pub address: u64,
    /// See `address`.
    pub bit: u32,
    /// The tick before which it flips.
    pub tick: u64,
}

/// What has come of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Consequence {
    /// The pins have done what they do without it.
    None,
    /// They have not, but the platform was where it should be.
    Harmless,
    /// A fault is latched: what `FLT?` tells, without its numbers.
    Fault(String),
    /// The chip has been restarted.
    Restart,
    /// The platform was elsewhere, and nobody was told.
    Silent,
}

/// A run with a bit that flips.
#[derive(Clone, Debug, PartialEq)]
pub struct UpsetRun {
    /// What flips.
    pub upset: Upset,
    /// What has come of it.
    pub consequence: Consequence,
    /// How far the platform was from where it is without it, mm, until there was a fault or a restart.
    pub off_mm: f64,
}

/// What a period has to show.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shown {
    pins: [BridgeState; 3],
    place_mm: [f64; 2],
}

/// What a run leaves behind.
#[derive(Clone, Debug, Default)]
struct Seen {
    shown: Vec<Shown>,
    /// What `FLT?` has answered; nothing where nobody has.
    told: String,
    has_reset: bool,
    has_flipped: bool,
}

/// So many upsets, drawn from a seed, the regions in turn; by so many threads.
///
/// # Errors
/// When there was no run that counts.
pub fn upsets(runs: u64, seed: u64, threads: usize) -> Result<Vec<UpsetRun>, ChipError> {
    let path = elf_file::find().ok_or(ChipError::NoImage)?;
    let mut seeds = Random::new(seed);
    let drawn: Vec<_> = (0..runs)
        .map(|run| (run as usize % REGIONS.len(), seeds.bits() >> 16))
        .collect();
    run_all(&path, &drawn, threads)
}

/// The upset of a seed in a region.
///
/// # Errors
/// When there was no run that counts.
pub fn upset(region: usize, seed: u64) -> Result<UpsetRun, ChipError> {
    let path = elf_file::find().ok_or(ChipError::NoImage)?;
    let runs = run_all(&path, &[(region, seed)], 1)?;
    runs.into_iter().next().ok_or(ChipError::Lost)
}

fn run_all(
    path: &Path,
    drawn: &[(usize, u64)],
    threads: usize,
) -> Result<Vec<UpsetRun>, ChipError> {
    let sound = run(path, None)?;
    let places = REGIONS.map(|region| elf_file::place(path, region.symbol));
    of_all(drawn, threads, |&(region, seed)| {
        let place = (places.get(region).cloned().flatten()).ok_or(ChipError::Lost)?;
        let upset = Upset::new(region, &place, seed);
        let seen = run(path, Some(upset))?;
        if !seen.has_flipped {
            return Err(ChipError::Lost);
        }
        Ok(judge(upset, &seen, &sound))
    })
    .into_iter()
    .collect()
}

impl Upset {
    fn new(region: usize, place: &Range<u64>, seed: u64) -> Self {
        let mut random = Random::new(seed);
        let words = (place.end - place.start) / 4;
        Self {
            seed,
            region,
            address: place.start + 4 * u64::from(random.below(words as u32)),
            bit: random.below(32),
            tick: FLIPS.start + u64::from(random.below((FLIPS.end - FLIPS.start) as u32)),
        }
    }
}

fn run(path: &Path, upset: Option<Upset>) -> Result<Seen, ChipError> {
    let no_bench = |error| ChipError::Bench(path.to_owned(), error);
    let stage = Stage::new(&StageParameters::REFERENCE);
    let bench = Bench::load(path, stage).map_err(no_bench)?;
    let (send, receive) = channel();
    let watched = Watched {
        upset,
        last: upset.map_or(FLIPS.end, |upset| upset.tick) + WATCHED,
        seen: Seen::default(),
        send,
    };
    let mut watched = Some(watched);
    bench
        .run(
            move |period| match watched.as_mut().map(|it| it.look(period)) {
                Some(Continue(())) => Continue(()),
                _ => {
                    if let Some(it) = watched.take() {
                        // Whoever waits for it is gone only when the run is over.
                        let _ = it.send.send(it.seen);
                    }
                    Break(())
                }
            },
        )
        .map_err(no_bench)?;
    receive.recv().map_err(|_| ChipError::Lost)
}

/// Looks at a run, period by period.
struct Watched {
    upset: Option<Upset>,
    last: u64,
    seen: Seen,
    send: Sender<Seen>,
}

impl Watched {
    fn look(&mut self, period: &mut Period<'_>) -> ControlFlow<()> {
        let tick = period.tick;
        if !period.resets.is_empty() {
            self.seen.has_reset = true;
            return Break(());
        }
        for (at, line) in LINES {
            if at == tick {
                period.send(line);
            }
        }
        if let Some(upset) = self.upset
            && upset.tick == tick
        {
            let word = period.word(upset.address).unwrap_or_default();
            period.set_word(upset.address, word ^ 1 << upset.bit);
            self.seen.has_flipped = period.word(upset.address) == Some(word ^ 1 << upset.bit);
        }
        if tick <= self.last {
            let [x, y, _] = period.stage.plant.pose();
            self.seen.shown.push(Shown {
                pins: period.pins,
                place_mm: [x * 1e3, y * 1e3],
            });
        }
        if tick == self.last {
            drop(period.received());
            period.send(b"\nFLT?\n");
        } else if tick > self.last {
            let answer = period.received();
            self.seen.told += &String::from_utf8_lossy(&answer);
        }
        let is_answered = self.seen.told.ends_with('\n') && !self.seen.told.ends_with(" \n");
        if is_answered || tick > self.last + ANSWERED {
            return Break(());
        }
        Continue(())
    }
}

/// What `FLT?` answers where there is no fault.
const NO_FAULT: &str = "0 no fault";

fn judge(upset: Upset, seen: &Seen, sound: &Seen) -> UpsetRun {
    let first = seen.told.lines().next().unwrap_or_default();
    let is_fault = !seen.told.is_empty() && !first.starts_with(NO_FAULT);
    // A bridge that is let go or braked for a fault is off its path by right.
    let until = if is_fault || seen.has_reset {
        0
    } else {
        usize::MAX
    };
    let pairs = seen.shown.iter().zip(&sound.shown).take(until);
    let off_mm = pairs
        .map(|(is, was)| {
            let [x, y] = [0, 1].map(|i| is.place_mm[i] - was.place_mm[i]);
            x.hypot(y)
        })
        .fold(0.0, f64::max);
    let same = (seen.shown.iter().zip(&sound.shown)).all(|(is, was)| is.pins == was.pins);
    let consequence = if seen.has_reset {
        Consequence::Restart
    } else if is_fault {
        let end = first.find([',', ':']).unwrap_or(first.len());
        Consequence::Fault(first[..end].trim().to_owned())
    } else if off_mm > NOTHING_MM || seen.told.is_empty() {
        Consequence::Silent
    } else if same {
        Consequence::None
    } else {
        Consequence::Harmless
    };
    UpsetRun {
        upset,
        consequence,
        off_mm,
    }
}

impl fmt::Display for UpsetRun {
    /// A line for somebody who looks at it again.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Upset {
            seed,
            region,
            address,
            bit,
            tick,
        } = self.upset;
        let name = REGIONS.get(region).map_or("", |region| region.name);
        write!(
            f,
            "{}:{seed}: {name}, {address:#x}, bit {bit}, before tick {tick}: ",
            region + 1
        )?;
        match &self.consequence {
            Consequence::None => f.write_str("nothing"),
            Consequence::Harmless => write!(f, "{:.6} mm off", self.off_mm),
            Consequence::Fault(text) => f.write_str(text),
            Consequence::Restart => f.write_str("restarted"),
            Consequence::Silent => write!(f, "{:.4} mm off, and not told", self.off_mm),
        }
    }
}

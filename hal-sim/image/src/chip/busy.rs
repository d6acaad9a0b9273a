//! All that a tick is ever used for, on a chip that is slower than it should be: are deadlines kept?
//!
//! Eight signals are recorded in every tick, targets are streamed at 1 kHz, moves are taken (also in motion) while recording, and
//! settings are written with the servo on. The chip itself counts what comes late.

use super::{Bench, ChipError, TickCost, elf_file};
use hal_sim::machine::devices::{Stage, StageParameters};
use std::f64::consts::TAU;
use std::num::NonZeroU64;
use std::ops::ControlFlow::{Break, Continue};
use std::ops::Range;
use std::sync::mpsc;

/// What a run has shown.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Busy {
    /// What the ticks cost, and when they started and ended.
    pub cost: TickCost,
    /// Commands that ticks have taken; nearly all are plans.
    pub commands: u32,
    /// What the chip has answered at the end.
    pub told: Told,
}

/// The chip's own account.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Told {
    /// Ticks that were late.
    pub late: u64,
    /// Commands that ticks have refused.
    pub refused: u64,
    /// The latest that encoder frames were whole before their tick, cycles.
    pub frame_margin: u64,
    /// Points recorded of each signal.
    pub points: u64,
    /// The fault, in words.
    pub fault: String,
    /// Errors that lines were answered with.
    pub errors: Vec<u64>,
}

/// Lines, and the tick before which they are sent.
const LINES: [(u64, &[u8]); 9] = [
    (150, b"FRF X\n"),
    (1_000, b"MOV X -30 Y 35\n"),
    (
        12_000,
        b"SPA 1 0x19001900 1\nSCT T 1\nRTR 1\nDRC 1 X 1 2 X 2 3 X 3 4 Y 1 5 Y 2 6 W 1 7 1 73 8 0 204\n",
    ),
    // From the first target on.
    (12_400, b"DRT 0 4 0\n"),
    (16_000, b"SPA 1 0x19001900 0\nERR?\n"),
    (16_500, b"DRT 0 4 0\nMOV X 40 Y 20 W 90\n"),
    // New targets in motion.
    (17_500, b"MOV X 10 Y 40 W 0\n"),
    (18_200, b"MOV X -10 Y 20 W 45\n"),
    (28_000, b"DRT 0 4 0\nWPA 100\nERR?\n"),
];
/// Streamed targets: one every 20 ticks on a circle that begins and ends where the stage is.
const STREAM: Range<u64> = 12_500..14_500;
const STREAM_EVERY: u64 = 20;
const STREAM_START: [f64; 2] = [-30.0, 35.0];
const STREAM_RADIUS_MM: f64 = 1.0;
/// The last questions, one after the other, and when the last answer is there at any speed.
const ASKED: u64 = 32_000;
const QUESTIONS: &[u8] = b"ERR?\nDRL? 1\nLST?\nFLT?\n";
const END: u64 = 34_000;

/// Runs all of it on a chip that executes so many instructions in a second.
///
/// # Errors
/// When there was no run that counts.
pub fn busy(instructions_per_second: NonZeroU64) -> Result<Busy, ChipError> {
    let path = elf_file::find().ok_or(ChipError::NoImage)?;
    let no_bench = |error| ChipError::Bench(path.clone(), error);
    let stage = Stage::new(&StageParameters::REFERENCE);
    let bench = Bench::load(&path, stage).map_err(no_bench)?;
    let mut answers = Vec::new();
    let (tell, told) = mpsc::channel();
    let run = bench.at_rate(instructions_per_second).run(move |period| {
        for (at, line) in LINES {
            if period.tick == at {
                period.send(line);
            }
        }
        if STREAM.contains(&period.tick) && period.tick.is_multiple_of(STREAM_EVERY) {
            period.send(target(period.tick).as_bytes());
        }
        answers.extend(period.received());
        if period.tick == ASKED {
            period.send(QUESTIONS);
        }
        if period.tick < END {
            return Continue(());
        }
        let commands = period.trace().commands;
        // Nobody is left to be told when the other side is gone.
        let _ = tell.send((std::mem::take(&mut answers), commands));
        Break(())
    });
    let outcome = run.map_err(no_bench)?;
    if !outcome.gaps.is_empty() {
        return Err(ChipError::Gaps(outcome.gaps));
    }
    let (answers, commands) = told.recv().map_err(|_| ChipError::Lost)?;
    Ok(Busy {
        cost: outcome.cost,
        commands,
        told: Told::read(&String::from_utf8_lossy(&answers)),
    })
}

/// The target of this tick's line.
fn target(tick: u64) -> String {
    let done = (tick - STREAM.start) as f64 / (STREAM.end - STREAM.start) as f64;
    let (sine, cosine) = (TAU * done).sin_cos();
    let [x, y] = STREAM_START;
    let x = x + STREAM_RADIUS_MM * (1.0 - cosine);
    let y = y + STREAM_RADIUS_MM * sine;
    format!("MOV X {x:.6} Y {y:.6}\n")
}

impl Told {
    fn read(answers: &str) -> Self {
        let number = |name: &str| {
            let mut lines = answers.lines();
            let value = lines.find_map(|line| line.trim().strip_prefix(name)?.parse().ok());
            value.unwrap_or(u64::MAX)
        };
        Self {
            late: number("LATE="),
            refused: number("REFUSED="),
            frame_margin: number("FRAME_MARGIN="),
            points: number("1="),
            // The last answer's first line.
            fault: answers
                .lines()
                .skip_while(|line| !line.starts_with("LOOSENED="))
                .nth(1)
                .unwrap_or_default()
                .trim()
                .to_owned(),
            errors: answers
                .lines()
                .map_while(|line| line.trim().parse().ok())
                .collect(),
        }
    }
}

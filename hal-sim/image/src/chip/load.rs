//! The control loop under all the load that the command side can make: when does the tick start, and how deep is the stack?
//!
//! A host that waits for nothing fills the serial line, 921,600 baud, in both directions: targets in the middle of motion,
//! parameters that are refused there, records that are made and read out, questions. What comes in while an answer goes out is
//! more than the receiving buffer holds, so that bytes are lost and half lines arrive as well.

use super::{Bench, ChipError, Period, TickCost, elf_file};
use hal_sim::machine::devices::{Stage, StageParameters};
use std::num::NonZeroU64;
use std::ops::ControlFlow::{Break, Continue};
use std::ops::Range;
use std::sync::mpsc;

/// What a run under load has shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Load {
    /// What the ticks cost, and when they started.
    pub cost: TickCost,
    /// Bytes that went over the line, to the chip and from it.
    pub bytes: [u64; 2],
    /// Parameters refused because the stage was in motion, as far as it was asked.
    pub refused: u64,
    /// Bytes of the stack that something was ever written to.
    pub stack: u64,
}

/// Ticks before the load begins.
const WARM_UP: u64 = 400;
/// Ticks from target to target.
const RETARGET: u64 = 1_500;
/// Bytes that always wait to be sent.
const BACKLOG: usize = 64;
const TARGETS: [&[u8]; 4] = [
    b"MOV X 40 Y 0 W 180\n",
    b"MOV X -30 Y 35 W -90\n",
    b"MOV X 0 Y -50 W 0\n",
    b"MOV X 20 Y 20 W 270\n",
];
const REFUSED: &[u8] = b"\n53\n";
const FLOOD: [&[u8]; 8] = [
    b"SPA 1 0x54500100 150\n",
    b"ERR?\n",
    b"POS?\n",
    b"LST?\n",
    b"DRR? 1 40\n",
    b"FLT?\n",
    b"SPA 1 0x54500100 150\n",
    b"ERR?\n",
];
/// Symbols of the image: the ends of the stack's memory, the lower one first.
const STACK: [&str; 2] = ["_stack_end", "_stack_start"];

/// Runs so many ticks on a chip that executes so many instructions in a second.
///
/// # Errors
/// When there was no run that counts.
pub fn load(ticks: u64, instructions_per_second: NonZeroU64) -> Result<Load, ChipError> {
    let path = elf_file::find().ok_or(ChipError::NoImage)?;
    let no_bench = |error| ChipError::Bench(path.clone(), error);
    let stage = Stage::new(&StageParameters::REFERENCE);
    let bench = Bench::load(&path, stage).map_err(no_bench)?;
    let end = |name| bench.symbol(name).map_err(no_bench);
    let memory = end(STACK[0])?..end(STACK[1])?;
    let mut flood = FLOOD.iter().cycle();
    let mut targets = TARGETS.iter().cycle();
    let mut seen = Load::default();
    let mut answers = Vec::new();
    let (tell, told) = mpsc::channel();
    let run = bench.at_rate(instructions_per_second).run(move |period| {
        let mut send = |period: &mut Period<'_>, line: &[u8]| {
            seen.bytes[0] += line.len() as u64;
            period.send(line);
        };
        match period.tick {
            20 => send(period, b"FRF X\n"),
            100 => send(period, b"RTR 1\nDRC 1 X 1 2 Y 1 3 W 1 4 1 70\nDRT 0 1 0\n"),
            tick if tick >= WARM_UP => {
                if tick % RETARGET == WARM_UP {
                    send(period, targets.next().unwrap_or(&TARGETS[0]));
                }
                while period.unsent() < BACKLOG {
                    send(period, flood.next().unwrap_or(&FLOOD[0]));
                }
            }
            _ => {}
        }
        let received = period.received();
        seen.bytes[1] += received.len() as u64;
        answers.extend(received);
        if period.tick < ticks {
            return Continue(());
        }
        seen.refused = (answers.windows(REFUSED.len()))
            .filter(|it| *it == REFUSED)
            .count() as u64;
        seen.stack = stack(period, &memory);
        // Nobody is left to be told when the other side is gone.
        let _ = tell.send(seen);
        Break(())
    });
    let outcome = run.map_err(no_bench)?;
    if !outcome.gaps.is_empty() {
        return Err(ChipError::Gaps(outcome.gaps));
    }
    let seen = told.recv().map_err(|_| ChipError::Lost)?;
    Ok(Load {
        cost: outcome.cost,
        ..seen
    })
}

/// From the lowest word that is not what the memory held at first to its end.
fn stack(period: &mut Period<'_>, memory: &Range<u64>) -> u64 {
    let mut words = memory.clone().step_by(4);
    let lowest = words.find(|at| period.word(*at).is_some_and(|word| word != 0));
    memory.end - lowest.unwrap_or(memory.end)
}

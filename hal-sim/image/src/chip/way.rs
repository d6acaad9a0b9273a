//! One tick, followed instruction by instruction.

use super::bench::{TICK_BEGIN, TICK_END};
use super::{Bench, ChipError, elf_file};
use crate::proof::{Decoded, listing};
use hal_sim::machine::devices::{Stage, StageParameters};
use std::collections::BTreeMap;
use std::ops::ControlFlow::{Break, Continue};
use std::sync::mpsc;

/// Lines that bring the stage into motion, and the ticks at which they are sent.
const LINES: [(u64, &[u8]); 2] = [(20, b"FRF X\n"), (100, b"MOV X 40 Y 20 W 90\n")];

/// The instructions of a tick in the order in which they ran, with their addresses.
pub type Way = Vec<(u64, Decoded)>;

/// Follows a tick on the image in the target folder: tick 400 and some after are in the middle of a move.
///
/// # Errors
/// When there was no run that counts.
pub fn follow(tick: u64) -> Result<Way, ChipError> {
    let path = elf_file::find().ok_or(ChipError::NoImage)?;
    let no_bench = |error| ChipError::Bench(path.clone(), error);
    let known =
        listing(&path, TICK_BEGIN).map_err(|error| ChipError::Proof(path.clone(), error))?;
    let bench = Bench::load(&path, Stage::new(&StageParameters::REFERENCE)).map_err(no_bench)?;
    let [begin, end] = [TICK_BEGIN, TICK_END].map(|name| bench.symbol(name));
    let (begin, end) = (begin.map_err(no_bench)?, end.map_err(no_bench)?);
    let watched: Vec<u64> = known.keys().copied().collect();
    let (tell, told) = mpsc::channel();
    let run = bench.run(move |period| {
        for (at, line) in LINES {
            if period.tick == at {
                period.send(line);
            }
        }
        if period.tick == tick {
            // What can not be watched would be missed, and the count would tell.
            for at in &watched {
                period.watch(*at);
            }
        }
        if period.tick <= tick {
            return Continue(());
        }
        // Nobody is left to be told when the other side is gone.
        let _ = tell.send((period.path.to_vec(), period.cost.last));
        Break(())
    });
    run.map_err(no_bench)?;
    let (path_taken, counted) = told.recv().map_err(|_| ChipError::Lost)?;
    let way = between(&path_taken, begin, end, &known);
    if way.len() as u64 == counted {
        Ok(way)
    } else {
        Err(ChipError::Lost)
    }
}

fn between(path: &[u64], begin: u64, end: u64, known: &BTreeMap<u64, Decoded>) -> Way {
    let tick = path.iter().skip_while(|at| **at != begin);
    let tick = tick.take_while(|at| **at != end);
    let with = |at: &u64| known.get(at).map(|decoded| (*at, decoded.clone()));
    tick.filter_map(with).collect()
}

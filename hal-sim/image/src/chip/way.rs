//! One tick, followed instruction by instruction.

use super::follow::Step;
use super::{Bench, ChipError, bench, elf_file};
use crate::cycles::Program;
use hal_sim::machine::devices::{Stage, StageParameters};
use std::ops::ControlFlow::{Break, Continue};
use std::sync::{Arc, mpsc};

/// Lines that bring the stage into motion, and the ticks at which they are sent.
const LINES: [(u64, &[u8]); 2] = [(20, b"FRF X\n"), (100, b"MOV X 40 Y 20 W 90\n")];

/// A tick of the image in the target folder: 400 and some after are in the middle of a move. And the program that it is of.
///
/// # Errors
/// When there was no run that counts.
pub fn follow(tick: u64) -> Result<(Arc<Program>, Vec<Step>), ChipError> {
    let path = elf_file::find().ok_or(ChipError::NoImage)?;
    let no_bench = |error| ChipError::Bench(path.clone(), error);
    let program = Program::read(&path, bench::TICK_BEGIN);
    let program = Arc::new(program.map_err(|error| ChipError::Proof(path.clone(), error))?);
    let followed = Arc::clone(&program);
    let bench = Bench::load(&path, Stage::new(&StageParameters::REFERENCE)).map_err(no_bench)?;
    let (tell, told) = mpsc::channel();
    let run = bench.run(move |period| {
        for (at, line) in LINES {
            if period.tick == at {
                period.send(line);
            }
        }
        if period.tick == tick && !period.follow(Some(&followed)) {
            return Break(());
        }
        if period.tick <= tick {
            return Continue(());
        }
        let counted = period.cost.last;
        let steps = period.steps().filter(|steps| steps.len() as u64 == counted);
        if let Some(steps) = steps {
            // Nobody is left to be told when the other side is gone.
            let _ = tell.send(steps.to_vec());
        }
        Break(())
    });
    run.map_err(no_bench)?;
    let steps = told.recv().map_err(|_| ChipError::Lost)?;
    Ok((program, steps))
}

//! `cargo chip-tick`: where the instructions of one tick go.

use std::collections::BTreeMap;
use std::process::ExitCode;

use super::arguments::ChipTick;
use super::error::CliError;
use super::place::{lines, place};
use crate::chip::{ChipError, elf_file, estimate, follow};

pub(super) fn run(arguments: &ChipTick) -> Result<ExitCode, CliError> {
    let (program, steps) = follow(arguments.tick)?;
    let lines = lines(&elf_file::find().ok_or(ChipError::NoImage)?)?;
    let mut places: BTreeMap<String, usize> = BTreeMap::new();
    for step in &steps {
        *places
            .entry(place(&lines, step.at, arguments.by))
            .or_default() += 1;
    }
    let mut places: Vec<_> = places.into_iter().collect();
    places.sort_by_key(|(_, instructions)| std::cmp::Reverse(*instructions));
    println!(
        "tick {}, instructions by where they are written",
        arguments.tick
    );
    for (name, instructions) in &places {
        println!("{instructions:>7}  {name}");
    }
    println!("{:>7}  all", steps.len());
    match estimate(&program, &steps) {
        Ok(estimate) => println!(
            "{:>7}  cycles by llvm-mca, {:.2} an instruction, no wait states, no refills after jumps",
            estimate.cycles,
            estimate.cycles as f64 / estimate.instructions as f64
        ),
        Err(reason) => println!("no estimate of cycles: {reason}"),
    }
    Ok(ExitCode::SUCCESS)
}

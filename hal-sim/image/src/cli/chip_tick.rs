//! `cargo chip-tick`: where the instructions of one tick go.

use std::collections::BTreeMap;
use std::process::ExitCode;

use addr2line::Loader;

use super::arguments::{ChipTick, Place};
use super::error::CliError;
use crate::chip::{elf_file, estimate, follow};

/// Parts of the path of a file of ours: what stands before them is of the machine it was built on.
const CRATES: [&str; 2] = ["firmware/src/", "kinematics/src/"];
/// What is none of ours: the compiler's library, and what it is called for is not known.
const OTHER: &str = "libraries";

pub(super) fn run(arguments: &ChipTick) -> Result<ExitCode, CliError> {
    let way = follow(arguments.tick).map_err(|error| CliError::Value(error.to_string()))?;
    let bad = |error: &dyn std::fmt::Display| CliError::Value(error.to_string());
    let image = elf_file::find().ok_or_else(|| bad(&"no image"))?;
    let lines = Loader::new(image).map_err(|error| bad(&error))?;
    let mut places: BTreeMap<String, usize> = BTreeMap::new();
    for (at, _) in &way {
        *places.entry(place(&lines, *at, arguments.by)).or_default() += 1;
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
    println!("{:>7}  all", way.len());
    match estimate(&way) {
        Ok(estimate) => println!(
            "{:>7}  cycles by llvm-mca, {:.2} an instruction, no wait states, no refills after jumps",
            estimate.cycles,
            estimate.cycles as f64 / estimate.instructions as f64
        ),
        Err(reason) => println!("no estimate of cycles: {reason}"),
    }
    Ok(ExitCode::SUCCESS)
}

/// Where of ours an instruction comes from, the innermost place.
fn place(lines: &Loader, at: u64, by: Place) -> String {
    let Ok(mut frames) = lines.find_frames(at) else {
        return OTHER.to_owned();
    };
    while let Ok(Some(frame)) = frames.next() {
        let Some((file, line)) = frame.location.and_then(|it| Some((it.file?, it.line))) else {
            continue;
        };
        let Some(start) = CRATES.iter().find_map(|name| file.find(name)) else {
            continue;
        };
        let file = &file[start..];
        let function = frame.function.as_ref().and_then(|it| it.demangle().ok());
        return match (by, function, line) {
            // Without what it is generic over, which may be many lines.
            (Place::Function, Some(function), _) => {
                let name = function
                    .split_once('<')
                    .map_or(&*function, |(name, _)| name);
                format!("{file} {name}")
            }
            (Place::Line, _, Some(line)) => format!("{file}:{line}"),
            _ => file.to_owned(),
        };
    }
    OTHER.to_owned()
}

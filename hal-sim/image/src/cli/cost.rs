//! `cargo cost`: what parts of the library cost on the chip, in instructions counted on the emulated one, and what the
//! image takes.

use std::path::Path;
use std::process::ExitCode;

use super::arguments::CostRun;
use super::error::CliError;
use crate::chip::elf_file;
use crate::cost::{Counted, Figures, Growth, Order, Sizes, count, print, print_sizes};
use crate::proof::{Code, NESTING, Stack, print_stack};

/// Unless told otherwise.
const STATES: u32 = 300;

pub(super) fn run(arguments: &CostRun) -> Result<ExitCode, CliError> {
    let path = &arguments.figures;
    let kept = arguments.check.then(|| Figures::read(path)).transpose()?;
    let states = match (&kept, arguments.states) {
        (Some(kept), _) => kept.states,
        (None, states) => states.unwrap_or(STATES),
    };
    let counted = count(
        &Order {
            states,
            seed: arguments.seed,
            only: arguments.only.clone(),
        },
        arguments.quiet,
    )?;
    print!("{}", print(&counted.parts));
    println!("{:.0} s of wall clock\n", counted.wall_s);
    if !arguments.only.is_empty() {
        return Ok(ExitCode::SUCCESS);
    }
    let Some(sizes) = sizes()? else {
        println!("no sizes: `cargo stage` builds the image");
        return Ok(ExitCode::SUCCESS);
    };
    println!("{}", print_sizes(&sizes));
    print!("{}", stack()?);
    figures(arguments, path, kept.as_ref(), states, &counted, &sizes)?;
    Ok(ExitCode::SUCCESS)
}

fn sizes() -> Result<Option<Sizes>, CliError> {
    let Some(path) = elf_file::find() else {
        return Ok(None);
    };
    let sizes = Sizes::read(&path)
        .map_err(|error| CliError::Value(format!("{}: {error}", path.display())))?;
    Ok(Some(sizes))
}

/// The deepest stack that the image can have.
fn stack() -> Result<String, CliError> {
    let Some(path) = elf_file::find() else {
        return Ok(String::new());
    };
    let code = Code::read(&path)?;
    Ok(print_stack(&code, &Stack::of(&code, NESTING)?))
}

/// Writes the figures, or compares with those kept.
fn figures(
    arguments: &CostRun,
    path: &Path,
    kept: Option<&Figures>,
    states: u32,
    counted: &Counted,
    sizes: &Sizes,
) -> Result<(), CliError> {
    let now = Figures::new(states, &counted.parts, sizes);
    if arguments.write {
        now.write(path)?;
        println!(
            "figures written: {}",
            path.canonicalize().as_deref().unwrap_or(path).display()
        );
    }
    let Some(kept) = kept else { return Ok(()) };
    let growth = kept.growth(&now);
    if growth.is_empty() {
        println!("no part has grown");
        return Ok(());
    }
    let lines: Vec<String> = growth.iter().map(Growth::to_string).collect();
    Err(CliError::Grown(format!(
        "figures of {}, now {}:\n  {}\nwhere that is meant to be, `cargo cost --write` keeps the new ones",
        kept.compiler,
        now.compiler,
        lines.join("\n  ")
    )))
}

//! `cargo chip-cycles`: what a tick takes in cycles, by what it is used for.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::ExitCode;

use super::arguments::{ChipCycles, Place};
use super::error::CliError;
use super::place::{lines, place};
use crate::chip::{ChipError, Use, Used, elf_file, estimate, uses};
use crate::cycles::{
    Cycles, Setting, Tallies, Tally, limits, modelled_by_schedule, over, print_cycles, print_kinds,
    print_places, read_limits, write_limits,
};

/// Where the image tells from its interrupt on how many cycles its deadline is.
const DEADLINE: &str = "stage_deadline_cycles";
/// And its period.
const PERIOD: &str = "stage_period_cycles";
/// How far model and `llvm-mca` may be apart.
const APART: f64 = 0.02;

pub(super) fn run(arguments: &ChipCycles) -> Result<ExitCode, CliError> {
    let image = elf_file::find().ok_or(ChipError::NoImage)?;
    let symbol = |name: &str| {
        let value = elf_file::symbol(&image, name);
        value.ok_or_else(|| CliError::Value(format!("{}: no symbol {name}", image.display())))
    };
    let (deadline, period) = (symbol(DEADLINE)?, symbol(PERIOD)?);
    let kept = arguments
        .check
        .then(|| read_limits(&arguments.limits))
        .transpose()?;
    let used = uses(arguments.ticks)?;
    let tallies = Tallies {
        without: Tally::of(&used, Setting::WITHOUT_WAIT_STATES),
        guesses: Setting::ALL.map(|setting| Tally::of(&used, setting)),
    };
    println!("{}", print_cycles(&tallies, deadline, period));
    let nominal = tallies.nominal();
    for row in nominal.rows.iter().filter(|row| row.used == Use::Moving) {
        println!("{}", print_kinds(row));
    }
    print_top(nominal, &image, arguments.top)?;
    let apart = beside_llvm_mca(&used)?;
    if arguments.write {
        write_limits(&arguments.limits, &limits(nominal, deadline))?;
    }
    let mut found = kept.map_or_else(Vec::new, |kept| over(nominal, &kept));
    if arguments.check && apart.is_some_and(|apart| apart.abs() > APART) {
        found.push("the model is not what llvm-mca has".to_owned());
    }
    let pessimistic = &tallies.guesses[2];
    for row in pessimistic.rows.iter().filter(|row| row.whole > period) {
        found.push(format!(
            "{}: all that a tick does takes {} cycles pessimistically, a period has {period}",
            row.name(),
            row.whole
        ));
    }
    if let Some(at) = used.flash_read() {
        found.push(format!(
            "the instruction at {at:#010x} has loaded from flash in a tick"
        ));
    }
    if !tallies.are_in_order() {
        found.push("the guesses at the chip are not in order".to_owned());
    }
    if found.is_empty() {
        return Ok(ExitCode::SUCCESS);
    }
    let hint = "where that is meant to be, `cargo chip-cycles --write` keeps new limits";
    Err(CliError::Grown(format!("{}\n{hint}", found.join("\n"))))
}

/// What the files take, and the functions and the lines that wait most.
fn print_top(nominal: &Tally, image: &Path, top: usize) -> Result<(), CliError> {
    let lines = lines(image)?;
    let ticks = nominal.rows.iter().find(|row| row.used == Use::Moving);
    let ticks = ticks.map_or(0, |row| row.cycles.len());
    for (by, title, of) in [
        (
            Place::File,
            "files that take most, moving, nominal",
            Cycles::all as fn(&Cycles) -> u64,
        ),
        (
            Place::Function,
            "functions that wait most, moving, nominal",
            Cycles::stalls,
        ),
        (Place::Line, "lines that wait most", Cycles::stalls),
    ] {
        let mut places: BTreeMap<String, Cycles> = BTreeMap::new();
        for (at, cycles) in &nominal.places {
            places
                .entry(place(&lines, *at, by))
                .or_default()
                .add(cycles);
        }
        let mut places: Vec<_> = places.into_iter().collect();
        places.sort_by_key(|(_, cycles)| std::cmp::Reverse(of(cycles)));
        places.truncate(top);
        println!("{}", print_places(title, &places, ticks));
    }
    Ok(())
}

/// Ticks that are compared with `llvm-mca`: one of each of the slots in which pivots are inspected.
const COMPARED: usize = 4;

/// The last ticks in motion by the model and by `llvm-mca`: how far apart they are, if that is installed.
fn beside_llvm_mca(used: &Used) -> Result<Option<f64>, CliError> {
    let moving = used.ticks.iter().filter(|tick| tick.used == Use::Moving);
    let (mut ours, mut transfers, mut theirs) = (0, 0, 0);
    for tick in moving.rev().take(COMPARED) {
        let [cycles, beyond] = modelled_by_schedule(used, tick);
        (ours, transfers) = (ours + cycles, transfers + beyond);
        match estimate(&used.program, &tick.steps) {
            Ok(estimated) => theirs += estimated.cycles,
            Err(reason) => {
                println!("not compared with llvm-mca: {reason}");
                return Ok(None);
            }
        }
    }
    if theirs == 0 {
        return Err(ChipError::Lost.into());
    }
    let apart = ours as f64 / theirs as f64 - 1.0;
    println!(
        "{COMPARED} whole ticks in motion without wait states, refills, peripherals and entry, each load and store one cycle: \
         {ours} cycles, {theirs} by llvm-mca, {:+.1} %; what ARM's table has more for loads and stores: {transfers}",
        100.0 * apart
    );
    Ok(Some(apart))
}

//! `cargo chip`: a script on the emulated chip, beside the same on the host.

use std::path::PathBuf;
use std::process::ExitCode;

use super::arguments::ChipRun;
use super::error::CliError;
use super::period::PERIOD_INSTRUCTIONS;
use crate::chip::{self, ChipOutcome};
use drawing::claim_folder;
use hal_sim::report::{FILES, Run};
use hal_sim::rig::run::{self, RunOutcome};
use hal_sim::rig::script::Script;
use tripivot::cli::VERSION;
use tripivot::cli::stage::options;

pub(super) fn run(arguments: &ChipRun) -> Result<ExitCode, CliError> {
    if let Some(ticks) = arguments.ticks {
        return super::exercise::run(ticks, arguments);
    }
    let script = match &arguments.file {
        Some(file) => Script::read(file)?,
        None => Script::demonstration()?,
    };
    let name = PathBuf::from(&script.name);
    let stem = name
        .file_stem()
        .unwrap_or(name.as_os_str())
        .to_string_lossy();
    let options = options(&format!("chip-{stem}"), &arguments.simulation)?;
    claim_folder(&options.out, &FILES)?;
    let mut on_chip = chip::run(&script, &options)?;
    on_chip.run.conditions.program = format!("image {VERSION}");
    let on_host = run::run(&script, &options);
    for (line, answer) in &on_chip.answers {
        println!("{line}\n{answer}\n");
    }
    print!("{}", on_chip.run.summary());
    beside(&on_chip, &on_host);
    on_chip.run.write(&options.out)?;
    println!("{:<22}{}", "trace and report in", options.out.display());
    match on_chip.fault {
        Some(fault) => Err(CliError::Fault(fault)),
        None => Ok(ExitCode::SUCCESS),
    }
}

/// What only a chip has to tell, and the comparison with the host.
fn beside(on_chip: &ChipOutcome, on_host: &RunOutcome) {
    let cost = &on_chip.cost;
    println!();
    println!("emulated chip");
    println!(
        "  tick, instructions  {:>10.1} mean  {:>6} worst (tick {})",
        cost.mean(),
        cost.worst,
        cost.worst_tick
    );
    let share = |cycles: f64| 100.0 * cost.worst as f64 * cycles / PERIOD_INSTRUCTIONS;
    println!(
        "  worst, of the period {:>9.1} %  {:.1} %  {:.1} % at 1.0, 1.2 and 1.68 cycles an instruction",
        share(1.0),
        share(1.2),
        share(1.68)
    );
    println!(
        "  ticks the same to the bit on the host {:>10}, running hash {:08x}",
        on_chip.agreed, on_chip.hash
    );
    println!();
    println!("{:<24}{:>14}{:>14}", "beside the host run", "chip", "host");
    let row = |what: &str, value: fn(&Run) -> f64, unit: &str| {
        println!(
            "  {what:<22}{:>14.4}{:>14.4}  {unit}",
            value(&on_chip.run),
            value(&on_host.run)
        );
    };
    row(
        "rms true error, centre",
        |run| run.trace.statistics().moving.truth.xy_um.rms(),
        "um",
    );
    row(
        "rms true error, theta",
        |run| run.trace.statistics().moving.truth.theta_urad.rms(),
        "urad",
    );
    row("last x", |run| last(run, 0), "mm");
    row("last y", |run| last(run, 1), "mm");
    row("last theta", |run| last(run, 2), "deg");
}

fn last(run: &Run, axis: usize) -> f64 {
    run.trace
        .last()
        .map_or(f64::NAN, |sample| sample.pose[axis])
}

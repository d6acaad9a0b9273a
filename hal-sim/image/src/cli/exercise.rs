//! `cargo chip --ticks`: demanding motion from a seed, chip and host compared at every tick, and what the ticks cost.

use std::process::ExitCode;

use super::arguments::ChipRun;
use super::error::CliError;
use super::period::PERIOD_INSTRUCTIONS;
use crate::chip::{self, Cost, Exercise, ExerciseOptions};
use tripivot::cli::stage::options;

pub(super) fn run(ticks: u64, arguments: &ChipRun) -> Result<ExitCode, CliError> {
    let options = ExerciseOptions {
        ticks,
        run: options("exercise", &arguments.simulation)?,
        flip: arguments.flip,
        calibrated: arguments.calibrated,
    };
    let seed = options.run.seed;
    println!("seed {seed}");
    let exercise = chip::exercise(&options)?;
    print(&exercise);
    if let Some(divergence) = exercise.divergence {
        return Err(CliError::Fault(format!(
            "chip and host differ: {divergence}"
        )));
    }
    if exercise.agreed < ticks {
        let line = exercise.stuck.as_deref().unwrap_or("its last line");
        return Err(CliError::Fault(format!(
            "the exercise of seed {seed} ended at {line}, before its ticks were done"
        )));
    }
    Ok(ExitCode::SUCCESS)
}

fn print(exercise: &Exercise) {
    println!(
        "ticks the same to the bit on chip and host: {}, running hash {:08x}",
        exercise.agreed, exercise.hash
    );
    let refused: Vec<String> = (exercise.refused.iter())
        .map(|(error, count)| format!("{count} with error {error}"))
        .collect();
    println!(
        "{} lines, refused of them: {}",
        exercise.lines,
        if refused.is_empty() {
            "none".to_owned()
        } else {
            refused.join(", ")
        }
    );
    println!(
        "{} commands taken by the tick, {} faults latched; the host {} ticks behind the chip at most",
        exercise.commands, exercise.faults, exercise.behind
    );
    println!();
    println!(
        "{:<34}{:>10}{:>10}{:>8}",
        "ticks, instructions", "ticks", "mean", "worst"
    );
    for (doing, cost) in exercise.tally.by_doing() {
        row(doing.words(), &cost);
    }
    row("all", &exercise.tally.all());
    if let Some(worst) = &exercise.tally.worst {
        println!();
        println!(
            "worst: tick {}, {}, at the line \"{}\"",
            worst.tick,
            worst.doing.words(),
            worst.line
        );
        let share = |cycles: f64| 100.0 * worst.instructions as f64 * cycles / PERIOD_INSTRUCTIONS;
        println!(
            "share of the period {:.1} %  {:.1} %  {:.1} % at 1.0, 1.2 and 1.68 cycles an instruction",
            share(1.0),
            share(1.2),
            share(1.68)
        );
    }
    println!("{:.0} s", exercise.wall_s);
}

fn row(what: &str, cost: &Cost) {
    println!(
        "  {what:<32}{:>10}{:>10.1}{:>8}",
        cost.ticks,
        cost.mean(),
        cost.worst
    );
}

//! `cargo chip-cycles`: what a tick takes in cycles, by what it is used for.

use std::process::ExitCode;

use super::arguments::ChipCycles;
use super::error::CliError;
use crate::chip::uses;
use crate::cycles::{Setting, Tally};

pub(super) fn run(arguments: &ChipCycles) -> Result<ExitCode, CliError> {
    let begun = std::time::Instant::now();
    let used = uses(arguments.ticks)?;
    eprintln!(
        "{} ticks {:.1} s",
        used.ticks.len(),
        begun.elapsed().as_secs_f64()
    );
    let without = Tally::of(&used, Setting::WITHOUT_WAIT_STATES);
    let all = Setting::ALL.map(|setting| Tally::of(&used, setting));
    for (k, row) in without.rows.iter().enumerate() {
        println!(
            "{:<40} {:>5} {:>7.0} {:>7.0}",
            row.name(),
            row.cycles.len(),
            row.instructions as f64 / row.cycles.len() as f64,
            row.mean()
        );
        for t in &all {
            let r = &t.rows[k];
            println!(
                "    {:>7.0} {:>6} {:>6} {:>6} {:?}",
                r.mean(),
                r.quantile(0.9),
                r.quantile(0.99),
                r.worst(),
                r.sum
            );
        }
    }
    eprintln!("{:.1} s", begun.elapsed().as_secs_f64());
    Ok(ExitCode::SUCCESS)
}

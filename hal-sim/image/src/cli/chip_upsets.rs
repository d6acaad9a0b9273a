//! `cargo chip-upsets`: what the controller makes of single bits that flip in RAM.

use std::collections::BTreeMap;
use std::process::ExitCode;

use parallel::cores;

use super::arguments::ChipUpsets;
use super::error::CliError;
use crate::chip::{Consequence, REGIONS, UpsetRun, upset, upsets};

pub(super) fn run(arguments: &ChipUpsets) -> Result<ExitCode, CliError> {
    if let Some(only) = &arguments.only {
        let (part, seed) = part_and_seed(only).ok_or_else(|| {
            let parts = REGIONS.len();
            CliError::Value(format!(
                "{only:?}: a part of the memory, 1 to {parts}, a colon and a seed"
            ))
        })?;
        println!("{}", upset(part, seed)?);
        return Ok(ExitCode::SUCCESS);
    }
    let runs = upsets(arguments.runs, arguments.seed, cores())?;
    print(&runs, arguments.seed);
    Ok(ExitCode::SUCCESS)
}

fn part_and_seed(only: &str) -> Option<(usize, u64)> {
    let (part, seed) = only.split_once(':')?;
    let part: usize = part.parse().ok()?;
    let place = part.checked_sub(1).filter(|it| *it < REGIONS.len())?;
    Some((place, seed.parse().ok()?))
}

fn print(runs: &[UpsetRun], seed: u64) {
    println!(
        "{:<27}{:>6}{:>9}{:>10}{:>7}{:>11}{:>10}   platform off, where nothing is told, mm",
        "one bit of", "runs", "nothing", "harmless", "fault", "restarted", "not told"
    );
    for (place, region) in REGIONS.iter().enumerate() {
        let of_it: Vec<_> = (runs.iter())
            .filter(|run| run.upset.region == place)
            .collect();
        let count = |is: fn(&Consequence) -> bool| {
            (of_it.iter()).filter(|run| is(&run.consequence)).count()
        };
        let mut off_mm: Vec<f64> = (of_it.iter())
            .filter(|run| run.consequence == Consequence::Silent)
            .map(|run| run.off_mm)
            .collect();
        off_mm.sort_by(f64::total_cmp);
        let off = match (off_mm.get(off_mm.len() / 2), off_mm.last()) {
            (Some(median), Some(worst)) => format!("{median:.4} median, {worst:.4} at worst"),
            _ => String::new(),
        };
        println!(
            "{:<27}{:>6}{:>9}{:>10}{:>7}{:>11}{:>10}   {off}",
            region.name,
            of_it.len(),
            count(|it| *it == Consequence::None),
            count(|it| *it == Consequence::Harmless),
            count(|it| matches!(it, Consequence::Fault(_))),
            count(|it| *it == Consequence::Restart),
            count(|it| *it == Consequence::Silent),
        );
    }
    println!();
    let mut kinds = BTreeMap::<&str, usize>::new();
    for run in runs {
        if let Consequence::Fault(text) = &run.consequence {
            *kinds.entry(text).or_default() += 1;
        }
    }
    println!("the faults:");
    for (kind, count) in kinds {
        println!("{count:>6}  {kind}");
    }
    let silent: Vec<_> = (runs.iter())
        .filter(|run| run.consequence == Consequence::Silent)
        .collect();
    println!("\nseed {seed}; not told, by part and seed:");
    for run in silent {
        println!("{run}");
    }
}

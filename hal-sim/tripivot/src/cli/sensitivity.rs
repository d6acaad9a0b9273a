//! `tripivot sensitivity`: how much each imperfection of the simulated machine decides.

use std::fmt::Write as _;
use std::io::{Write, stdout};
use std::process::ExitCode;

use hal_sim::rig::Told;
use hal_sim::rig::run::RunOptions;
use hal_sim::rig::script::Script;
use hal_sim::rig::sensitivity::{Sensitivity, compared, measure};
use parallel::cores;

use super::arguments::SensitivityRun;
use super::error::CliError;

/// Prints the table.
pub(super) fn run(arguments: &SensitivityRun) -> Result<ExitCode, CliError> {
    let options = RunOptions {
        mismatch_percent: arguments.mismatch,
        payload_kg: arguments.payload,
        told: if arguments.kind {
            Told::Nothing
        } else {
            Told::Reference
        },
        ..RunOptions::default()
    };
    let threads = arguments.jobs.unwrap_or_else(cores);
    let script = Script::demonstration()?;
    let machines = compared(arguments.kind);
    let rows = measure(&script, &machines, &options, threads);
    let mut text = format!(
        "The demonstration on {}, {} % off and {} kg on top, with one imperfection more or less at a time.\n\n\
         | machine | following, centre, um rms / peak | true pose, centre, um rms / peak | true theta, urad rms / peak | \
         sag / lost motion, um rms | true pose at rest, um rms / peak | settling, ms mean / worst | ended by |\n\
         |---|---|---|---|---|---|---|---|\n",
        if arguments.kind {
            "a kind machine"
        } else {
            "the reference stage"
        },
        arguments.mismatch,
        arguments.payload,
    );
    for (machine, row) in machines.iter().zip(&rows) {
        // A string takes everything.
        let _ = writeln!(text, "| {} | {} |", machine.name, columns(row));
    }
    stdout()
        .write_all(text.as_bytes())
        .map_err(CliError::output)?;
    Ok(ExitCode::SUCCESS)
}

fn columns(row: &Sensitivity) -> String {
    let pair =
        |[first, second]: [f64; 2], digits: usize| format!("{first:.digits$} / {second:.digits$}");
    [
        pair(row.following_um, 3),
        pair(row.true_um, 3),
        pair(row.true_urad, 2),
        pair(row.unseen_um, 3),
        pair(row.at_rest_um, 3),
        pair(row.settling_ms, 1),
        row.fault.clone().unwrap_or_else(|| "-".to_owned()),
    ]
    .join(" | ")
}

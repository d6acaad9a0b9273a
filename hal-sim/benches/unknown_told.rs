//! The demonstration on machines as workshops build them, whose controllers are told all that is true of them, as a table:
//! `cargo bench -p hal-sim --bench unknown_told`. `SEEDS=50` takes unknown machines 1 to 50 in place of 1 to 6. Exit code 1 where one ends in a fault.

use hal_sim::machine::unknown;
use hal_sim::report::Move;
use hal_sim::rig::Told;
use hal_sim::rig::run::{RunOptions, run};
use hal_sim::rig::script::Script;
use parallel::{cores, of_all};
use std::process::ExitCode;

/// What a machine comes to.
struct Row {
    /// Following error of the pivots, LSB rms.
    following_lsb: f64,
    /// Error of the centre's true pose in motion and at rest, um rms.
    moving_um: f64,
    at_rest_um: f64,
    /// Settling of the slowest move that had the time to, ms; moves that had it and did not settle.
    settling_ms: f64,
    unsettled: usize,
    fault: Option<String>,
}

fn main() -> ExitCode {
    let last = std::env::var("SEEDS").map_or(6, |text| text.parse().expect("a number of machines"));
    let seeds: Vec<u64> = (1..=last).collect();
    let rows = of_all(&seeds, cores(), |&seed| row(seed));
    println!("machines 1 to {last}: median / 90 % / worst");
    let spread = |what: &str, unit: &str, value: fn(&Row) -> f64| {
        let mut all: Vec<f64> = rows.iter().map(value).collect();
        all.sort_by(f64::total_cmp);
        let at = |share: f64| all[((all.len() - 1) as f64 * share).round() as usize];
        println!(
            "{what:<38}{:>9.3} / {:>9.3} / {:>9.3} {unit}",
            at(0.5),
            at(0.9),
            at(1.0)
        );
    };
    spread("following error of the pivots", "LSB rms", |row| {
        row.following_lsb
    });
    spread("true pose in motion, centre", "um rms", |row| row.moving_um);
    spread("true pose at rest, centre", "um rms", |row| row.at_rest_um);
    spread("settling of the slowest move", "ms", |row| row.settling_ms);
    spread("moves of 20 not settled after 0.1 s", "", |row| {
        row.unsettled as f64
    });
    let faults: Vec<_> = (seeds.iter().zip(&rows))
        .filter_map(|(seed, row)| Some((seed, row.fault.as_ref()?)))
        .collect();
    println!("{:<38}{:>9}", "ended by a fault", faults.len());
    for (seed, fault) in &faults {
        println!("machine {seed}: {fault}");
    }
    if faults.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

fn row(seed: u64) -> Row {
    let machine = unknown(seed);
    let options = RunOptions {
        imperfections: machine.plant.imperfections,
        machine,
        machine_name: format!("unknown machine {seed}"),
        mismatch_percent: 0.0,
        told: Told::Everything,
        ..RunOptions::default()
    };
    let script = Script::demonstration().expect("it is a script");
    let outcome = run(&script, &options);
    let statistics = outcome.run.trace.statistics();
    Row {
        following_lsb: statistics.pivot_error_lsb.rms(),
        moving_um: statistics.moving.truth.xy_um.rms(),
        at_rest_um: statistics.at_rest.truth.xy_um.rms(),
        settling_ms: (outcome.run.moves.iter())
            .filter_map(Move::settle_s)
            .fold(0.0, |worst, settle_s| f64::max(worst, 1e3 * settle_s)),
        unsettled: outcome.run.never_settled(),
        fault: outcome.fault,
    }
}

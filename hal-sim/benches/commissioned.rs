//! The demonstration on machines that nobody knew, as `tripivot commission` has left them, and with the gains that are best on their true plants, as a
//! table: `cargo bench -p hal-sim --bench commissioned`. `SETTINGS=DIR` has a folder for each machine (bench `commission` of `tripivot` makes them),
//! by default `target/commissioned`. Exit code 1 where one ends in a fault.
//!
//! All but gains, filters and what rest leaves of them is the same in both runs. Windings begin cold, as on another day.

use firmware::parameters::Parameters;
use hal_sim::campaign::Commissioned;
use hal_sim::machine::devices::{SettingsFlash, StageParameters, WiringParameters};
use hal_sim::machine::unknown;
use hal_sim::report::{Run, Sample};
use hal_sim::rig::run::{RunOptions, RunOutcome, run_machine};
use hal_sim::rig::script::Script;
use hal_sim::rig::{guides_hz, with_gains_tuned};
use parallel::{cores, of_all};
use std::path::PathBuf;
use std::process::ExitCode;

/// Ticks between two looks at a stage.
const EVERY: u32 = 4;
/// What stands in place of the demonstration's rests after each move.
const REST: &str = "DEL 120";
/// Time after a move in which it settles, and the end of it, in which it stands where it comes to stand, s.
const AFTER_S: f64 = 0.1;
const STANDS_S: f64 = 0.02;
/// It has settled once its centre stays so near, um: at the encoders to its setpoint, in truth to where it comes to stand. Ten counts of an encoder, whose
/// noise alone reaches five.
const NEAR_UM: f64 = 0.1;
/// What the true pose may take: so many periods of the platform on its guides, and so much more, s.
const PERIODS: f64 = 2.0;
const MORE_S: f64 = 6e-3;

/// What a run comes to.
struct Figures {
    /// Settling at the encoders, ms: mean of the moves, and the slowest.
    settling_ms: [f64; 2],
    /// The same of the true pose, and the slowest over what it may take.
    true_settling_ms: [f64; 2],
    true_settling: f64,
    /// Following error of the pivots, LSB rms.
    following_lsb: f64,
}

struct Row {
    machine: u64,
    commissioned: Figures,
    best: Figures,
    faults: Vec<String>,
}

fn main() -> ExitCode {
    let folder = std::env::var_os("SETTINGS")
        .map_or_else(|| PathBuf::from("../target/commissioned"), PathBuf::from);
    let machines = Commissioned::all_of(&folder).unwrap_or_else(|error| panic!("{error}"));
    let rows = of_all(&machines, cores(), row);
    println!("machines: {}", rows.len());
    println!(
        "| what | median | 90 % | worst | machine | with the best gains: median | 90 % | worst |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let print = |what: &str, value: fn(&Figures) -> f64| {
        let [commissioned, best] = [
            spread(&rows, |row| value(&row.commissioned)),
            spread(&rows, |row| value(&row.best)),
        ];
        println!(
            "| {what} | {} | {} | {} |",
            commissioned.0, commissioned.1, best.0
        );
    };
    print("settling at the encoders, mean of the moves, ms", |of| {
        of.settling_ms[0]
    });
    print("settling at the encoders, slowest move, ms", |of| {
        of.settling_ms[1]
    });
    print("settling of the true pose, mean of the moves, ms", |of| {
        of.true_settling_ms[0]
    });
    print("settling of the true pose, slowest move, ms", |of| {
        of.true_settling_ms[1]
    });
    print(
        "the same over two periods of the platform on its guides and 6 ms",
        |of| of.true_settling,
    );
    print("following error of the pivots, LSB rms", |of| {
        of.following_lsb
    });
    let over = spread(&rows, |row| {
        row.commissioned.settling_ms[0] / row.best.settling_ms[0]
    });
    println!(
        "| mean settling over that with the best gains | {} | {} | | | |",
        over.0, over.1
    );
    let faults: Vec<_> = rows.iter().flat_map(|row| &row.faults).collect();
    println!("faults: {}", faults.len());
    for fault in &faults {
        println!("{fault}");
    }
    if faults.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// Median, 90 % and worst, as cells, and the machine that is worst.
fn spread(rows: &[Row], of: impl Fn(&Row) -> f64) -> (String, u64) {
    let mut all: Vec<_> = rows.iter().map(|row| (of(row), row.machine)).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let at = |share: f64| all[((all.len() - 1) as f64 * share).round() as usize];
    let cells = [0.5, 0.9, 1.0].map(|share| format!("{:.3}", at(share).0));
    (cells.join(" | "), at(1.0).1)
}

fn row(commissioned: &Commissioned) -> Row {
    let mut machine = unknown(commissioned.machine);
    machine.plant.winding.start_k = 0.0;
    machine.wiring = WiringParameters::REFERENCE;
    let best = with_gains_tuned(&commissioned.parameters, &machine);
    let runs = [&commissioned.parameters, &best].map(|parameters| {
        let outcome = demonstration(&machine, parameters);
        let fault = (outcome.fault.as_ref())
            .map(|fault| format!("machine {}: {fault}", commissioned.machine));
        (figures(&outcome.run, &machine), fault)
    });
    let [(figures, fault), (best, of_best)] = runs;
    Row {
        machine: commissioned.machine,
        commissioned: figures,
        best,
        faults: [fault, of_best].into_iter().flatten().collect(),
    }
}

fn demonstration(machine: &StageParameters, parameters: &Parameters) -> RunOutcome {
    let options = RunOptions {
        every: EVERY,
        machine: *machine,
        imperfections: machine.plant.imperfections,
        ..RunOptions::default()
    };
    let mut script = Script::demonstration().expect("it is a script");
    for line in &mut script.lines {
        if line.text.starts_with("DEL") {
            line.text = REST.to_owned();
        }
    }
    run_machine(
        &script,
        parameters,
        machine,
        &options,
        SettingsFlash::in_memory(),
    )
}

fn figures(run: &Run, machine: &StageParameters) -> Figures {
    let platform_hz = guides_hz(&machine.plant);
    let rows = run.trace.rows();
    let settled = |settling_s: fn(&[Sample]) -> f64| {
        let all: Vec<f64> = (run.moves.iter())
            .map(|one| {
                let first = rows.partition_point(|row| row.time_s < one.profile_end_s);
                let after = &rows[first..];
                let until = after.partition_point(|row| row.time_s < one.profile_end_s + AFTER_S);
                1e3 * settling_s(&after[..until])
            })
            .collect();
        let worst = all.iter().copied().fold(0.0, f64::max);
        [all.iter().sum::<f64>() / all.len() as f64, worst]
    };
    let true_settling_ms = settled(true_settling_s);
    Figures {
        settling_ms: settled(|after| settling_s(after, |row| row.following_error)),
        true_settling_ms,
        true_settling: 1e-3 * true_settling_ms[1] / (PERIODS / platform_hz + MORE_S),
        following_lsb: run.trace.statistics().pivot_error_lsb.rms(),
    }
}

/// From the first of these until an error stays small, s.
fn settling_s(after: &[Sample], error: impl Fn(&Sample) -> [f64; 3]) -> f64 {
    let is_far = |row: &&Sample| {
        let [x_um, y_um, _] = error(row);
        x_um.hypot(y_um) > NEAR_UM
    };
    let last = after.iter().rev().find(is_far);
    last.map_or(0.0, |row| row.time_s - after[0].time_s)
}

/// The same of the true pose, from where it comes to stand.
fn true_settling_s(after: &[Sample]) -> f64 {
    let stands = after.partition_point(|row| row.time_s < after[0].time_s + AFTER_S - STANDS_S);
    let standing = &after[stands..];
    let mean: [f64; 3] = std::array::from_fn(|k| {
        standing.iter().map(|row| row.true_error[k]).sum::<f64>() / standing.len() as f64
    });
    settling_s(after, |row| {
        std::array::from_fn(|k| row.true_error[k] - mean[k])
    })
}

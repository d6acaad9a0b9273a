//! Kind machines off their drawing, brought up by `tripivot commission`, and what they do then, as a table:
//! `cargo bench -p tripivot --bench kind`. Guides are stiff and without friction, gears and encoders without errors: what is left is the drives' and
//! the loop's.

#[path = "../../benches/settle/moves.rs"]
mod moves;

use desk::commission::{Chosen, ZerosBy, run};
use firmware::parameters::Parameters;
use hal_sim::machine::devices::{SettingsFlash, StageParameters};
use hal_sim::rig::run::{RunOptions, run_machine, stage_parameters};
use hal_sim::rig::script::Script;
use parallel::{cores, of_all};
use tripivot::attended::SimulatedMachine;

/// How far they are off, percent, and what they carry, kg.
const MACHINES: [[f64; 2]; 6] = [
    [0.0, 0.0],
    [20.0, 0.0],
    [-20.0, 0.0],
    [35.0, 0.0],
    [20.0, 5.0],
    [35.0, 5.0],
];

/// What a machine came to.
enum Came {
    /// A step failed, and why.
    Refused(String),
    /// Cells of the table of moves, and of that at rest.
    To([String; 2]),
}

fn main() {
    let all = of_all(&MACHINES, cores(), came);
    println!(
        "| off, % | load, kg | commissioned in, s | settling window found, LSB | demonstration: following error of the centre, um rms / peak | settling, ms mean / worst | 200 moves: settling, ms after the profile: median / 90 % / 99 % / worst | of the profile: median / 90 % / 99 % / worst | within 10 % | settled told within 10 % |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for (machine, came) in MACHINES.iter().zip(&all) {
        match came {
            Came::Refused(why) => println!("| {} | {} | refused: {why} |", machine[0], machine[1]),
            Came::To([moving, _]) => println!("| {} | {} | {moving} |", machine[0], machine[1]),
        }
    }
    println!();
    println!(
        "| at rest: off, % | load, kg | true position, nm rms | theta, nrad rms | pivots, LSB rms / peak | duty, % rms about its mean |"
    );
    println!("|---|---|---|---|---|---|");
    for (machine, came) in MACHINES.iter().zip(&all) {
        if let Came::To([_, resting]) = came {
            println!("| {} | {} | {resting} |", machine[0], machine[1]);
        }
    }
}

fn came(&[mismatch_percent, payload_kg]: &[f64; 2]) -> Came {
    let options = RunOptions {
        mismatch_percent,
        payload_kg,
        ..RunOptions::default()
    };
    let stage = stage_parameters(&options);
    let mut machine = SimulatedMachine::new(&stage, SettingsFlash::in_memory());
    let done = match run(&mut machine, &Chosen::all(ZerosBy::Jig), &mut |_| {}) {
        Ok(ran) => ran.done,
        Err(error) => return Came::Refused(error.to_string()),
    };
    let failure = (done.iter()).find_map(|done| Some((done.step.name, done.failure.as_ref()?)));
    if let Some((step, failure)) = failure {
        return Came::Refused(format!("{step}: {}", failure.what));
    }
    let parameters = machine.parameters();
    let seconds: f64 = done.iter().map(|done| done.seconds).sum();
    let demonstration = match demonstration(&options, &stage, parameters) {
        Ok(cells) => cells,
        Err(fault) => return Came::Refused(fault),
    };
    let moves = moves::of(&stage, parameters);
    Came::To([
        format!(
            "{seconds:.0} | {} | {demonstration} | {} | {:.1} % | {:.1} %",
            parameters.window.counts,
            moves.settling(),
            100.0 * moves.within_a_tenth(),
            100.0 * moves.told_within_a_tenth()
        ),
        moves.rest.cells(),
    ])
}

/// Following error of the centre while it moves, and settling; or the fault in which it ends.
fn demonstration(
    options: &RunOptions,
    stage: &StageParameters,
    parameters: &Parameters,
) -> Result<String, String> {
    let script = Script::demonstration().expect("it is a script");
    let flash = SettingsFlash::in_memory();
    let outcome = run_machine(&script, parameters, stage, options, flash);
    if let Some(fault) = outcome.fault {
        return Err(fault);
    }
    let centre = &outcome.run.trace.statistics().moving.following.xy_um;
    // A move that had not settled when the next one began is one that never does.
    let settle_ms: Vec<f64> = (outcome.run.moves.iter())
        .map(|one| one.settle_s().map_or(f64::INFINITY, |s| 1e3 * s))
        .collect();
    let mean = settle_ms.iter().sum::<f64>() / settle_ms.len() as f64;
    Ok(format!(
        "{:.3} / {:.2} | {mean:.1} / {:.1}",
        centre.rms(),
        centre.peak(),
        settle_ms.iter().copied().fold(0.0, f64::max)
    ))
}

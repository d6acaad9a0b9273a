//! What each imperfection of the simulated machine costs: how many times real time a run is, on one core: `cargo bench -p hal-sim --bench
//! cost`.
//!
//! Every machine runs once a round, in turn, so that what disturbs the host disturbs all of them alike. Medians of the rounds count, of the
//! ratio to the kind machine's run in the same round too.

use hal_sim::rig::run::{RunOptions, run};
use hal_sim::rig::script::Script;
use hal_sim::rig::sensitivity::{Compared, compared};

/// Rounds, an odd number.
const ROUNDS: usize = 9;
/// Times real time that everything at once has to leave.
const GOAL: f64 = 4.0;
/// Across the disk, a turn on the way, and some rest.
const SCRIPT: &str = "FRF\nWAC ONT? X = 1\nMOV X 40 Y -30 W 90\nWAC ONT? X = 1\nMOV X -50 Y 20 W 0\nWAC ONT? X = 1\nDEL 300\n";

fn main() {
    let script = Script::parse("cost", SCRIPT).expect("a good script");
    let machines = compared(true);
    let mut speeds = vec![Vec::new(); machines.len()];
    for _ in 0..ROUNDS {
        for (machine, speeds) in machines.iter().zip(&mut speeds) {
            speeds.push(speed(&script, machine));
        }
    }
    println!(
        "{:<32} {:>16} {:>22}",
        "machine", "times real time", "time over a kind one's"
    );
    let kind = speeds[0].clone();
    for (machine, speeds) in machines.iter().zip(&speeds) {
        let ratios = kind.iter().zip(speeds).map(|(kind, speed)| kind / speed);
        let ratio = median(ratios.collect());
        let speed = median(speeds.clone());
        println!("{:<32} {speed:>16.1} {ratio:>22.2}", machine.name);
    }
    let all = speeds.pop().map_or(0.0, median);
    let word = if all >= GOAL {
        "reached"
    } else {
        "NOT reached"
    };
    println!("goal of {GOAL} times real time with all: {word}");
}

/// Simulated seconds in a second of this run.
fn speed(script: &Script, machine: &Compared) -> f64 {
    let options = RunOptions {
        imperfections: machine.imperfections,
        mismatch_percent: 0.0,
        ..RunOptions::default()
    };
    let outcome = run(script, &options);
    assert_eq!(outcome.fault, None, "{}", machine.name);
    outcome.run.trace.statistics().end_s / outcome.run.wall_s
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

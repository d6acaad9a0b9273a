//! What the simulation costs on this machine, as a table: `cargo bench -p hal-sim`.

use std::hint::black_box;
use std::time::Instant;

use hal_sim::devices::{BridgeState, Stage, StageParameters};
use hal_sim::plant::{Drive, Imperfections, Plant, PlantParameters};
use hal_sim::run::{RunOptions, run};
use hal_sim::script::Script;

/// Batches; the fastest counts, since what disturbs a timing only ever adds to it.
const BATCHES: u32 = 10;
/// Control periods in a batch.
const PERIODS: u32 = 20_000;
/// The substeps of one control period, s.
const SUBSTEPS_S: [f64; 4] = [12.5e-6, 12.5e-6, 10e-6, 15e-6];

fn main() {
    println!("{:<44} {:>8}", "one control period of 50 us", "us");
    for (name, imperfections) in [
        ("plant, ideal", Imperfections::NONE),
        ("plant, all imperfections", Imperfections::ALL),
    ] {
        let mut plant = Plant::new(PlantParameters {
            imperfections,
            ..PlantParameters::REFERENCE
        });
        println!("{name:<44} {:>8.3}", micros_each(|| run_plant(&mut plant)));
    }
    let mut stage = Stage::new(&StageParameters::REFERENCE);
    println!(
        "{:<44} {:>8.3}",
        "stage: plant, encoders, bridges",
        micros_each(|| run_stage(&mut stage))
    );
    assert_eq!(stage.plant.broken(), None);
    whole_run();
}

/// The demonstration, controller and report's bookkeeping included.
fn whole_run() {
    let script = Script::demonstration().expect("the built-in script");
    let fastest = (0..3)
        .map(|_| {
            let outcome = run(&script, &RunOptions::default());
            let simulated_s = outcome.run.trace.statistics().end_s;
            (simulated_s / outcome.run.wall_s, outcome)
        })
        .max_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((speed, outcome)) = fastest {
        let micros = outcome.run.wall_s / outcome.ticks as f64 * 1e6;
        println!(
            "{:<44} {micros:>8.3}",
            "demonstration: stage, controller, records"
        );
        println!("{:<44} {speed:>8.1} times real time", "");
    }
}

fn run_plant(plant: &mut Plant) {
    for step_s in SUBSTEPS_S {
        plant.step(
            step_s,
            &[
                Drive::Voltage(6.0),
                Drive::Voltage(5.9),
                Drive::Voltage(6.1),
            ],
        );
    }
    black_box(plant);
}

fn run_stage(stage: &mut Stage) {
    let pins = BridgeState {
        pulse: 0.125,
        forward: true,
        awake: true,
        fault: false,
    };
    stage.advance_period([pins; 3]);
    black_box(stage.frames());
}

fn micros_each(mut work: impl FnMut()) -> f64 {
    let mut batch = || {
        let start = Instant::now();
        for _ in 0..PERIODS {
            work();
        }
        start.elapsed().as_secs_f64() * 1e6 / f64::from(PERIODS)
    };
    (0..BATCHES).map(|_| batch()).fold(f64::INFINITY, f64::min)
}

//! What the simulation costs on this machine, as a table: `cargo bench -p hal-sim`.

use std::hint::black_box;
use std::time::Instant;

use firmware::control::Inputs;
use firmware::drivers::biss::RawFrame;
use firmware::drivers::power_stage::signed_current_counts;
use firmware::gcs::Session;
use firmware::parameters::Parameters;
use hal_sim::front::{ControlLoop, Front, Host};
use hal_sim::machine::devices::{BridgeState, SettingsFlash, Stage, StageParameters};
use hal_sim::machine::plant::{Drive, Imperfections, Plant, PlantParameters};
use hal_sim::rig::observer::TickRecord;
use hal_sim::rig::run::{RunOptions, run};
use hal_sim::rig::script::Script;
use hal_sim::rig::{ControllerMemory, Rig};

/// Batches; the fastest counts, since what disturbs a timing only ever adds to it.
const BATCHES: u32 = 10;
/// Control periods in a batch.
const PERIODS: u32 = 20_000;
/// Ticks of the move that the controller makes by itself: all of it, and some rest.
const MOVE_TICKS: usize = 40_000;
/// The substeps of one control period, s.
const SUBSTEPS_S: [f64; 4] = [16e-6, 16e-6, 3e-6, 15e-6];

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
    controller_alone();
    whole_run();
}

/// The controller without a plant: its tick and its command side, given what it was given in a move with one.
fn controller_alone() {
    let inputs = recorded_inputs();
    let replayed = || {
        let mut commanded = Commanded::new(ControlLoop::new);
        for (index, inputs) in inputs.iter().enumerate() {
            commanded.command(index);
            commanded.rig.front.inputs = inputs.clone();
            black_box(commanded.rig.tick(&mut commanded.record));
        }
        assert_eq!(commanded.rig.front.fault(), None);
        commanded.record.hash
    };
    let (mut fastest_s, mut hash) = (f64::INFINITY, None);
    for _ in 0..BATCHES {
        let start = Instant::now();
        hash = Some(replayed());
        fastest_s = fastest_s.min(start.elapsed().as_secs_f64());
    }
    println!(
        "{:<44} {:>8.3}",
        "controller without plant: tick, panel",
        fastest_s / inputs.len() as f64 * 1e6
    );
    let simulated_s = inputs.len() as f64 / Parameters::REFERENCE.limits.rate_hz;
    println!(
        "{:<44} {:>8.1} times real time, hash {:08x}",
        "",
        simulated_s / fastest_s,
        hash.map_or(0, |hash| hash.0)
    );
}

/// What the controller is given in that move, tick by tick.
fn recorded_inputs() -> Vec<Inputs> {
    let mut commanded =
        Commanded::new(|parameters| Host::new(&StageParameters::REFERENCE, parameters));
    (0..MOVE_TICKS)
        .map(|index| {
            commanded.command(index);
            let stage = &mut commanded.rig.front.stage;
            let (currents, supply_counts) = stage.analog();
            let inputs = Inputs {
                frames: stage.frames().map(RawFrame),
                bridge_fault: [false; 3],
                emergency_stop: false,
                current_counts: currents.map(signed_current_counts),
                supply_counts,
                tick_cycles: 0,
                program_damaged: false,
                late: false,
            };
            commanded.rig.tick(&mut commanded.record);
            inputs
        })
        .collect()
}

/// A controller and who commands it.
struct Commanded<F> {
    rig: Rig<'static, F>,
    session: Session,
    record: TickRecord,
}

impl<F: Front> Commanded<F> {
    fn new(front: impl FnOnce(&Parameters) -> F) -> Self {
        let (queues, flash) = (
            ControllerMemory::endless().split(),
            SettingsFlash::in_memory(),
        );
        Self {
            rig: Rig::new(queues, &Parameters::REFERENCE, flash, front),
            session: Session::new(),
            record: TickRecord::default(),
        }
    }

    fn receive(&mut self, line: &[u8]) {
        assert_eq!(self.session.receive(line), line.len());
    }

    /// The command side's turn before a tick: a reference, and a move about the disk.
    fn command(&mut self, index: usize) {
        match index {
            100 => self.receive(b"FRF X\n"),
            200 => self.receive(b"MOV X 60 Y -40 W 600\n"),
            _ => {}
        }
        let mut answers = Vec::new();
        // Writing to a vector does not fail.
        let _ = self.rig.service(&mut self.session, &mut answers);
    }
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

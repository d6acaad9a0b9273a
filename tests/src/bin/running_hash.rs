//! Prints two running hashes of the controller on the host, over state, setpoints, measured pivots and duties of every tick:
//! over the demonstration as `tripivot` runs it by default, and over the first 100,000 ticks of the exercise of seed 1.
//!
//! A change that is to leave the controller's doing as it is leaves both as they are:
//!
//! ```text
//! cargo run --release -p tests --bin running_hash
//! ```

use std::process::ExitCode;

use firmware::gcs::Session;
use firmware::mode::Mode;
use hal_sim::machine::devices::SettingsFlash;
use hal_sim::rig::client::Client;
use hal_sim::rig::exercise::{Patience, script};
use hal_sim::rig::observer::TickRecord;
use hal_sim::rig::run::{RunOptions, controller_parameters, run, stage_parameters};
use hal_sim::rig::script::{Script, ScriptError};
use hal_sim::rig::{ControllerMemory, Rig};

/// Seed of the exercise's lines and of the simulated noise.
const SEED: u64 = 1;
/// Ticks of the exercise.
const TICKS: u64 = 100_000;

fn main() -> ExitCode {
    match print() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("running_hash: {error}");
            ExitCode::FAILURE
        }
    }
}

fn print() -> Result<(), ScriptError> {
    let demonstration = run(&Script::demonstration()?, &RunOptions::default());
    let (hash, ticks) = (demonstration.hash, demonstration.ticks);
    println!("demonstration, {ticks} ticks: {hash:08x}");
    let exercise = exercise(&script(SEED, TICKS)?);
    println!("exercise of seed {SEED}, {TICKS} ticks: {exercise:08x}");
    Ok(())
}

/// The running hash over the lines' first ticks. Lines that are refused are left at that, as they are meant to be.
fn exercise(lines: &Script) -> u32 {
    let options = RunOptions {
        seed: SEED,
        ..RunOptions::default()
    };
    let parameters = controller_parameters(&options);
    let mut memory = ControllerMemory::new();
    let (stage, flash) = (stage_parameters(&options), SettingsFlash::in_memory());
    let mut rig = Rig::simulated(&mut memory, &stage, &parameters, flash);
    let (mut session, mut client) = (Session::new(), Client::new(lines));
    let (mut patience, mut record) = (Patience::default(), TickRecord::default());
    let (mut to_client, mut to_stage) = (Vec::new(), Vec::new());
    for _ in 0..TICKS {
        rig.tick(&mut record);
        let mode = (record.sample.as_ref()).map_or(Mode::Off, |sample| sample.mode);
        let taken = session.receive(&to_stage);
        to_stage.drain(..taken);
        // Writing to a vector does not fail.
        let _ = rig.service(&mut session, &mut to_client);
        rig.keep();
        let (bytes, _) = client.poll(&std::mem::take(&mut to_client), mode == Mode::Moving);
        to_stage.extend(bytes);
        to_stage.extend(patience.poll(&client, mode));
    }
    record.hash.0
}

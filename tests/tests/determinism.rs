//! The same seed and script give the same run, byte for byte.

use firmware::parameters::Parameters;
use firmware::queues::{Command, Queues};
use hal_sim::front::Host;
use hal_sim::machine::devices::StageParameters;
use hal_sim::rig::observer::TickRecord;
use hal_sim::rig::run::{RunOptions, RunOutcome, run};
use hal_sim::rig::script::Script;
use std::fs;
use std::path::Path;

const SCRIPT: &str = "FRF\nWAC ONT? W = 1\nMOV X 20 Y -10 W 30\nDEL 60\nHLT\nWAC ONT? W = 1\nPOS? X W\nMVR Y 3\nWAC ONT? Y = 1\n";

fn outcome(seed: u64, folder: &Path) -> RunOutcome {
    let script = Script::parse("determinism", SCRIPT).expect("a good script");
    let options = RunOptions {
        out: folder.to_owned(),
        every: 7,
        seed,
        ..RunOptions::default()
    };
    let outcome = run(&script, &options);
    assert_eq!(outcome.fault, None);
    outcome
}

fn files(outcome: &RunOutcome, folder: &Path) -> [Vec<u8>; 2] {
    outcome.run.write(folder).expect("a folder of ours");
    ["trace.csv", "moves.csv"].map(|name| fs::read(folder.join(name)).expect("written"))
}

#[test]
fn a_seed_is_a_run() {
    let folder = |name: &str| Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let [one, same, other] = [("one", 5), ("same", 5), ("other", 6)].map(|(name, seed)| {
        let folder = folder(name);
        let outcome = outcome(seed, &folder);
        let files = files(&outcome, &folder);
        (outcome, files)
    });
    assert_eq!(one.0.hash, same.0.hash);
    assert_eq!(one.0.ticks, same.0.ticks);
    assert_eq!(one.0.answers, same.0.answers);
    assert!(one.1 == same.1, "the traces differ");
    assert!(one.1[0].len() > 100_000, "{} bytes", one.1[0].len());
    assert_ne!(one.0.hash, other.0.hash);
    assert!(one.1[0] != other.1[0], "another seed has the same trace");
}

/// The ticks of the snapshots of a stage that is referenced and switched, when the command side looks after every so many ticks.
fn snapshot_ticks(every: u32) -> Vec<u64> {
    let mut host = Host::new(&StageParameters::REFERENCE, &Parameters::REFERENCE);
    let (mut queues, mut record) = (Queues::new(), TickRecord::default());
    let (mut tick_queues, mut commands) = queues.split();
    let mut ticks = Vec::new();
    for tick in 0..600 {
        let command = match tick {
            20 => Some(Command::Reference),
            101 | 303 => Some(Command::Servo(false)),
            202 | 404 => Some(Command::Servo(true)),
            _ => None,
        };
        if let Some(command) = command {
            commands.send(command).expect("room");
        }
        host.tick(&mut tick_queues, &mut record);
        if tick % every == 0 {
            ticks.extend(commands.snapshot().map(|snapshot| snapshot.tick));
        }
    }
    ticks
}

/// Who compares two runs can have every snapshot that any command side has had: those of one that is never late.
#[test]
fn a_late_command_side_sees_no_tick_that_a_prompt_one_does_not() {
    let prompt = snapshot_ticks(1);
    for every in 2..9 {
        let late = snapshot_ticks(every);
        assert!(late.len() > 50, "{}", late.len());
        let more: Vec<_> = late.iter().filter(|tick| !prompt.contains(tick)).collect();
        assert!(more.is_empty(), "every {every}: {more:?}");
    }
}

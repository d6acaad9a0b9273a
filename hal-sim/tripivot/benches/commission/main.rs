//! `tripivot commission` on many machines that nobody knows, as a table: `cargo bench -p tripivot --bench commission`.
//!
//! `SEEDS=24` takes machines 1 to 24 in place of 1 to 4, `SEEDS=9-16` those. Each machine is told as it is done, and kept in a file
//! (`RESULTS=FILE`): one that stands there is not run again, so that a long table may be made in pieces. A machine is run again once its line is
//! taken out of it. `TABLE=1` runs none, and prints the table of those that there are. `ZEROS=ends` takes the guides' ends in place of the jig.
//! `SETTINGS=DIR` leaves in `DIR/NUMBER` what the controller of each machine that was not refused keeps, and plugs the machines in as they belong:
//! `tripivot faults --commissioned DIR` runs the campaign of faults on them.
//!
//! | file | idea |
//! |---|---|
//! | here | one machine after the other |
//! | `judged` | what a machine came to, against its own numbers |
//! | `rows` | the file, a row, the table |

mod judged;
mod rows;

use desk::commission::{Chosen, Done, Machine, Task, ZerosBy, run};
use desk::record::RecordError;
use hal_sim::campaign::SETTINGS;
use hal_sim::machine::devices::{SettingsFlash, WiringParameters};
use hal_sim::machine::unknown;
use judged::Warmth;
use rows::Row;
use std::ops::RangeInclusive;
use std::path::PathBuf;
use tripivot::attended::SimulatedMachine;

fn main() {
    let path = std::env::var_os("RESULTS").map_or_else(
        || {
            let name = match zeros() {
                ZerosBy::Jig => "commission.jsonl",
                ZerosBy::GuideEnds => "commission-ends.jsonl",
            };
            PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name)
        },
        PathBuf::from,
    );
    let mut all = rows::read(&path);
    let seeds = seeds();
    if std::env::var_os("TABLE").is_none() {
        for seed in seeds.clone() {
            if all.iter().all(|row| row.seed != seed) {
                let row = commissioned(seed);
                println!("{}", row.words());
                rows::append(&path, &row);
                all.push(row);
            }
        }
    }
    all.retain(|row| seeds.contains(&row.seed));
    rows::print(&all);
}

fn seeds() -> RangeInclusive<u64> {
    let text = std::env::var("SEEDS").unwrap_or_else(|_| "4".to_owned());
    let (first, last) = text.split_once('-').unwrap_or(("1", &text));
    let number = |text: &str| text.trim().parse().expect("SEEDS is 24 or 9-16");
    number(first)..=number(last)
}

fn zeros() -> ZerosBy {
    ZerosBy::new(std::env::var("ZEROS").is_ok_and(|text| text == "ends"))
}

/// A machine and its person, who counts what is asked.
struct Counted {
    machine: SimulatedMachine,
    questions: u32,
}

impl Machine for Counted {
    fn ask(&mut self, line: &str) -> Result<Option<String>, RecordError> {
        self.machine.ask(line)
    }

    fn delay(&mut self, seconds: f64) -> Result<(), RecordError> {
        self.machine.delay(seconds)
    }

    fn request(&mut self, task: Task) -> Result<(), RecordError> {
        // Who puts the jig in takes it out: that is one question.
        self.questions += u32::from(task != Task::TakeOutJig);
        self.machine.request(task)
    }

    fn scale_periods(&self) -> Option<u32> {
        self.machine.scale_periods()
    }
}

/// Where settings are left.
fn kept(seed: u64) -> Option<PathBuf> {
    let folder = std::env::var_os("SETTINGS")?;
    Some(PathBuf::from(folder).join(seed.to_string()))
}

fn commissioned(seed: u64) -> Row {
    let mut truth = unknown(seed);
    let kept = kept(seed);
    let mut flash = SettingsFlash::in_memory();
    if let Some(folder) = &kept {
        truth.wiring = WiringParameters::REFERENCE;
        std::fs::create_dir_all(folder).expect("a folder");
        let path = folder.join(SETTINGS);
        // What an earlier run has left would be no unknown machine.
        let _ = std::fs::remove_file(&path);
        flash = SettingsFlash::open(&path).expect("a file for settings");
    }
    let warmth = Warmth::default();
    let mut counted = Counted {
        machine: SimulatedMachine::watched(&truth, flash, Some(warmth.watch())),
        questions: 0,
    };
    let done = run(&mut counted, &Chosen::all(zeros()), &mut |done| {
        warmth.note(done.step.name);
    });
    let done = done
        .unwrap_or_else(|error| panic!("machine {seed}: {error}"))
        .done;
    let refused = done.last().and_then(|last| {
        let failure = last.failure.as_ref()?;
        Some(format!("{}: {}", last.step.name, failure.what))
    });
    let seconds = |done: &Done| (done.step.name.to_owned(), done.seconds);
    let mut figures = vec![
        ("time", done.iter().map(|done| done.seconds).sum()),
        ("questions", f64::from(counted.questions)),
    ];
    if let (Some(_), Some(folder)) = (&refused, &kept) {
        std::fs::remove_dir_all(folder).expect("its folder");
    }
    if refused.is_none() {
        figures.extend(judged::figures(&truth, &done, &warmth));
        figures.extend(judged::gains(&truth, counted.machine.parameters(), &warmth));
    }
    Row {
        seed,
        refused,
        // What a step did not tell is left out: a file has no number for it.
        figures: (figures.into_iter().filter(|(_, value)| value.is_finite()))
            .map(|(name, value)| (name.to_owned(), value))
            .collect(),
        steps: done.iter().map(seconds).collect(),
    }
}

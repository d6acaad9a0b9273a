//! A campaign of faults: many short runs of the controller on simulated stages, in each of which something breaks.
//!
//! A run is what its seed says: a machine as a workshop builds it, a controller that was told its numbers, a motion, a fault and the tick
//! in which it comes. It is run twice, with the fault and without: the second must raise no alarm. The fault is done to the simulated
//! hardware; the controller reads it through its own drivers, and what starts it again is the simulated watchdog.
//!
//! What the controller makes of it is held to two things: it says in time what has happened, and the stage comes to rest within what
//! masses, motors and the time to find it allow (`bound`). What it does not find is compared with the sound run: where its inputs
//! differ by less than their noise (`inputs`), by less than the sound machine's own do from one day to another (`another_day`), or as they would if
//! somebody pushed it (`pushed`), nobody could have found it.
//!
//! Not here, since nothing that reaches the controller from outside brings them about: numbers that are none (frames and ADC counts are whole
//! numbers, and a parameter that makes one is out of its range or does not go with the others) and setpoints out of reach, out of the
//! disk, the guides or too close (the planner gives none). They have tests of their own, past the command side; the crystal and the
//! image's checksum have them on the emulated chip, and so do bits that flip in its RAM (`cargo chip-upsets`).
//!
//! | file | idea |
//! |---|---|
//! | `injection`, `draw`, `apply`, `settings` | what breaks; how much; how the hardware does it |
//! | `expected`, `effect`, `current`, `swings`, `excited` | what the controller has to say about it, and when that has passed its threshold |
//! | `scenario`, `motion` | from a seed to a run; what the stage is told |
//! | `commissioned` | machines with what a commissioning found of them, in place of what their builder knows |
//! | `run`, `watch` | one run, and who looks on |
//! | `outcome` | what came of a run |
//! | `truth`, `rest` | what the machine really did |
//! | `bound` | how far it may go on, by physics |
//! | `inputs`, `another_day`, `pushed` | whether the controller could have known |
//! | `verdict` | whether the controller did what it has to |
//! | `totals` | what the runs of each fault amount to |
//! | `table`, `remedy`, `rows` | what is printed, and written |

mod another_day;
mod apply;
mod bound;
mod commissioned;
mod current;
mod draw;
mod effect;
mod excited;
mod expected;
mod injection;
mod inputs;
mod motion;
mod outcome;
mod pushed;
mod remedy;
mod rest;
mod rows;
mod run;
mod scenario;
mod settings;
mod swings;
mod table;
mod totals;
mod truth;
mod verdict;
mod watch;

pub use another_day::on_another_day;
pub use bound::MARGIN;
pub use commissioned::{Commissioned, CommissionedError, SETTINGS};
pub use effect::Effect;
pub use expected::{Cause, Expected};
pub use injection::{Injection, NAMES, Other};
pub use outcome::{Differs, End, Known, Outcome};
pub use rest::ToRest;
pub use rows::csv;
pub use run::run;
pub use scenario::{Scenario, machine, told};
pub use table::table;
pub use totals::{Spread, Total, totals};
pub use verdict::{Measure, Problem};

use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

use crate::random::Random;
use inputs::Inputs;
use pushed::Pushed;

/// What a campaign is to be.
#[derive(Clone, Copy, Debug)]
pub struct Campaign<'a> {
    /// Runs with a fault; there are as many without.
    pub runs: u64,
    /// Seed of the runs' seeds.
    pub seed: u64,
    /// Threads.
    pub jobs: usize,
    /// Machines to run it on; none: each run draws its own.
    pub machines: &'a [Commissioned],
}

impl Campaign<'_> {
    /// Runs it, as long as `goes_on` says so when it is told how many runs have been begun, from any thread. The outcomes are in
    /// the order of the runs, each with its control behind it, whatever the threads do.
    #[must_use]
    pub fn run(&self, goes_on: impl Fn(u64) -> bool + Sync) -> Vec<Outcome> {
        let mut seeds = Random::new(self.seed);
        // 48 bits: short enough to be typed.
        let seeds: Vec<u64> = (0..self.runs).map(|_| seeds.bits() >> 16).collect();
        let next = AtomicU64::new(0);
        let work = || {
            let mut done = Vec::new();
            loop {
                let index = next.fetch_add(1, Ordering::Relaxed);
                let Some(&seed) = seeds.get(index as usize) else {
                    return done;
                };
                if !goes_on(index) {
                    return done;
                }
                done.push((index, replay(seed, self.machines)));
            }
        };
        let mut outcomes: Vec<(u64, [Outcome; 2])> = thread::scope(|scope| {
            let threads: Vec<_> = (0..self.jobs.max(1)).map(|_| scope.spawn(work)).collect();
            (threads.into_iter())
                .flat_map(|thread| thread.join().expect("a run panicked: see above"))
                .collect()
        });
        outcomes.sort_by_key(|(index, _)| *index);
        outcomes.into_iter().flat_map(|(_, pair)| pair).collect()
    }
}

/// Other days that the inputs of an undetected fault are held against, each by itself, at most: until one differs from the sound run by more.
const MOST_DAYS: u64 = 8;

/// The run of a seed with its fault, and without, on one of these machines, or on one that is drawn.
#[must_use]
pub fn replay(seed: u64, machines: &[Commissioned]) -> [Outcome; 2] {
    both(Scenario::on(seed, machines))
}

/// A scenario with its fault, and without.
#[must_use]
pub fn both(scenario: Scenario) -> [Outcome; 2] {
    let seed = scenario.seed;
    let mut pair = [run(scenario.clone(), false), run(scenario, true)];
    if pair[0].detected().is_none() {
        let mut with_other_noise = pair[1].scenario.clone();
        with_other_noise.stage.seed = !with_other_noise.seed;
        let noise = run(with_other_noise.clone(), true).inputs;
        let [broken, sound] = &mut pair;
        let than =
            |others: &[&Inputs]| (broken.inputs).differ(&sound.inputs, others, &broken.scenario);
        let pushed = |run: &Inputs| Pushed::of(run, &sound.inputs, &broken.scenario);
        let (push, push_by_noise) = (pushed(&broken.inputs), pushed(&noise));
        let than_noise = than(&[&noise]);
        let mut than_another_day = than_noise;
        let mut than_push = push.differ(&[&push_by_noise]);
        for day in 0..MOST_DAYS {
            if than_another_day < 1.0 {
                break;
            }
            let mut then = with_other_noise.clone();
            then.stage = on_another_day(&then.stage, seed ^ day << 48);
            let then = run(then, true).inputs;
            than_another_day = than_another_day.min(than(&[&noise, &then]));
            than_push = than_push.min(push.differ(&[&push_by_noise, &pushed(&then)]));
        }
        broken.differs = Some(Differs {
            than_noise,
            than_another_day,
            than_push,
            push_n: push.push_n,
        });
    }
    for outcome in &mut pair {
        outcome.inputs.clear();
    }
    pair
}

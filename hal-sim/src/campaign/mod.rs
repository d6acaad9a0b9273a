//! A campaign of faults: many short runs of the controller on simulated stages, in each of which something breaks.
//!
//! A run is what its seed says: a machine with every number up to 30 % off and 0 to 5 kg on it that the controller knows nothing
//! of, a motion, a fault and the tick in which it comes. It is run twice, with the fault and without: the second must
//! raise no alarm. The fault is done to the simulated hardware; the controller reads it through its own drivers.
//!
//! Not here, since nothing that reaches the controller brings them about: numbers that are none (frames and ADC counts are whole
//! numbers, and a parameter that makes one is out of its range or does not go with the others) and setpoints out of reach
//! (the planner gives none). They have tests of their own, past the command side.
//!
//! | file | idea |
//! |---|---|
//! | `injection`, `settings` | what breaks |
//! | `expected`, `effect` | what the controller has to say about it, and when that has passed its threshold |
//! | `scenario` | from a seed to a run |
//! | `run`, `watch` | one run, and who looks on |
//! | `outcome` | what came of a run |
//! | `truth` | what the machine really did |
//! | `verdict` | whether the controller did what it has to |
//! | `totals` | what the runs of each fault amount to |
//! | `table`, `rows` | what is printed, and written |

mod effect;
mod expected;
mod injection;
mod outcome;
mod rows;
mod run;
mod scenario;
mod settings;
mod table;
mod totals;
mod truth;
mod verdict;
mod watch;

pub use effect::Effect;
pub use expected::{Cause, Expected};
pub use injection::{Injection, NAMES};
pub use outcome::{End, Outcome};
pub use rows::csv;
pub use run::run;
pub use scenario::Scenario;
pub use table::table;
pub use totals::{Total, totals};
pub use verdict::Problem;

use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

use crate::random::Random;

/// What a campaign is to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Campaign {
    /// Runs with a fault; there are as many without.
    pub runs: u64,
    /// Seed of the runs' seeds.
    pub seed: u64,
    /// Threads.
    pub jobs: usize,
}

impl Campaign {
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
                done.push((index, replay(seed)));
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

/// The run of a seed with its fault, and without.
#[must_use]
pub fn replay(seed: u64) -> [Outcome; 2] {
    let scenario = Scenario::new(seed);
    [run(scenario.clone(), false), run(scenario, true)]
}

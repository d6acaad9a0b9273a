//! A campaign of faults: many short runs of the controller on simulated stages, in each of which something breaks.
//!
//! A run is what its seed says: a machine with every number up to 30 % off and 0 to 5 kg on it that the controller knows nothing
//! of, a motion, a fault and the tick in which it comes. It is run twice, with the fault and without: the second must
//! raise no alarm. The fault is done to the simulated hardware; the controller reads it through its own drivers.
//!
//! Not here, since no simulated hardware does it within half a second: hot motors, numbers that are none, setpoints out of reach,
//! damaged settings, a full command queue, the watchdog. They have tests of their own.
//!
//! | file | idea |
//! |---|---|
//! | `injection` | what breaks, and what the controller has to say about it |
//! | `scenario`, `random` | from a seed to a run |
//! | `run` | one run |
//! | `truth` | what the machine really did |
//! | `verdict` | whether the controller did what it has to |
//! | `table`, `rows` | what is printed, and written |

mod injection;
mod random;
mod rows;
mod run;
mod scenario;
mod table;
mod truth;
mod verdict;

pub use injection::{Effect, Expected, Injection, NAMES};
pub use rows::write;
pub use run::{End, Outcome, run};
pub use scenario::Scenario;
pub use table::table;
pub use verdict::Problem;

use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;

use crate::devices::Noise;

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
    /// Runs it; `tell` is called with how many runs are done, from any thread. The outcomes are in the order of the runs, each
    /// with its control behind it, whatever the threads do.
    #[must_use]
    pub fn run(&self, tell: impl Fn(u64) + Sync) -> Vec<Outcome> {
        let mut seeds = Noise::new(self.seed);
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
                done.push((index, replay(seed)));
                tell(index + 1);
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

//! How good the ways to a new target in motion are, beside rsruckig:
//! `STATES=10000 cargo bench -p firmware-cost --bench retarget`; without `STATES` there are 1,000 cases a set.
//!
//! A motion of the reference stage is left at a random tick for a new target, at which the stage ends at rest. The
//! duration of the way, in ticks from there to rest, is divided by rsruckig's from the same state to the same target:
//! x, y and theta synchronised, x and y each with 1 / sqrt(2) of the path's limits (the square within their circle),
//! theta with its own. That is what rsruckig could be used for here. It knows neither pivots nor disk; ours keeps them.
//!
//! | set | left | for |
//! |---|---|---|
//! | a | any tick of a line from anywhere to anywhere in the disk | anywhere in the disk, any orientation |
//! | b | a tick of a line in which it first speeds up, within 25 mm of the centre | the same |
//! | c | as a | its target, 0.1 to 3 mm beside; theta the same or up to 1 deg off |
//! | d1 | any tick of a stop, smooth or urgent, out of a line | as a |
//! | d2 | a tick of a jog's ramp, or up to 1 s after it; from rest or out of a line | as a |
//! | d3 | any tick of such a way out of a line, or of a second one out of the first; neither with a stop first | as a |
//! | d4 | as a, turning about a point up to 0.8 track radii off the platform's centre | as a |
//!
//! Any tick is any but the first, at which nothing moves yet. Where one thing or another is said, it is one time in
//! two. Orientations are within one turn, and are gone to as numbers: 350 deg is not -10 deg. A case is drawn from the
//! seed, its set and its number alone, so that planners are given the same ones; only those of d3, which follow ways of
//! the planner under test, differ.
//!
//! "Stop first" are cases in which the stage comes to rest before: their duration is that of the stop, or of what is
//! left of a motion that comes to rest as soon by itself, and of the line from there. "Refused" are those in which that
//! line would leave the disk, as it may about another point: the stage stays there. They have no ratio, nor have those
//! for which rsruckig finds nothing ("rsruckig none").
//!
//! The second table is of a target that goes along a straight path at a steady speed, and is renewed every 20 ms: a new
//! target in motion each time. It is the swing of the speed, (largest - least) / mean over the second half of the path,
//! over 24 directions of paths through the disk, theta at rest. rsruckig has the square here too; "too slow" is where
//! it falls behind for that, which swings no more.
//!
//! In the environment: `SEED`; `LEAD` (see `planner`); `CHECK=1` walks every plan tick by tick against the exact limits
//! and counts those that break one, with the largest parts of the limits; `SET=c CASE=8231` tells that case in figures.
//!
//! | file | idea |
//! |---|---|
//! | `planner` | the planner under test |
//! | `motions`, `phases` | motions under way, and where they ramp up |
//! | `case`, `sets` | a case, and how those of each set are drawn |
//! | `check`, `tally` | what comes of a case and of a set |
//! | `renewed` | the target that is renewed |
//! | `table`, `detail` | what is printed |

#[path = "../../../tests/motion_bench/mod.rs"]
mod motion_bench;

mod case;
mod check;
mod detail;
mod motions;
mod phases;
mod planner;
mod renewed;
mod sets;
mod table;
mod tally;

use check::Walked;
use motion_bench::setting::setting;
use renewed::Swings;
use sets::SETS;
use tally::Tally;

fn main() {
    let seed = setting("SEED", 1);
    match std::env::var("SET") {
        Ok(name) => tell_case(seed, &name),
        Err(_) => print_tables(seed),
    }
}

fn tell_case(seed: u64, name: &str) {
    let set = SETS.iter().find(|set| set.name == name);
    let set = set.expect("SET is a set's name");
    detail::print(&set.case(seed, setting("CASE", 0)));
}

fn print_tables(seed: u64) {
    let states = setting("STATES", 1_000);
    let is_checked = setting("CHECK", 0) != 0;
    let lead = planner::lead_ticks();
    println!("seed {seed}, {states} cases a set, lead {lead} ticks");
    table::head();
    for set in &SETS {
        let mut tally = Tally::new(is_checked);
        for number in 0..states {
            tally.take(number, &set.case(seed, number));
        }
        tally.sort();
        table::row(set, &tally);
    }
    let mut walked = is_checked.then(Walked::default);
    table::swings_head();
    for swings in Swings::all(&mut walked) {
        table::swings_row(&swings);
    }
    table::swings_goal();
    table::walked(walked.as_ref());
}

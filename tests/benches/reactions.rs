//! Way, turn and time to rest of each reaction on the worst machine, worst over a grid of motions: `cargo bench -p tests --bench reactions`.
//! `KEEP=1` writes `firmware/reactions.csv`, from which `firmware/FAULTS.md` has them.

use parallel::{cores, of_all};
use std::fmt::Write;
use tests::reactions::{Motion, ToRest, Trouble, to_rest};

fn main() {
    let motions = Motion::all();
    let runs: Vec<(Trouble, Motion)> = (Trouble::ALL.into_iter())
        .flat_map(|trouble| motions.iter().map(move |motion| (trouble, *motion)))
        .collect();
    let all = of_all(&runs, cores(), |(trouble, motion)| {
        to_rest(*trouble, *motion)
    });
    let mut csv = "reaction,way mm,in,turn deg,in,time ms,in\n".to_owned();
    println!("| reaction | way, mm | turn, deg | time, ms |\n|---|---|---|---|");
    for trouble in Trouble::ALL {
        let of = |value: fn(&ToRest) -> f64| {
            let runs = runs
                .iter()
                .zip(&all)
                .filter(|((one, _), _)| *one == trouble);
            let worst = runs.max_by(|a, b| value(a.1).total_cmp(&value(b.1)));
            let ((_, motion), rest) = worst.expect("motions");
            (value(rest), motion.words())
        };
        let [way, turn, time] = [
            of(|rest| rest.way_mm),
            of(|rest| rest.turn_deg),
            of(|rest| rest.ms),
        ];
        let reaction = trouble.reaction();
        println!(
            "| {reaction} | {:.1} ({}) | {:.1} ({}) | {:.1} ({}) |",
            way.0, way.1, turn.0, turn.1, time.0, time.1
        );
        // A string takes what is written to it.
        let _ = writeln!(
            csv,
            "{reaction},{:.1},{},{:.1},{},{:.1},{}",
            way.0, way.1, turn.0, turn.1, time.0, time.1
        );
    }
    if std::env::var_os("KEEP").is_some() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../firmware/reactions.csv");
        std::fs::write(path, csv).expect("a place for it");
    }
}

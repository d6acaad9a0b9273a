//! The two tables: a line for each set of cases, and for each kind of path.

use crate::check::Walked;
use crate::renewed::Swings;
use crate::sets::Set;
use crate::tally::Tally;

/// Largest swing of the speed, %: the goal of ours.
const SWING_GOAL: f64 = 20.0;

pub fn head() {
    for [a, b, c, d, e, f, g, h, i, j] in [
        ["", "", "rsruckig", "", "stop", "", "", "", "", "worst"],
        [
            "duration over rsruckig's",
            "cases",
            "none",
            "refused",
            "first",
            "median",
            "90 %",
            "99 %",
            "worst",
            "case",
        ],
    ] {
        println!("{a:<30}{b:>6}{c:>10}{d:>9}{e:>7}{f:>9}{g:>8}{h:>8}{i:>8}{j:>7}");
    }
}

pub fn row(set: &Set, tally: &Tally) {
    let name = format!("{:<4}{}", set.name, set.what);
    let Tally {
        cases,
        reference_none,
        refused,
        stops_first,
        ..
    } = tally;
    print!("{name:<30}{cases:>6}{reference_none:>10}{refused:>9}{stops_first:>7}");
    let [median, most, nearly_all, (worst, number)] =
        [0.5, 0.9, 0.99, 1.0].map(|part| tally.at(part));
    let [median, most, nearly_all] = [median.0, most.0, nearly_all.0];
    println!("{median:>9.3}{most:>8.3}{nearly_all:>8.3}{worst:>8.3}{number:>7}");
    if let Some([median, nearly_all, worst]) = set.goal {
        println!(
            "{:<62}{median:>9.2}{nearly_all:>16.2}{worst:>8.2}",
            "    goal"
        );
    }
    walked(tally.walked.as_ref());
}

pub fn swings_head() {
    println!();
    for [a, b, c, d, e, f, g, h, i] in [
        [
            "", "", "rsruckig", "rsruckig", "stop", "ours", "", "rsruckig", "",
        ],
        [
            "swing of the speed, %",
            "paths",
            "none",
            "too slow",
            "first",
            "median",
            "worst",
            "median",
            "worst",
        ],
    ] {
        println!("{a:<30}{b:>6}{c:>10}{d:>9}{e:>7}{f:>9}{g:>8}{h:>10}{i:>8}");
    }
}

pub fn swings_row(swings: &Swings) {
    let Swings {
        mm_s,
        beside_mm,
        paths,
        reference_none,
        stops_first,
        ours,
        reference,
    } = swings;
    let name = format!("{mm_s} mm/s, {beside_mm} mm off the centre");
    let too_slow = paths - reference_none - reference.len();
    print!("{name:<30}{paths:>6}{reference_none:>10}{too_slow:>9}{stops_first:>7}");
    let [median, worst] = [0.5, 1.0].map(|part| percent(ours, part));
    print!("{median:>9.1}{worst:>8.1}");
    let [median, worst] = [0.5, 1.0].map(|part| percent(reference, part));
    println!("{median:>10.1}{worst:>8.1}");
}

pub fn swings_goal() {
    println!("{:<62}{SWING_GOAL:>17.1}", "    goal");
}

fn percent(swings: &[f64], part: f64) -> f64 {
    let last = swings.len().saturating_sub(1);
    let swing = swings.get((last as f64 * part) as usize);
    swing.map_or(f64::NAN, |swing| swing * 100.0)
}

pub fn walked(walked: Option<&Walked>) {
    let Some(Walked {
        plans,
        broken,
        worst,
    }) = walked
    else {
        return;
    };
    let [speed, acceleration, jerk, rate, pivots] = worst.shares();
    println!(
        "    {plans} plans walked, {broken} over a limit; largest parts: speed {speed:.4}, \
         acceleration {acceleration:.4}, jerk {jerk:.4}, pivots {rate:.4} and {pivots:.4}"
    );
}

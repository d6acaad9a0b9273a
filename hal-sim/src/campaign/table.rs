//! The campaign as two tables, a row a fault: what came of it, and what nobody has noticed.

use std::collections::BTreeMap;

use super::injection::NAMES;
use super::outcome::Outcome;
use super::remedy::REMEDIES;
use super::totals::{Spread, Total, totals};

const HEAD: [&str; 2] = [
    "                                     latency, ticks  way to rest, mm       turn to rest, deg     blows  energy of a blow, J   end state",
    "fault                 runs det. wrong median worst   median / 99 % / worst median / 99 % / worst count  median / 99 % / worst braked/released/moving",
];
const UNSEEN: [&str; 2] = [
    "What was not detected     runs: inputs differ by less than        platform off its path, mm",
    "                          noise / another day / push / by more    median / 99 % / worst      what a builder adds for it",
];

/// The table, with a row for the runs without fault; then that of what was not detected.
#[must_use]
pub fn table(outcomes: &[Outcome]) -> String {
    let totals = totals(outcomes);
    let mut text = format!("{}\n{}\n", HEAD[0], HEAD[1]);
    for total in &totals {
        text += &row(total);
    }
    text += &names(outcomes);
    text += &format!("\n{}\n{}\n", UNSEEN[0], UNSEEN[1]);
    for (index, total) in totals.iter().enumerate().take(NAMES.len()) {
        if total.within_noise + total.within_days + total.within_push + total.beyond > 0 {
            text += &unseen(total, REMEDIES[index]);
        }
    }
    text
}

fn unseen(total: &Total, remedy: &str) -> String {
    let runs = format!(
        "{} / {} / {} / {}",
        total.within_noise, total.within_days, total.within_push, total.beyond
    );
    let off = spread(&total.undetected_deviation_mm);
    format!("{:<25} {runs:<39} {off:<26} {remedy}\n", total.fault)
}

fn spread(spread: &Spread) -> String {
    let Spread {
        median,
        most,
        worst,
    } = spread;
    format!("{median:.2} / {most:.2} / {worst:.2}")
}

/// Which faults were told under more than one name, and how often under each.
fn names(outcomes: &[Outcome]) -> String {
    let mut text = String::new();
    for (index, name) in NAMES.iter().enumerate() {
        let mut told: BTreeMap<&str, u32> = BTreeMap::new();
        let of_it = (outcomes.iter())
            .filter(|outcome| !outcome.is_control && outcome.scenario.injection.index() == index);
        for outcome in of_it.filter(|outcome| outcome.detected().is_some()) {
            let name = (outcome.fault).map_or("an event", |fault| fault.kind.text());
            *told.entry(name).or_default() += 1;
        }
        if told.len() > 1 {
            let each: Vec<_> = (told.iter())
                .map(|(kind, count)| format!("{kind} {count}"))
                .collect();
            text += &format!("{name} is told as: {}\n", each.join(", "));
        }
    }
    text
}

fn row(total: &Total) -> String {
    let Total {
        fault,
        runs,
        detected,
        wrong,
        latency_ticks,
        blows,
        ..
    } = total;
    let latency = format!("{:>6.0} {:>5.0}", latency_ticks.median, latency_ticks.worst);
    let [way, turn, blow] = [&total.way_mm, &total.turn_deg, &total.blow_j].map(spread);
    let ends = format!(
        "{}/{}/{}",
        total.ended_braked, total.ended_released, total.ended_moving
    );
    format!(
        "{fault:<20} {runs:>5} {detected:>4} {wrong:>5} {latency}   {way:<21} {turn:<21} {blows:>5}  {blow:<21} {ends}\n"
    )
}

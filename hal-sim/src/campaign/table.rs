//! The campaign as a table, a row a fault.

use std::collections::BTreeMap;

use super::injection::NAMES;
use super::outcome::Outcome;
use super::totals::{Total, totals};

const HEAD: [&str; 2] = [
    "                                     latency, ticks  deviation  distance still        turned  end state               overruns",
    "fault                runs quiet  det. median worst   worst, mm  median/worst, mm  worst, deg  braked/released/moving  count/worst, mm",
];

/// The table, with a row for the runs without fault.
#[must_use]
pub fn table(outcomes: &[Outcome]) -> String {
    let mut text = format!("{}\n{}\n", HEAD[0], HEAD[1]);
    for total in &totals(outcomes) {
        text += &row(total);
    }
    text + &names(outcomes)
}

/// Which faults were told under more than one name, and how often under each.
fn names(outcomes: &[Outcome]) -> String {
    let mut text = String::new();
    for (index, name) in NAMES.iter().enumerate() {
        let mut told: BTreeMap<&str, u32> = BTreeMap::new();
        let of_it = (outcomes.iter())
            .filter(|outcome| !outcome.is_control && outcome.scenario.injection.index() == index);
        for fault in of_it.filter_map(|outcome| outcome.fault) {
            *told.entry(fault.kind.text()).or_default() += 1;
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
        no_effect,
        detected,
        latency_median_ticks: latency,
        latency_worst_ticks: worst_latency,
        deviation_worst_mm: deviation,
        turned_worst_deg: turned,
        ..
    } = total;
    let way = format!(
        "{:.2}/{:.2}",
        total.travelled_median_mm, total.travelled_worst_mm
    );
    let ends = format!(
        "{}/{}/{}",
        total.ended_braked, total.ended_released, total.ended_moving
    );
    let overruns = format!("{}/{:.2}", total.overruns, total.overrun_worst_mm);
    format!(
        "{fault:<19} {runs:>5} {no_effect:>5} {detected:>5} {latency:>6.0} {worst_latency:>5.0} {deviation:>11.2}  {way:<16}  {turned:>10.2}  {ends:<22}  {overruns}\n"
    )
}

//! The campaign as a table, a row a fault.

use std::collections::BTreeMap;

use super::injection::NAMES;
use super::run::{End, Outcome};

const HEAD: [&str; 2] = [
    "                                     latency, ticks  deviation  distance still        turned  end state               overruns",
    "fault                runs quiet  det. median worst   worst, mm  median/worst, mm  worst, deg  braked/released/moving  count/worst, mm",
];

/// The table, with a row for the runs without fault.
#[must_use]
pub fn table(outcomes: &[Outcome]) -> String {
    let mut text = format!("{}\n{}\n", HEAD[0], HEAD[1]);
    for (index, name) in NAMES.iter().enumerate() {
        let of_it: Vec<_> = (outcomes.iter())
            .filter(|outcome| !outcome.is_control && outcome.scenario.injection.index() == index)
            .collect();
        text += &row(name, &of_it);
    }
    let control: Vec<_> = (outcomes.iter())
        .filter(|outcome| outcome.is_control)
        .collect();
    text += &row("none (control)", &control);
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

fn row(name: &str, outcomes: &[&Outcome]) -> String {
    let detected = outcomes
        .iter()
        .filter(|outcome| outcome.detected().is_some());
    let quiet = outcomes
        .iter()
        .filter(|o| o.detected().is_none() && o.effect.is_none());
    let [latency, worst_latency] = median_and_worst(
        outcomes
            .iter()
            .filter_map(|o| o.latency_ticks())
            .map(|t| t as f64),
    );
    let [_, deviation] = median_and_worst(outcomes.iter().map(|o| o.deviation_mm));
    let faulted = || (outcomes.iter()).filter(|outcome| outcome.detected().is_some());
    let [way, longest] = median_and_worst(faulted().map(|outcome| outcome.travelled.0));
    let [_, turned] = median_and_worst(faulted().map(|outcome| outcome.travelled.1));
    let ended = |end: End| outcomes.iter().filter(|outcome| outcome.end == end).count();
    let overruns: Vec<f64> = (outcomes.iter())
        .map(|outcome| outcome.overrun_mm)
        .filter(|&mm| mm > 0.0)
        .collect();
    let [_, deepest] = median_and_worst(overruns.iter().copied());
    let way = format!("{way:.2}/{longest:.2}");
    let ends = [End::Braked, End::Released, End::Moving].map(ended);
    let ends = format!("{}/{}/{}", ends[0], ends[1], ends[2]);
    let overruns = format!("{}/{deepest:.2}", overruns.len());
    format!(
        "{name:<19} {:>5} {:>5} {:>5} {latency:>6.0} {worst_latency:>5.0} {deviation:>11.2}  {way:<16}  {turned:>10.2}  {ends:<22}  {overruns}\n",
        outcomes.len(),
        quiet.count(),
        detected.count(),
    )
}

fn median_and_worst(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    let at = |place: Option<&f64>| place.copied().unwrap_or(0.0);
    [at(sorted.get(sorted.len() / 2)), at(sorted.last())]
}

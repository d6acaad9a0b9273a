//! What the runs of each fault amount to.

use serde::Serialize;

use super::injection::NAMES;
use super::outcome::{End, Outcome};

/// The runs with one fault, or those without. Units are in the names; medians and worsts of no run are 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Total {
    /// Which fault.
    pub fault: &'static str,
    /// All runs with it.
    pub runs: usize,
    /// Those of them that were not detected and had no effect.
    pub no_effect: usize,
    /// Those that were detected.
    pub detected: usize,
    /// From the effect to its detection.
    pub latency_median_ticks: f64,
    /// The same, at worst.
    pub latency_worst_ticks: f64,
    /// Of the platform from its path, at worst.
    pub deviation_worst_mm: f64,
    /// Way of the centre from the fault to rest, where one was detected.
    pub travelled_median_mm: f64,
    /// The same, at worst.
    pub travelled_worst_mm: f64,
    /// Turn of the platform from the fault to rest, at worst.
    pub turned_worst_deg: f64,
    /// Runs that ended at rest, bridges braking.
    pub ended_braked: usize,
    /// At rest, bridges released.
    pub ended_released: usize,
    /// Still turning.
    pub ended_moving: usize,
    /// Runs in which a guide met its end.
    pub overruns: usize,
    /// How far it was pressed in, at worst.
    pub overrun_worst_mm: f64,
}

/// One of each fault, in their order, and at last the runs without.
#[must_use]
pub fn totals(outcomes: &[Outcome]) -> Vec<Total> {
    let with = |index: usize| {
        (outcomes.iter()).filter(move |outcome| {
            !outcome.is_control && outcome.scenario.injection.index() == index
        })
    };
    let control = outcomes.iter().filter(|outcome| outcome.is_control);
    (NAMES.iter().enumerate())
        .map(|(index, name)| total(name, &with(index).collect::<Vec<_>>()))
        .chain([total("none (control)", &control.collect::<Vec<_>>())])
        .collect()
}

fn total(fault: &'static str, outcomes: &[&Outcome]) -> Total {
    let all = || outcomes.iter();
    let detected = || all().filter(|outcome| outcome.detected().is_some());
    let [latency_median_ticks, latency_worst_ticks] = median_and_worst(
        all()
            .filter_map(|outcome| outcome.latency_ticks())
            .map(|ticks| ticks as f64),
    );
    let [_, deviation_worst_mm] = median_and_worst(all().map(|outcome| outcome.deviation_mm));
    let [travelled_median_mm, travelled_worst_mm] =
        median_and_worst(detected().map(|outcome| outcome.travelled.0));
    let [_, turned_worst_deg] = median_and_worst(detected().map(|outcome| outcome.travelled.1));
    let ended = |end: End| all().filter(|outcome| outcome.end == end).count();
    let overruns = || {
        all()
            .map(|outcome| outcome.overrun_mm)
            .filter(|&mm| mm > 0.0)
    };
    let [_, overrun_worst_mm] = median_and_worst(overruns());
    Total {
        fault,
        runs: outcomes.len(),
        no_effect: all()
            .filter(|outcome| outcome.detected().is_none() && outcome.effect.is_none())
            .count(),
        detected: detected().count(),
        latency_median_ticks,
        latency_worst_ticks,
        deviation_worst_mm,
        travelled_median_mm,
        travelled_worst_mm,
        turned_worst_deg,
        ended_braked: ended(End::Braked),
        ended_released: ended(End::Released),
        ended_moving: ended(End::Moving),
        overruns: overruns().count(),
        overrun_worst_mm,
    }
}

fn median_and_worst(values: impl Iterator<Item = f64>) -> [f64; 2] {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    let at = |place: Option<&f64>| place.copied().unwrap_or(0.0);
    [at(sorted.get(sorted.len() / 2)), at(sorted.last())]
}

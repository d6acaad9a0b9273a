//! What the runs of each fault amount to.

use serde::Serialize;

use super::injection::NAMES;
use super::outcome::{End, Known, Outcome};
use super::rest::ToRest;

/// The runs with one fault, or those without. Units are in the names; those of no run are 0.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Total {
    /// Which fault.
    pub fault: &'static str,
    /// All runs with it.
    pub runs: usize,
    /// Those that were detected.
    pub detected: usize,
    /// Those of the others in which the controller's inputs differ from the sound run's by less than noise.
    pub within_noise: usize,
    /// Those in which they differ by more, but by less than the sound machine's on another day.
    pub within_days: usize,
    /// Those in which they differ by more, as they would if somebody pushed.
    pub within_push: usize,
    /// Those in which they differ by more, and nothing has passed a threshold.
    pub beyond: usize,
    /// Those that are not as they should be.
    pub wrong: usize,
    /// From the effect to its detection.
    pub latency_ticks: Spread,
    /// Way of the centre from when the reaction had to begin to rest.
    pub way_mm: Spread,
    /// Turn of the platform.
    pub turn_deg: Spread,
    /// Energy of the hardest blow against a guide's end or a carriage, of runs that have one.
    pub blow_j: Spread,
    /// Blows.
    pub blows: usize,
    /// Distance of the platform from its path, of runs that were detected and of the others.
    pub deviation_mm: Spread,
    /// See above.
    pub undetected_deviation_mm: Spread,
    /// Runs that ended at rest, bridges braking.
    pub ended_braked: usize,
    /// At rest, bridges released.
    pub ended_released: usize,
    /// Still turning.
    pub ended_moving: usize,
}

/// Median, 99th of a hundred, and worst.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// Median.
    pub median: f64,
    /// What 99 of 100 stay under.
    pub most: f64,
    /// Worst.
    pub worst: f64,
}

impl Spread {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut sorted: Vec<f64> = values.collect();
        sorted.sort_by(f64::total_cmp);
        let at = |place: usize| sorted.get(place).copied().unwrap_or(0.0);
        let last = sorted.len().saturating_sub(1);
        Self {
            median: at(sorted.len() / 2),
            most: at(last.min(sorted.len() * 99 / 100)),
            worst: at(last),
        }
    }
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
    let undetected = || all().filter(|outcome| outcome.detected().is_none());
    let ended = |end: End| all().filter(|outcome| outcome.end == end).count();
    let reacted = |value: fn(&ToRest) -> f64| {
        let reactions = all().filter(|outcome| outcome.bound.is_some());
        Spread::of(reactions.map(|outcome| value(&outcome.reaction)))
    };
    let blows = || {
        all()
            .map(|outcome| outcome.reaction.blow_j)
            .filter(|&joules| joules > 0.0)
    };
    let known =
        |outcome: &Outcome| (outcome.differs).map_or(Known::Beyond, |differs| differs.known());
    let within = |within: Known| {
        undetected()
            .filter(|outcome| known(outcome) == within)
            .count()
    };
    Total {
        fault,
        runs: outcomes.len(),
        detected: detected().count(),
        within_noise: within(Known::WithinNoise),
        within_days: within(Known::WithinDays),
        within_push: within(Known::WithinPush),
        beyond: (undetected().filter(|outcome| outcome.effect.is_none()))
            .filter(|outcome| known(outcome) == Known::Beyond)
            .count(),
        wrong: all().filter(|outcome| outcome.problem().is_some()).count(),
        latency_ticks: Spread::of(
            all()
                .filter_map(|outcome| outcome.latency_ticks())
                .map(|ticks| ticks as f64),
        ),
        way_mm: reacted(|it| it.way_mm),
        turn_deg: reacted(|it| it.turn_deg),
        blow_j: Spread::of(blows()),
        blows: blows().count(),
        deviation_mm: Spread::of(detected().map(|outcome| outcome.deviation_mm)),
        undetected_deviation_mm: Spread::of(undetected().map(|outcome| outcome.deviation_mm)),
        ended_braked: ended(End::Braked),
        ended_released: ended(End::Released),
        ended_moving: ended(End::Moving),
    }
}

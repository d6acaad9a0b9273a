//! All runs as a CSV table.

use std::io;

use ::csv::Writer;

use super::injection::NAMES;
use super::outcome::Outcome;

const COLUMNS: [&str; 26] = [
    "seed",
    "fault",
    "pivot",
    "tick",
    "effect_tick",
    "latched",
    "latched_pivot",
    "latched_tick",
    "latency_ticks",
    "deviation_mm",
    "way_mm",
    "way_bound_mm",
    "turn_deg",
    "turn_bound_deg",
    "off_path_mm",
    "off_path_bound_mm",
    "depth_mm",
    "depth_bound_mm",
    "blow_j",
    "blow_bound_j",
    "inputs_differ_than_noise",
    "inputs_differ_than_another_day",
    "inputs_differ_than_push",
    "push_n",
    "end",
    "problem",
];

/// A row for each run, with a line of headings.
///
/// # Errors
/// None that is known: it is made in memory.
pub fn csv(outcomes: &[Outcome]) -> io::Result<Vec<u8>> {
    let mut writer = Writer::from_writer(Vec::new());
    writer.write_record(COLUMNS)?;
    for outcome in outcomes {
        writer.write_record(row(outcome))?;
    }
    writer.into_inner().map_err(|error| error.into_error())
}

fn row(outcome: &Outcome) -> [String; 26] {
    let scenario = &outcome.scenario;
    let fault = outcome.fault.as_ref();
    let told = |value: Option<u64>| value.map_or_else(String::new, |value| value.to_string());
    let times = |value: Option<f64>| value.map_or_else(String::new, |it| format!("{it:.2}"));
    let mm = |value: f64| format!("{value:.4}");
    let (was, most) = (outcome.reaction, outcome.bound.unwrap_or_default());
    let name = match outcome.is_control {
        true => "none",
        false => NAMES[scenario.injection.index()],
    };
    [
        scenario.seed.to_string(),
        name.to_owned(),
        (scenario.axis + 1).to_string(),
        scenario.at.to_string(),
        told(outcome.effect),
        fault.map_or_else(String::new, |fault| fault.kind.text().to_owned()),
        told(
            fault
                .and_then(|fault| fault.pivot)
                .map(|pivot| u64::from(pivot) + 1),
        ),
        told(fault.map(|fault| fault.tick)),
        told(outcome.latency_ticks()),
        mm(outcome.deviation_mm),
        mm(was.way_mm),
        mm(most.way_mm),
        mm(was.turn_deg),
        mm(most.turn_deg),
        mm(was.deviation_mm),
        mm(most.deviation_mm),
        mm(was.depth_mm),
        mm(most.depth_mm),
        mm(was.blow_j),
        mm(most.blow_j),
        times(outcome.differs.map(|it| it.than_noise)),
        times(outcome.differs.map(|it| it.than_another_day)),
        times(outcome.differs.map(|it| it.than_push)),
        times(outcome.differs.map(|it| it.push_n)),
        outcome.end.text().to_owned(),
        (outcome.problem()).map_or_else(String::new, |problem| problem.to_string()),
    ]
}

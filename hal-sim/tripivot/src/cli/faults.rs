//! `tripivot faults`: the campaign of faults.

use std::io::{self, Write};
use std::num::NonZero;
use std::process::ExitCode;
use std::thread::available_parallelism;

use super::arguments::Faults;
use super::error::CliError;
use drawing::Progress;
use hal_sim::campaign::{Campaign, Outcome, replay, table, write};

/// Runs that are told one by one; the rest is counted.
const TOLD: usize = 30;

pub(super) fn run(arguments: &Faults) -> Result<ExitCode, CliError> {
    let mut text = String::new();
    let outcomes = match arguments.only {
        Some(seed) => {
            let outcomes = replay(seed);
            text += &story(&outcomes[0]);
            outcomes.to_vec()
        }
        None => campaign(arguments, &mut text),
    };
    if let Some(path) = &arguments.out {
        write(path, &outcomes).map_err(|error| {
            CliError::Value(format!("{}: cannot be written: {error}", path.display()))
        })?;
    }
    let bad: Vec<_> = (outcomes.iter())
        .filter(|outcome| arguments.only.is_some() || outcome.problem().is_some())
        .collect();
    for outcome in bad.iter().take(TOLD) {
        text += &format!("{outcome}\n");
    }
    (io::stdout().write_all(text.as_bytes())).map_err(CliError::output)?;
    match (outcomes.iter())
        .filter(|outcome| outcome.problem().is_some())
        .count()
    {
        0 => Ok(ExitCode::SUCCESS),
        count => Err(CliError::Fault(format!(
            "{count} runs are not as they should be; --only SEED runs one again"
        ))),
    }
}

fn campaign(arguments: &Faults, text: &mut String) -> Vec<Outcome> {
    let jobs = arguments
        .jobs
        .unwrap_or_else(|| available_parallelism().map_or(1, NonZero::get));
    let campaign = Campaign {
        runs: u64::from(arguments.runs),
        seed: arguments.seed,
        jobs,
    };
    let progress = Progress::new(campaign.runs, arguments.quiet);
    let outcomes = campaign.run(|runs| progress.tell(runs, "runs"));
    let wall_s = progress.finish();
    let count = |wanted: bool| {
        let mut problems = outcomes
            .iter()
            .filter(|outcome| outcome.problem().is_some());
        let of_them = problems.by_ref();
        of_them
            .filter(|outcome| outcome.is_control == wanted)
            .count()
    };
    *text += &format!(
        "{}\n{} runs with a fault, {} not as they should be; {} without, {} of them with an alarm; seed {}, {wall_s:.0} s\n",
        table(&outcomes),
        campaign.runs,
        count(false),
        campaign.runs,
        count(true),
        campaign.seed,
    );
    outcomes
}

/// What a run is, for somebody who looks for the reason of its end.
fn story(outcome: &Outcome) -> String {
    let scenario = &outcome.scenario;
    let [x, y, theta] = scenario.start;
    let mut text = format!(
        "start {:.3} {:.3} mm, {:.3} deg; payload {:.2} kg\n",
        x * 1e3,
        y * 1e3,
        theta.to_degrees(),
        scenario.stage.plant.payload.mass_kg
    );
    for (tick, line) in &scenario.lines {
        text += &format!("tick {tick:>5}  {line}\n");
    }
    text
}

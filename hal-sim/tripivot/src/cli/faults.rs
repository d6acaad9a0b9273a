//! `tripivot faults`: the campaign of faults.

use std::collections::BTreeSet;
use std::io::{self, Write};
use std::num::NonZero;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::available_parallelism;
use std::time::Instant;

use serde::Serialize;

use super::arguments::Faults;
use super::error::CliError;
use super::json;
use super::signal::until_signal;
use drawing::{Progress, WholeFile};
use hal_sim::campaign::{
    Campaign, Commissioned, NAMES, Outcome, Total, csv, replay, table, totals,
};

/// Runs that are told one by one; the rest is counted.
const TOLD: usize = 30;

/// What has been run.
struct Runs {
    /// With a campaign: the runs with a fault, and its seed.
    campaign: Option<(u64, u64)>,
    wall_s: f64,
    outcomes: Vec<Outcome>,
}

/// What a campaign is told as with `--json`.
#[derive(Serialize)]
struct Document<'a> {
    runs: Option<u64>,
    seed: Option<u64>,
    wall_s: f64,
    faults: Vec<Total>,
    /// Runs with a fault that are not as they should be.
    missed: usize,
    /// Runs without, with an alarm.
    alarms: usize,
    told: Vec<Told<'a>>,
}

/// One run.
#[derive(Serialize)]
struct Told<'a> {
    seed: u64,
    is_control: bool,
    fault: &'a str,
    tick: u64,
    latched: Option<&'static str>,
    latched_tick: Option<u64>,
    latency_ticks: Option<u64>,
    problem: Option<String>,
    text: String,
}

pub(super) fn run(arguments: &Faults) -> Result<ExitCode, CliError> {
    let unwritable = |error| CliError::unwritable(arguments.out.as_deref(), &error);
    // What cannot be written is found out before the runs, not after them.
    let file = (arguments.out.as_deref().map(WholeFile::create).transpose()).map_err(unwritable)?;
    let machines = match &arguments.commissioned {
        Some(folder) => Commissioned::all_of(folder)?,
        None => Vec::new(),
    };
    let runs = match arguments.only {
        Some(seed) => alone(seed, &machines),
        None => campaign(arguments, &machines, &*until_signal()?),
    };
    if arguments.json {
        json::print(&runs.document())?;
    } else {
        (io::stdout().write_all(runs.text().as_bytes())).map_err(CliError::output)?;
    }
    if let Some(file) = file {
        let table = csv(&runs.outcomes).map_err(CliError::output)?;
        file.finish(&table).map_err(unwritable)?;
    }
    match runs.news(&arguments.known) {
        0 => Ok(ExitCode::SUCCESS),
        count => Err(CliError::Fault(format!(
            "{count} seeds are not as they should be, or not as they were known; --only SEED runs one again"
        ))),
    }
}

fn alone(seed: u64, machines: &[Commissioned]) -> Runs {
    let begun = Instant::now();
    Runs {
        campaign: None,
        outcomes: replay(seed, machines).to_vec(),
        wall_s: begun.elapsed().as_secs_f64(),
    }
}

/// Ctrl-C ends it; what has been run until then is told.
fn campaign(arguments: &Faults, machines: &[Commissioned], stop: &AtomicBool) -> Runs {
    let jobs = arguments
        .jobs
        .unwrap_or_else(|| available_parallelism().map_or(1, NonZero::get));
    let campaign = Campaign {
        runs: u64::from(arguments.runs),
        seed: arguments.seed,
        jobs,
        machines,
    };
    let progress = Progress::new(campaign.runs, arguments.quiet);
    let outcomes = campaign.run(|runs| {
        progress.tell(runs, "runs");
        !stop.load(Ordering::Relaxed)
    });
    Runs {
        // Each has its control.
        campaign: Some((outcomes.len() as u64 / 2, campaign.seed)),
        outcomes,
        wall_s: progress.finish(),
    }
}

impl Runs {
    /// How many are not as they should be, of those without a fault or with one.
    fn wrong(&self, is_control: bool) -> usize {
        (self.outcomes.iter())
            .filter(|outcome| outcome.is_control == is_control && outcome.problem().is_some())
            .count()
    }

    /// How many seeds have a problem that is not known, or have no more the one that is.
    fn news(&self, known: &[u64]) -> usize {
        let seed = |outcome: &Outcome| outcome.scenario.seed;
        let wrong: BTreeSet<u64> = (self.outcomes.iter())
            .filter(|outcome| outcome.problem().is_some())
            .map(seed)
            .collect();
        wrong
            .symmetric_difference(&known.iter().copied().collect())
            .count()
    }

    /// Those that somebody has to look at: a single one in any case.
    fn told(&self) -> impl Iterator<Item = &Outcome> {
        let is_alone = self.campaign.is_none();
        (self.outcomes.iter()).filter(move |outcome| is_alone || outcome.problem().is_some())
    }

    fn text(&self) -> String {
        let mut text = match self.campaign {
            None => story(&self.outcomes[0]),
            Some((runs, seed)) => format!(
                "{}\n{runs} runs with a fault, {} not as they should be; {runs} without, {} of them with an alarm; seed {seed}, {:.0} s\n",
                table(&self.outcomes),
                self.wrong(false),
                self.wrong(true),
                self.wall_s,
            ),
        };
        for outcome in self.told().take(TOLD) {
            text += &format!("{outcome}\n");
        }
        text
    }

    fn document(&self) -> Document<'_> {
        Document {
            runs: self.campaign.map(|(runs, _)| runs),
            seed: self.campaign.map(|(_, seed)| seed),
            wall_s: self.wall_s,
            faults: totals(&self.outcomes),
            missed: self.wrong(false),
            alarms: self.wrong(true),
            told: self.told().map(told).collect(),
        }
    }
}

fn told(outcome: &Outcome) -> Told<'_> {
    let scenario = &outcome.scenario;
    Told {
        seed: scenario.seed,
        is_control: outcome.is_control,
        fault: match outcome.is_control {
            true => "none",
            false => NAMES[scenario.injection.index()],
        },
        tick: scenario.at,
        latched: outcome.fault.map(|fault| fault.kind.text()),
        latched_tick: outcome.fault.map(|fault| fault.tick),
        latency_ticks: outcome.latency_ticks(),
        problem: outcome.problem().map(|problem| problem.to_string()),
        text: outcome.to_string(),
    }
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

//! `tripivot record`: a record of a controller that runs already, as a table and a picture.

use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::process::ExitCode;
use std::time::Duration;

use serde::Serialize;

use super::arguments::RecordRun;
use super::error::CliError;
use super::json;
use super::view::endpoint;
use desk::record::{Order, Record, TABLES, Trigger, record};
use drawing::claim_folder;

/// The files of a record.
const FILES: [&str; 3] = ["record.csv", "record.svg", "record.png"];

/// What a record is told as with `--json`.
#[derive(Serialize)]
struct Document<'a> {
    controller: String,
    sent: Option<&'a str>,
    points: usize,
    period_us: f64,
    signals: Vec<Signal<'a>>,
    folder: String,
}

/// Where a recorded signal lies, in the unit that its name ends with.
#[derive(Serialize)]
struct Signal<'a> {
    name: &'a str,
    lowest: f64,
    highest: f64,
}

pub(super) fn run(arguments: &RecordRun) -> Result<ExitCode, CliError> {
    let order = order(arguments)?;
    let is_new = !arguments.out.exists();
    claim_folder(&arguments.out, &FILES)?;
    let record = record(&order).inspect_err(|_| {
        if is_new {
            // It is empty: what it was made for has not come.
            let _ = fs::remove_dir(&arguments.out);
        }
    })?;
    let heading = match &order.send {
        Some(line) => format!("{}: {line}", order.endpoint),
        None => order.endpoint.to_string(),
    };
    record.write(&heading, &arguments.out)?;
    let document = document(&order, &record, &arguments.out);
    if arguments.json {
        json::print(&document)?;
    } else {
        (io::stdout().write_all(text(&document).as_bytes())).map_err(CliError::output)?;
    }
    Ok(ExitCode::SUCCESS)
}

fn order(arguments: &RecordRun) -> Result<Order, CliError> {
    if arguments.tables.len() > TABLES {
        return Err(CliError::Value(format!(
            "{} signals: a record has {TABLES} tables",
            arguments.tables.len()
        )));
    }
    let trigger = match (arguments.trigger, &arguments.send) {
        (Some(trigger), _) => trigger,
        (None, Some(_)) => Trigger::Move,
        (None, None) => Trigger::Now,
    };
    Ok(Order {
        endpoint: endpoint(&arguments.controller)?,
        tables: arguments.tables.clone(),
        every: arguments.every,
        points: arguments.points,
        before: arguments.before,
        trigger,
        send: arguments.send.clone(),
        patience: Duration::from_secs_f64(arguments.patience),
        quiet: arguments.quiet,
    })
}

fn document<'a>(order: &'a Order, record: &'a Record, folder: &Path) -> Document<'a> {
    let signal = |(column, name): (usize, &'a String)| {
        let values = || record.rows.iter().map(|row| row[column]);
        Signal {
            name,
            lowest: values().fold(f64::INFINITY, f64::min),
            highest: values().fold(f64::NEG_INFINITY, f64::max),
        }
    };
    Document {
        controller: order.endpoint.to_string(),
        sent: order.send.as_deref(),
        points: record.rows.len(),
        period_us: record.period_s * 1e6,
        signals: record.names.iter().enumerate().map(signal).collect(),
        folder: folder.display().to_string(),
    }
}

/// Length of the record, where each signal lies, and where to look.
fn text(document: &Document<'_>) -> String {
    let (points, period_us) = (document.points, document.period_us);
    let mut text = format!("{points} points, {period_us:.0} us apart\n");
    for Signal {
        name,
        lowest,
        highest,
    } in &document.signals
    {
        text += &format!("{name:<36}{lowest:>16.9} to {highest:.9}\n");
    }
    text + &format!("{:<22}{}\n", "table and picture in", document.folder)
}

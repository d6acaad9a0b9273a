//! `tripivot record`: a record of a controller that runs already, as a table and a picture.

use std::io::{self, Write};
use std::process::ExitCode;
use std::time::Duration;

use super::arguments::RecordRun;
use super::error::CliError;
use super::view::endpoint;
use desk::record::{Order, Record, TABLES, Trigger, record};
use drawing::make_folder;

pub(super) fn run(arguments: &RecordRun) -> Result<ExitCode, CliError> {
    let order = order(arguments)?;
    make_folder(&arguments.out)?;
    let record = record(&order)?;
    let heading = match &order.send {
        Some(line) => format!("{}: {line}", order.endpoint),
        None => order.endpoint.to_string(),
    };
    record.write(&heading, &arguments.out)?;
    let text = summary(&record)
        + &format!(
            "{:<22}{}\n",
            "table and picture in",
            arguments.out.display()
        );
    (io::stdout().write_all(text.as_bytes())).map_err(CliError::output)?;
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

/// Length of the record, and where each signal lies.
fn summary(record: &Record) -> String {
    let (points, period_us) = (record.rows.len(), record.period_s * 1e6);
    let mut text = format!("{points} points, {period_us:.0} us apart\n");
    for (column, name) in record.names.iter().enumerate() {
        let values = record.rows.iter().map(|row| row[column]);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        text += &format!("{name:<36}{low:>16.9} to {high:.9}\n");
    }
    text
}

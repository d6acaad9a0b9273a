//! Three numbers in, three numbers out: once from the command line, or row by row from standard input to standard output.

use std::io::{self, BufRead, BufWriter, Write};
use std::process::ExitCode;

use super::error::CliError;
use super::units::decimals;

/// Turns one row of numbers into another, or says in words why it cannot.
pub(super) type Convert = fn([f64; 3]) -> Result<[f64; 3], String>;

/// Converts the `numbers` of the command line, or with `csv` every row of standard input.
pub(super) fn convert(numbers: &[f64], csv: bool, convert: Convert) -> Result<ExitCode, CliError> {
    if csv {
        stream(io::stdin().lock(), io::stdout().lock(), convert)?;
    } else {
        let numbers = <[f64; 3]>::try_from(numbers)
            .map_err(|_| CliError::Value("three numbers are needed".to_owned()))?;
        let line = convert(numbers)
            .map_err(CliError::Value)?
            .map(decimals)
            .join(" ");
        writeln!(io::stdout(), "{line}").map_err(CliError::output)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Stops at the first bad row; the rows before it are written. Split here and not by a CSV library, which loses count of
/// the lines at empty ones: cells that are all numbers hold no commas.
fn stream(input: impl BufRead, output: impl Write, convert: Convert) -> Result<(), CliError> {
    let mut output = BufWriter::new(output);
    let result = (input.lines().zip(1..))
        .try_for_each(|(line, row)| one_row(row, line, convert, &mut output));
    output.flush().map_err(CliError::output)?;
    result
}

fn one_row(
    row: u64,
    line: io::Result<String>,
    convert: Convert,
    output: &mut impl Write,
) -> Result<(), CliError> {
    let at_row = |reason| CliError::Row { row, reason };
    let line = line.map_err(|error| match error.kind() {
        io::ErrorKind::InvalidData => at_row("not UTF-8 text".to_owned()),
        _ => CliError::Input(error),
    })?;
    let line = line.trim();
    if line.is_empty() || line.starts_with('#') || (row == 1 && is_heading(line)) {
        return Ok(());
    }
    let results = convert(numbers(line).map_err(at_row)?).map_err(at_row)?;
    writeln!(output, "{}", results.map(decimals).join(",")).map_err(CliError::output)
}

fn cells(line: &str) -> impl Iterator<Item = &str> {
    line.split(',').map(|cell| cell.trim().trim_matches('"'))
}

/// A first line without a single number in it.
fn is_heading(line: &str) -> bool {
    cells(line).all(|cell| cell.parse::<f64>().is_err())
}

fn numbers(line: &str) -> Result<[f64; 3], String> {
    let count = cells(line).count();
    if count != 3 {
        return Err(format!("{count} values where 3 are expected"));
    }
    let mut numbers = [0.0; 3];
    for (number, cell) in numbers.iter_mut().zip(cells(line)) {
        *number = (cell.parse()).map_err(|_| format!("'{cell}' is not a number"))?;
    }
    Ok(numbers)
}

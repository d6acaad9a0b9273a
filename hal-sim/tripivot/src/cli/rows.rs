//! Three numbers in, three numbers out: once from the command line, or row by row from standard input to standard output.

use std::io::{self, BufRead, BufWriter, Write};
use std::process::ExitCode;

use super::error::CliError;
use super::units::decimals;

/// Converts the `numbers` of the command line, or with `csv` every row of standard input. `convert` turns one row of numbers into
/// another, or says why it cannot. A header in the input stands as `header` in the output.
pub(super) fn convert(
    numbers: &[f64],
    csv: bool,
    header: &str,
    convert: impl Fn([f64; 3]) -> Result<[f64; 3], CliError>,
) -> Result<ExitCode, CliError> {
    if csv {
        stream(io::stdin().lock(), io::stdout().lock(), header, convert)?;
    } else {
        let numbers = <[f64; 3]>::try_from(numbers)
            .map_err(|_| CliError::Value("three numbers are needed".to_owned()))?;
        let line = convert(numbers)?.map(decimals).join(" ");
        writeln!(io::stdout(), "{line}").map_err(CliError::output)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Stops at the first bad row; the rows before it are written. Split here and not by a CSV library, which loses count of
/// the lines at empty ones: cells that are all numbers hold no commas.
fn stream(
    input: impl BufRead,
    output: impl Write,
    header: &str,
    convert: impl Fn([f64; 3]) -> Result<[f64; 3], CliError>,
) -> Result<(), CliError> {
    let mut output = BufWriter::new(output);
    let mut is_first = true;
    let result = (input.lines().zip(1..)).try_for_each(|(line, row)| {
        let at_row = |error| CliError::Row {
            row,
            error: Box::new(error),
        };
        let line = text(line).map_err(at_row)?;
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            return Ok(());
        }
        let written = if std::mem::take(&mut is_first) && is_header(line) {
            header.to_owned()
        } else {
            let results = numbers(line).and_then(&convert).map_err(at_row)?;
            results.map(decimals).join(",")
        };
        writeln!(output, "{written}").map_err(CliError::output)
    });
    output.flush().map_err(CliError::output)?;
    result
}

fn text(line: io::Result<String>) -> Result<String, CliError> {
    line.map_err(|error| match error.kind() {
        io::ErrorKind::InvalidData => CliError::Value("not UTF-8 text".to_owned()),
        _ => CliError::Input(error),
    })
}

fn cells(line: &str) -> impl Iterator<Item = &str> {
    line.split(',').map(|cell| cell.trim().trim_matches('"'))
}

/// Three names: each begins with a letter and is no number, as NaN would be.
fn is_header(line: &str) -> bool {
    let is_name =
        |cell: &str| cell.starts_with(char::is_alphabetic) && cell.parse::<f64>().is_err();
    cells(line).count() == 3 && cells(line).all(is_name)
}

fn numbers(line: &str) -> Result<[f64; 3], CliError> {
    let count = cells(line).count();
    if count != 3 {
        return Err(CliError::Value(format!(
            "{count} values where 3 are expected"
        )));
    }
    let mut numbers = [0.0; 3];
    for (number, cell) in numbers.iter_mut().zip(cells(line)) {
        *number =
            (cell.parse()).map_err(|_| CliError::Value(format!("'{cell}' is not a number")))?;
    }
    Ok(numbers)
}

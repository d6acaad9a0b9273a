//! One JSON document on standard output.

use std::io::{self, Write};

use serde::Serialize;

use super::error::CliError;

/// Writes it, with a line end. A number that is infinite or none becomes `null`.
pub(super) fn print(document: &impl Serialize) -> Result<(), CliError> {
    let text =
        serde_json::to_string_pretty(document).map_err(|error| CliError::Output(error.into()))?;
    writeln!(io::stdout(), "{text}").map_err(CliError::output)
}

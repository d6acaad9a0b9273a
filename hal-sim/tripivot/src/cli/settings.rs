//! `tripivot settings`: a controller's settings to a readable file and back.

use std::io::{self, Write};
use std::process::ExitCode;

use super::arguments::SettingsCommand;
use super::error::CliError;
use super::view::endpoint;
use desk::settings::{Settings, export, import};

pub(super) fn run(command: &SettingsCommand) -> Result<ExitCode, CliError> {
    let said = match command {
        SettingsCommand::Export(arguments) => {
            let settings = export(&endpoint(&arguments.controller)?)?;
            settings.write(&arguments.file)?;
            format!(
                "{} parameters and {} macros in {}\n",
                settings.parameters.len(),
                settings.macros.len(),
                arguments.file.display()
            )
        }
        SettingsCommand::Import(arguments) => {
            let settings = Settings::read(&arguments.file)?;
            let changed = import(&settings, &endpoint(&arguments.controller)?)?;
            format!(
                "{} parameters and {} macros changed, and kept\n",
                changed.parameters, changed.macros
            )
        }
    };
    (io::stdout().write_all(said.as_bytes())).map_err(CliError::output)?;
    Ok(ExitCode::SUCCESS)
}

//! What a controller was told before, in a file that can be read and given back.

use super::Machine;
use super::bench::LIMITS_NOT_BORNE;
use crate::record::RecordError;
use crate::settings::{Changed, Settings, SettingsError, export_from, import_to};
use std::fmt;
use std::path::Path;

/// See the module.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Backup {
    settings: Settings,
    commissioned: bool,
}

/// What is in the file of a controller that had not been commissioned: a comment to whatever else reads it.
const UNCOMMISSIONED: &str = "# not commissioned";

impl fmt::Display for Backup {
    /// As its file has it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.told().fmt(f)
    }
}

impl Backup {
    /// All that the controller is told.
    ///
    /// # Errors
    /// When nobody answers.
    pub fn of(machine: &mut dyn Machine) -> Result<Self, RecordError> {
        let commissioned = (machine.ask("CMS?")?).is_some_and(|answer| answer.starts_with('1'));
        Ok(Self {
            settings: export_from(&mut |line| machine.ask(line))?,
            commissioned,
        })
    }

    /// Writes it, whole or not at all.
    ///
    /// # Errors
    /// [`SettingsError::File`]
    pub fn write(&self, path: &Path) -> Result<(), SettingsError> {
        self.told().write(path)
    }

    fn told(&self) -> Settings {
        let mut settings = self.settings.clone();
        if !self.commissioned {
            settings.of += &format!("\n{UNCOMMISSIONED}");
        }
        settings
    }

    /// Reads it.
    ///
    /// # Errors
    /// [`SettingsError::File`] and [`SettingsError::Line`].
    pub fn read(path: &Path) -> Result<Self, SettingsError> {
        let settings = Settings::read(path)?;
        let text = std::fs::read_to_string(path).map_err(|error| SettingsError::File {
            path: path.to_owned(),
            error,
        })?;
        Ok(Self {
            settings,
            commissioned: !text.lines().any(|line| line == UNCOMMISSIONED),
        })
    }

    /// Gives it back, and has it kept.
    ///
    /// # Errors
    /// [`SettingsError::Controller`]: everything is as it was, or [`SettingsError::NotTakenBack`].
    pub fn give_back(&self, machine: &mut dyn Machine) -> Result<Changed, SettingsError> {
        for line in ["CCL 1 ADVANCED", "SVO X 0", "FLC"] {
            machine.ask(line)?;
        }
        machine.delay(0.2)?;
        match machine.ask(if self.commissioned { "CMS 1" } else { "CMS 0" }) {
            // What is given back puts the limits right, and says the same then.
            Err(RecordError::Refused { code, .. }) if code == LIMITS_NOT_BORNE => {}
            answer => {
                answer?;
            }
        }
        import_to(&self.settings, &mut |line| machine.ask(line))
    }
}

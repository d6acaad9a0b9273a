//! Machines with what a commissioning found of them, in place of what their builder knows.
//!
//! Where x points is the user's choice: it is where the jig stood. The judge has drawn frames, so all zeros are turned together, until their mean is
//! the true one; what single zeros are off stays.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use firmware::parameters::Parameters;

use crate::machine::devices::{SettingsFileError, SettingsFlash};
use crate::machine::unknown;
use crate::rig::{ControllerMemory, Rig, leads_turns, turn_zeros};

/// What a controller keeps, in the folder of its machine.
pub const SETTINGS: &str = "settings.flash";

/// A machine by its number, plugged in as it belongs, and its controller's parameters.
#[derive(Clone, Debug)]
pub struct Commissioned {
    /// Of [`unknown`].
    pub machine: u64,
    /// As they were kept.
    pub parameters: Parameters,
}

/// Why there are no commissioned machines.
#[derive(Debug, thiserror::Error)]
pub enum CommissionedError {
    /// The folder cannot be read.
    #[error("cannot read {}: {error}", path.display())]
    Folder {
        /// Which.
        path: PathBuf,
        /// What the system says.
        error: io::Error,
    },
    /// There is none in it.
    #[error(
        "{}: no folder in it has a machine's number for a name; `SETTINGS={} cargo bench -p tripivot --bench commission` makes them", .0.display(), .0.display()
    )]
    NoMachine(PathBuf),
    /// A file is no flash.
    #[error(transparent)]
    File(#[from] SettingsFileError),
    /// A file that keeps nothing, or nothing of a commissioned machine.
    #[error("{}: no settings of a commissioned machine", .0.display())]
    NotCommissioned(PathBuf),
}

impl Commissioned {
    /// Those of a folder, which has a folder for each, by their numbers.
    ///
    /// # Errors
    /// [`CommissionedError`]
    pub fn all_of(folder: &Path) -> Result<Vec<Self>, CommissionedError> {
        let unreadable = |error| CommissionedError::Folder {
            path: folder.to_owned(),
            error,
        };
        let mut machines = Vec::new();
        for entry in fs::read_dir(folder).map_err(unreadable)? {
            let path = entry.map_err(unreadable)?.path();
            let number = path
                .file_name()
                .and_then(|name| name.to_str()?.parse().ok());
            let settings = path.join(SETTINGS);
            if let (Some(machine), true) = (number, settings.exists()) {
                machines.push(Self::kept(machine, &settings)?);
            }
        }
        if machines.is_empty() {
            return Err(CommissionedError::NoMachine(folder.to_owned()));
        }
        machines.sort_by_key(|commissioned| commissioned.machine);
        Ok(machines)
    }

    /// As the controller itself reads it when it starts.
    fn kept(machine: u64, settings: &Path) -> Result<Self, CommissionedError> {
        let mut memory = ControllerMemory::new();
        let nothing = Parameters::REFERENCE.uncommissioned();
        let flash = SettingsFlash::open(settings)?;
        let stage = unknown(machine);
        let rig = Rig::simulated(&mut memory, &stage, &nothing, flash);
        let mut parameters = rig.interpreter.parameters().clone();
        if !parameters.commissioned {
            return Err(CommissionedError::NotCommissioned(settings.to_owned()));
        }
        let mean_turns = leads_turns(&parameters, &stage).iter().sum::<f64>() / 3.0;
        turn_zeros(&mut parameters, [mean_turns; 3]);
        Ok(Self {
            machine,
            parameters,
        })
    }
}

//! Machines with what a commissioning found of them, in place of what their builder knows.
//!
//! Where x points is the user's choice: it is where the jig stood. The judge has drawn frames, so all zeros are turned together, until their mean is
//! the true one; what single zeros are off stays.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use firmware::parameters::Parameters;

use crate::machine::devices::{COUNTS_PER_TURN, SettingsFileError, SettingsFlash, StageParameters};
use crate::machine::unknown;
use crate::rig::{ControllerMemory, Rig};

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
        let lead = mean_lead_turns(&parameters, &stage);
        turn_frame(&mut parameters, lead);
        Ok(Self {
            machine,
            parameters,
        })
    }
}

/// What pivots are told further left than they are, turns: the mean of all.
fn mean_lead_turns(parameters: &Parameters, stage: &StageParameters) -> f64 {
    let leads = [0, 1, 2].map(|i| {
        let (told, truth) = (&parameters.encoders[i], &stage.encoders[i]);
        let behind = truth.zero_counts.wrapping_sub(told.zero_counts) % COUNTS_PER_TURN;
        let turns = f64::from(behind) / f64::from(COUNTS_PER_TURN);
        if told.reversed { -turns } else { turns }
    });
    let [first, ..] = leads;
    // They differ by little; none is taken half a turn off.
    let beside = leads.map(|lead| (lead - first) - (lead - first).round());
    first + beside.iter().sum::<f64>() / 3.0
}

/// Turns the frame to the left: pivots are told so many turns less. What goes with their angles goes on with the same places.
fn turn_frame(parameters: &mut Parameters, turns: f64) {
    for encoder in &mut parameters.encoders {
        let turns = if encoder.reversed { -turns } else { turns };
        let counts = (turns.rem_euclid(1.0) * f64::from(COUNTS_PER_TURN)) as u32;
        encoder.zero_counts = encoder.zero_counts.wrapping_add(counts) % COUNTS_PER_TURN;
    }
    for (gear, drive) in (parameters.servo.gear_errors.iter_mut()).zip(&parameters.drives) {
        gear.phase_deg = (gear.phase_deg + 360.0 * turns * drive.gear_ratio).rem_euclid(360.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rig::with_wiring_told;

    #[test]
    fn zeros_of_any_jig_are_turned_to_the_drawn_ones() {
        for (machine, turns) in [(7, 0.083), (8, -0.41), (9, 0.0)] {
            let stage = unknown(machine);
            let told = with_wiring_told(&Parameters::REFERENCE, &stage);
            let mut jig = told.clone();
            turn_frame(&mut jig, -turns);
            let lead = mean_lead_turns(&jig, &stage);
            assert!(
                (lead - turns - (lead - turns).round()).abs() < 1e-7,
                "{lead}"
            );
            turn_frame(&mut jig, lead);
            for (found, truth) in jig.encoders.iter().zip(&told.encoders) {
                let off = found.zero_counts.wrapping_sub(truth.zero_counts) % COUNTS_PER_TURN;
                assert!(off.min(COUNTS_PER_TURN - off) < 4, "{off} counts");
            }
        }
    }
}

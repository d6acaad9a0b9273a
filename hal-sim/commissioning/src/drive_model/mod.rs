//! The numbers of the drives and of what they move, from frequency responses.
//!
//! | file | idea |
//! |---|---|
//! | `electrical` | winding, motor constant and dead time of each drive, from what is recorded of it alone |
//! | `mechanical` | inertias, springs and dampers, from the responses of the angles to the currents |

mod electrical;
mod mechanical;

pub use electrical::{Besides, COPPER_1_K, Electrical, Equations, electrical};
pub use mechanical::{Guess, LOAD_INERTIA, MASS, Mechanical, NAMES, Responses, mechanical};

use crate::frequency_response::Run;
use crate::friction::MotorConstant;
use crate::record::Timing;

/// Electrical and mechanical numbers of the machine.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveModel {
    /// Of the three drives.
    pub electrical: [Electrical; 3],
    /// Of all of it.
    pub mechanical: Mechanical,
}

/// What is known or thought before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// Current from which a bridge's whole dead time counts, A.
    pub knee_a: f64,
    /// Motor constants from steady rates: better than what small motions say of them.
    pub motor_constants: [MotorConstant; 3],
    /// What the machine may be.
    pub guess: Guess,
    /// Lines up to here are followed, Hz.
    pub to_hz: f64,
}

/// Passes in which windings and mechanics are found in turn: each takes something of the other.
const PASSES: usize = 4;

/// The model, from runs in the middle of the disk, the lines that follow from them, and lines of a weaker excitation.
///
/// # Errors
/// [`DriveError`].
pub fn drive_model(
    runs: &[Run],
    responses: &Responses<'_>,
    timing: &Timing,
    known: &Known,
) -> Result<DriveModel, DriveError> {
    let equations = |pivot: usize| Equations::new(runs, timing, pivot, known.knee_a);
    let equations = [equations(0)?, equations(1)?, equations(2)?];
    let all = |mechanics: Option<&DriveModel>| -> Result<[Electrical; 3], DriveError> {
        let one = |pivot: usize| {
            let mechanics = mechanics.map(|model| {
                (
                    &model.mechanical.excited,
                    model.electrical[pivot].motor_constant,
                )
            });
            electrical(
                &equations[pivot],
                timing,
                &Besides {
                    motor_constant: known.motor_constants[pivot],
                    mechanics,
                },
            )
        };
        Ok([one(0)?, one(1)?, one(2)?])
    };
    let with = |electrical: [Electrical; 3]| {
        let mechanical = mechanical(responses, &electrical, &known.guess, known.to_hz)?;
        Ok(DriveModel {
            electrical,
            mechanical,
        })
    };
    let mut model = with(all(None)?)?;
    for _ in 1..PASSES {
        model = with(all(Some(&model))?)?;
    }
    Ok(model)
}

/// Why there is no model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DriveError {
    /// Nothing of a pivot in any record.
    #[error(
        "pivot {pivot}: no record of volts, current and angle holds a period of it; record them together"
    )]
    NotRecorded {
        /// 1 to 3.
        pivot: usize,
    },
    /// Signals from which nothing follows.
    #[error(
        "pivot {pivot}: volts, current and angle do not determine winding and motor; excite it while it turns"
    )]
    NoMotion {
        /// 1 to 3.
        pivot: usize,
    },
    /// Numbers that no drive has.
    #[error(
        "pivot {pivot}: resistance, inductance or motor constant came out negative; look at polarity and wiring first"
    )]
    Senseless {
        /// 1 to 3.
        pivot: usize,
    },
    /// A model that does not follow what was measured.
    #[error(
        "the mechanics are not those of motors, rings and a platform: the model is off by {percent} % of the responses"
    )]
    NoFit {
        /// Of what was measured.
        percent: u32,
    },
}

//! A controller on a simulated machine, and what is done with it.
//!
//! | module | idea |
//! |---|---|
//! | `assembly` | [`Rig`]: both, put together in one place |
//! | [`run`] | a script, from its first line to the report |
//! | [`sensitivity`] | what each imperfection of the machine decides |
//! | `conditions` | what a run is made under |
//! | `disturbances` | what a script's pushes and shakes do to the machine |
//! | [`script`], [`client`] | files of GCS lines, and what sends them one after the other: a package of their own |
//! | [`exercise`] | GCS lines from a seed |
//! | `calibrated` | a stage as it was built, and its true calibration |
//! | `frame` | zeros that were found, beside true ones |
//! | `shipped` | the reference stage's settings, as its commissioning left them |
//! | `told`, `gains` | a controller that is told of the machine before it, and has gains that fit |
//! | `simulated_board` | what the simulated controller says of its board |
//! | [`observer`] | looks at every tick for the report |

mod assembly;
mod calibrated;
mod conditions;
mod disturbances;
pub mod exercise;
mod frame;
mod gains;
pub mod observer;
pub mod run;
pub mod sensitivity;
mod shipped;
mod simulated_board;
mod told;

pub use ::script::{client, script};
pub use assembly::{ControllerMemory, IDENTITY, Rig, with_machine_settings, with_settings_over};
pub use calibrated::{built_stage, calibration_told};
pub use conditions::{machine_name, run_conditions};
pub use disturbances::Disturbances;
pub(crate) use frame::{leads_turns, turn_zeros};
pub use gains::{
    guides_hz, loop_model, with_gains_firmer, with_gains_fitted, with_gains_for_every_day,
    with_gains_tuned, with_motion_fitted,
};
pub use told::{
    Told, with_drives_told, with_gear_errors_told, with_guides_told, with_inertia_scheduled,
    with_machine_told, with_payload_told, with_ripple_told, with_subdivision_told,
    with_wiring_told,
};

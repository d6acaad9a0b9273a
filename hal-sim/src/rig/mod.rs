//! A controller on a simulated machine, and what is done with it.
//!
//! | module | idea |
//! |---|---|
//! | [`Rig`] | the assembly of both |
//! | [`run`] | a script, from its first line to the report |
//! | `conditions` | what a run is made under |
//! | [`script`] | files of GCS lines |
//! | [`exercise`] | GCS lines from a seed |
//! | [`client`] | sends lines one after the other, as any client would |
//! | [`observer`] | looks at every tick for the report |

mod assembly;
pub mod client;
mod conditions;
pub mod exercise;
pub mod observer;
pub mod run;
pub mod script;

pub use assembly::{ControllerMemory, IDENTITY, Rig};
pub use conditions::run_conditions;

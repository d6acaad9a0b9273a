//! A controller on a simulated machine, and what is done with it.
//!
//! | module | idea |
//! |---|---|
//! | [`Rig`] | the assembly of both |
//! | [`run`] | a script, from its first line to the report |
//! | [`script`] | files of GCS lines |
//! | [`exercise`] | GCS lines from a seed |
//! | [`client`] | sends lines one after the other, as any client would |
//! | [`observer`] | looks at every tick for the report |

mod assembly;
pub mod client;
pub mod exercise;
pub mod observer;
pub mod run;
pub mod script;

pub use assembly::{ControllerMemory, IDENTITY, Rig};

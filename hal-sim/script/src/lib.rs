//! Files of GCS lines, checked as a whole before anything moves, and a client that runs them.
//!
//! | module | idea |
//! |---|---|
//! | [`script`] | the file and its lines; what a line is, to whoever runs it |
//! | [`disturbance`] | lines that push or shake a simulated stage |
//! | [`client`] | sends lines one after the other over a connection of its own, as any client would |

pub mod client;
pub mod disturbance;
pub mod script;

pub use client::{Client, Event};
pub use disturbance::Disturbance;
pub use script::{Line, Script, ScriptError};

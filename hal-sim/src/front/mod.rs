//! The controller in front of the machine: on the host here; on an emulated chip in the package `image`.

mod host;

pub use host::{Host, Wiring};

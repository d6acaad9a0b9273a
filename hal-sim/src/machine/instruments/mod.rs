//! Instruments in front of a machine at rest: what each would read, with its noise.
//!
//! The truth is the plant's own geometry, whose formulas the fit does not share. Poses are in m and rad; what instruments tell is in
//! the units of `calibration`: track radii and rad.
//!
//! | file | idea |
//! |---|---|
//! | [`quasi_static`] | a machine at rest: pose to encoder readings and back |
//! | [`workshop`] | machines drawn from a seed, as good as a workshop keeps them |
//! | [`interferometer`] | x, y and theta |
//! | [`target`] | x and y of one target on the platform |
//! | [`camera`] | a camera at fixed places over a plate of marks |
//! | [`ends`] | no instrument: ends of guides, touched |
//! | [`beside`] | one of them beside a machine that moves |
//! | [`survey`](mod@survey) | a whole measurement, and its proof |

pub mod beside;
pub mod camera;
pub mod ends;
pub mod interferometer;
pub mod quasi_static;
pub mod survey;
pub mod target;
pub mod workshop;

pub use beside::Beside;
pub use quasi_static::{EncoderErrors, QuasiStatic, Unrepeated};
pub use survey::{CommandedError, commanded, survey};

//! What reports and pages are drawn with: nothing here knows a controller or a machine.
//!
//! | module | idea |
//! |---|---|
//! | [`svg`], [`png`] | pictures |
//! | [`chart`], [`scale`], [`envelope`] | quantities over time |
//! | [`plane`] | curves over frequency, and loci |
//! | [`field`] | errors over a disk |
//! | [`page`] | reports as pages that stand alone |
//! | [`colour`] | one set of colours |
//! | [`mechanism`] | sizes of the drawn mechanism |
//! | [`assets`] | scripts and styles that the live page and a run's document share |
//! | [`files`] | files and folders written |
//! | [`whole_file`] | files written whole or not at all |
//! | [`progress`] | the progress bar |

pub mod assets;
pub mod chart;
pub mod colour;
pub mod envelope;
pub mod field;
pub mod files;
pub mod mechanism;
mod outlines;
pub mod page;
pub mod plane;
pub mod png;
pub mod progress;
pub mod scale;
pub mod svg;
pub mod whole_file;

pub use files::{ReportError, claim_folder, make_folder, unwritable, write_file, write_png};
pub use progress::Progress;
pub use whole_file::{WholeFile, read_text, write_whole};

//! `hal-sim/MEASURED.md`: what was measured, with the command that measures it again.
//!
//! `cargo run --release -p tests --bin measured` writes it. [`all_sections`] says what is in it: a section is a command and some
//! words. The command runs as a child process, what it prints is the figures; so this knows nothing of what it measures.
//! `hal-sim/PLANT.md` has the table of what each imperfection decides from it. `tests/tests/measured.rs` holds page and table together, and some figures to a fresh run.

mod compare;
mod conditions;
mod output;
mod page;
mod plant_page;
mod registry;
mod run;
mod section;

pub use compare::{TOLERANCE, cost_differences, differences};
pub use output::figures;
pub use page::{Page, PageError, path};
pub use plant_page::{plant_path, plant_text};
pub use registry::all_sections;
pub use run::{RunError, prepare, run};
pub use section::{Group, Kind, Measured, Section};

//! The table in `hal-sim/PLANT.md` that says what each imperfection decides: that of the page, as a table.

use super::Page;
use std::path::{Path, PathBuf};

/// The section whose table it is.
const SECTION: &str = "sensitivity";
const BEGIN: &str = "<!-- `measured --only sensitivity` writes this table. -->\n";
const END: &str = "<!-- Its end. -->\n";

/// The page with the model's description.
#[must_use]
pub fn plant_path(root: &Path) -> PathBuf {
    root.join("hal-sim/PLANT.md")
}

/// The description with what the page says now; nothing if the page has no such table, or the description no place for it.
#[must_use]
pub fn plant_text(plant: &str, page: &Page) -> Option<String> {
    let figures = &page.get(SECTION)?.figures;
    let (before, rest) = plant.split_once(BEGIN)?;
    let (_, after) = rest.split_once(END)?;
    let table: String = (figures.lines().filter(|line| line.starts_with('|')))
        .map(|line| format!("{line}\n"))
        .collect();
    Some(format!("{before}{BEGIN}\n{table}\n{END}{after}"))
}

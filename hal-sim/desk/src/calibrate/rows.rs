//! A measurement as the text that is kept of it: what it is, the names of its columns, and a row for each visit.

use calibration::Instrument;
use calibration::plan::Stop;
use calibration::table::{note, to_text};
use kinematics::Geometry;

use super::measure::Measured;
use crate::date::today;

/// Its head. `begun`: what is measured, as a comment.
#[must_use]
pub fn head(begun: &str, instrument: &Instrument) -> String {
    let head = to_text(instrument, &[], Geometry::REFERENCE.radius_mm);
    format!("{begun}\n{head}")
}

/// Begins what is measured at once: behind so many visits.
#[must_use]
pub fn from(kept: usize) -> String {
    format!("# {}, from visit {}\n", today(), kept + 1)
}

/// A row, with what it is and when above it.
#[must_use]
pub fn row(instrument: &Instrument, stops: &[Stop], measured: &Measured) -> String {
    let Measured { visit, clock_s, .. } = *measured;
    let rows = to_text(
        instrument,
        &[measured.visited],
        Geometry::REFERENCE.radius_mm,
    );
    let row = rows.lines().nth(1).unwrap_or_default();
    let is_reference = visit > 0 && stops.get(visit) == stops.first();
    format!("{}\n{row}\n", note(visit, is_reference, clock_s))
}

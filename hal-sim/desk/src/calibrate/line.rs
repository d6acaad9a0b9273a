//! What is told of a plan, a fit or a verification, line by line.

const NM_PER_MM: f64 = 1e6;
pub(super) const URAD_PER_RAD: f64 = 1e6;

/// A line of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// What it is about.
    pub what: String,
    /// What is told of it.
    pub text: String,
    /// Whether that is as it should be.
    pub is_good: bool,
}

impl Line {
    /// What is not judged.
    pub(crate) fn new(what: impl Into<String>, text: impl Into<String>) -> Self {
        Self::judged(what, text, true)
    }

    pub(crate) fn judged(what: impl Into<String>, text: impl Into<String>, is_good: bool) -> Self {
        Self {
            what: what.into(),
            text: text.into(),
            is_good,
        }
    }
}

/// A length in track radii in nm.
#[must_use]
pub fn nm(length: f64) -> f64 {
    length * kinematics::Geometry::REFERENCE.radius_mm * NM_PER_MM
}

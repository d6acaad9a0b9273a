//! How much of a plan is checked at once, and how much has been.

use super::violation::Violation;

/// Intervals that may be looked at, failed ones included, before the next failure counts.
pub(super) const MAX_INTERVALS: usize = 60;

/// Intervals in the first slice.
const SLICE: usize = 16;

/// What has to have been seen, ticks, for the rest to be left for later.
pub(crate) const MIN_CHECKED_TICKS: u64 = 100;

/// How a motion is looked at.
pub(crate) struct CheckBudget {
    pub(super) left: usize,
    /// Intervals until the rest is left for later.
    pub(super) slice: usize,
    /// Ticks from the start on that have been found inside.
    pub checked_ticks: u64,
}

impl CheckBudget {
    /// At all of it, at once.
    pub const WHOLE: Self = Self {
        left: MAX_INTERVALS,
        slice: usize::MAX,
        checked_ticks: 0,
    };

    /// At the start of it.
    pub const SLICE: Self = Self {
        slice: SLICE,
        ..Self::WHOLE
    };

    /// At the rest of it.
    pub const fn after(seen: u64) -> Self {
        Self {
            checked_ticks: seen,
            ..Self::WHOLE
        }
    }

    pub(super) fn take(&mut self) -> Result<(), Violation> {
        if self.slice == 0 {
            return Err(Violation::Unchecked);
        }
        self.slice = self.slice.saturating_sub(1);
        self.left = self.left.saturating_sub(1);
        Ok(())
    }

    pub(super) fn leave_for_later(&self) -> Result<(), Violation> {
        if self.slice <= SLICE && self.checked_ticks >= MIN_CHECKED_TICKS {
            Err(Violation::Unchecked)
        } else {
            Ok(())
        }
    }
}

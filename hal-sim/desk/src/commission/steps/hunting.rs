//! Whether a stage that should be at rest hunts: a servo swings through a gap in its transmission, over and over. One that does may be
//! on target for a moment, or never.

use crate::commission::bench::Bench;
use crate::commission::found::{CommissionError, Failure};
use crate::commission::id::AXES;

/// Ticks that a pivot is looked at for.
const TICKS: usize = 1_500;
/// Swing of a stage that should be at rest: of 120 sound machines two had more than 6 urad, 10 and 16; a gap of 50 urad makes 37.
const HUNTS_RAD: f64 = 20e-6;

/// What has come of moves that have ended, or should have: refused with the swing where the stage hunts.
pub(super) fn unless_hunting<T>(
    bench: &mut Bench<'_>,
    moved: Result<T, CommissionError>,
) -> Result<T, CommissionError> {
    if !matches!(moved, Ok(_) | Err(CommissionError::Failed(_))) {
        return moved;
    }
    let (swing_rad, pivot) = largest_swing(bench)?;
    if swing_rad < HUNTS_RAD {
        return moved;
    }
    Err(CommissionError::Failed(Failure::new(
        format!(
            "the stage does not come to rest: pivot {} swings by {:.0} urad",
            pivot + 1,
            swing_rad * 1e6
        ),
        "a gap (backlash) between motor and ring: look at gear, coupling and their preload",
    )))
}

/// The largest swing of a pivot, rad, and which pivot's it is.
fn largest_swing(bench: &mut Bench<'_>) -> Result<(f64, usize), CommissionError> {
    bench.reserve(TICKS)?;
    let mut largest = (0.0, 0);
    for pivot in 0..AXES {
        let angles = bench.record(pivot, TICKS, 1, None)?.signals.angle_rad;
        let [low, high] =
            [f64::min, f64::max].map(|of| angles.iter().copied().reduce(of).unwrap_or_default());
        if high - low > largest.0 {
            largest = (high - low, pivot);
        }
    }
    Ok(largest)
}

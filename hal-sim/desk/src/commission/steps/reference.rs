//! The first closed loop: a turn and a square at a tenth of the speed.

use super::gains;
use super::hunting::unless_hunting;
use crate::commission::bench::Bench;
use crate::commission::found::{CommissionError, Finding, Found};
use crate::commission::known::Known;

/// Share of the speed.
const SPEED: f64 = 0.1;
const MOVES: [&str; 6] = [
    "MOV X 15 Y 15 W 0",
    "MOV X -15 Y 15 W 120",
    "MOV X -15 Y -15 W 240",
    "MOV X 15 Y -15 W 360",
    "MOV X 0 Y 0 W 360",
    "MOV X 0 Y 0 W 0",
];
/// Longest of them, s.
const LONGEST_S: f64 = 60.0;
const MOST_ERROR_RAD: f64 = 1e-3;

pub(super) fn run(
    bench: &mut Bench<'_>,
    _: &mut Known,
    found: &mut Found,
) -> Result<(), CommissionError> {
    // What its gains may be is not known yet.
    gains::begin_softly(bench)?;
    bench.commission()?;
    bench.ask("FRF")?;
    let settled_s = bench.settle()?;
    let followed = bench.follow_slowly(SPEED, &MOVES, LONGEST_S);
    let error_rad = unless_hunting(bench, followed)?;
    found.push(Finding::told(
        "settled after the reference in",
        format!("{settled_s:.2} s"),
    ));
    found.push(Finding::new(
        "largest following error at a tenth of the speed",
        format!("{:.0} urad", error_rad * 1e6),
        format!("under {:.0}", MOST_ERROR_RAD * 1e6),
        error_rad < MOST_ERROR_RAD,
        "something rubs or gives way, or the gains are far from this machine's",
    ));
    Ok(())
}

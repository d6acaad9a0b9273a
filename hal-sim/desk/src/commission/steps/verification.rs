//! Moves as the machine will make them, there and back.

use crate::commission::bench::Bench;
use crate::commission::found::{CommissionError, Finding};
use crate::commission::known::Known;

const MOVES: [&str; 8] = [
    "MOV X 30 Y 0 W 0",
    "MOV X 30 Y 30 W 90",
    "MOV X -30 Y 30 W 90",
    "MOV X -30 Y -30 W -90",
    "MOV X 0 Y 0 W 0",
    "MOV X 1 Y 0 W 0",
    "MOV X 1.01 Y 0 W 0",
    "MOV X 0 Y 0 W 0",
];
/// Longest of them, s.
const LONGEST_S: f64 = 10.0;
const MOST_ERROR_RAD: f64 = 1e-3;

pub(super) fn run(bench: &mut Bench<'_>, _: &mut Known) -> Result<Vec<Finding>, CommissionError> {
    // What the loop learns by itself it has learnt after the first round.
    let mut errors = [0.0; 2];
    for error in &mut errors {
        let _ = bench.number("LST?", "PEAK_ERROR_RAD")?;
        for line in MOVES {
            bench.ask(line)?;
            bench.wait_for_target(LONGEST_S)?;
        }
        *error = bench.number("LST?", "PEAK_ERROR_RAD")?;
    }
    let late = bench.number("LST?", "LATE")?;
    Ok(vec![
        Finding::told(
            "largest following error in the first round",
            format!("{:.0} urad", errors[0] * 1e6),
        ),
        Finding::new(
            "largest following error in the second",
            format!("{:.0} urad", errors[1] * 1e6),
            format!("under {:.0}", MOST_ERROR_RAD * 1e6),
            errors[1] < MOST_ERROR_RAD,
            "lower the limits of motion, or look for what rubs or gives way",
        ),
        Finding::new(
            "late ticks",
            format!("{late:.0}"),
            "none",
            late == 0.0,
            "EVT? and LST? tell of the loop's time",
        ),
    ])
}

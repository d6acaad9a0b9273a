//! Moves as the machine will make them, there and back.

use super::gains::{USUAL_COUNTS, rest_for, settle_within};
use super::step_response::step_response;
use crate::commission::bench::Bench;
use crate::commission::found::{CommissionError, Finding, Found};
use crate::commission::known::Known;
use crate::commission::servo_gains;

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

/// What gains are lowered by where moves at full speed are too much for them, and how often at most.
const LESS: f64 = 0.85;
const MOST_LESS: usize = 3;

/// Largest settling window, encoder counts: 0.15 um at the track.
const MOST_COUNTS: f64 = 16.0;

/// Two rounds of the moves, with gains that bear them: a loop that has its margins in slow motion may oscillate where motors push
/// their hardest, in the first round or when it has learnt. And with a settling window that the stage comes into: friction of the guides holds
/// one with little gain some counts off. Their largest following errors, rad.
fn rounds(bench: &mut Bench<'_>, found: &mut Found) -> Result<[f64; 2], CommissionError> {
    let mut lowered = 0;
    let mut window = USUAL_COUNTS;
    loop {
        let first = bench.follow(&MOVES, LONGEST_S);
        let both = first.and_then(|first| Ok([first, bench.follow(&MOVES, LONGEST_S)?]));
        match both {
            Err(error) if lowered < MOST_LESS && bench.is_faulted()? => {
                found.push(Finding::told("gains are lowered", error.to_string()));
                bench.clear_fault()?;
                let gains = servo_gains::read(bench)?.slowed(LESS);
                servo_gains::write(bench, &gains)?;
                rest_for(bench, &gains)?;
                bench.hold()?;
                lowered += 1;
            }
            Err(error) if window < MOST_COUNTS && !bench.is_faulted()? => {
                window *= 2.0;
                let told = format!("to {window:.0} encoder counts: {error}");
                found.push(Finding::told("settling window is widened", told));
                settle_within(bench, window)?;
            }
            followed => return followed,
        }
    }
}

pub(super) fn run(
    bench: &mut Bench<'_>,
    _: &mut Known,
    found: &mut Found,
) -> Result<(), CommissionError> {
    settle_within(bench, USUAL_COUNTS)?;
    // What the loop learns by itself it has learnt in the first.
    let [first_rad, error_rad] = rounds(bench, found)?;
    found.push(Finding::told(
        "largest following error in the first round",
        format!("{:.0} urad", first_rad * 1e6),
    ));
    found.number("largest following error", error_rad * 1e6, "urad");
    found.push(Finding::new(
        "largest following error in the second",
        format!("{:.0} urad", error_rad * 1e6),
        format!("under {:.0}", MOST_ERROR_RAD * 1e6),
        error_rad < MOST_ERROR_RAD,
        "lower the limits of motion, or look for what rubs or gives way",
    ));
    let late = bench.number("LST?", "LATE")?;
    found.push(Finding::new(
        "late ticks",
        format!("{late:.0}"),
        "none",
        late == 0.0,
        "EVT? and LST? tell of the loop's time",
    ));
    step_response(bench, found)
}

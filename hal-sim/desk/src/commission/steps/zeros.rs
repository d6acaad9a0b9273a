//! The platform in its jig, in the middle with guide 1 along x: there pivot 1 is at 0 deg, pivot 2 at 120, pivot 3 at 240. Then the jig is taken out:
//! no servo works against one that somebody has forgotten.

use super::nudges;
use crate::commission::Task;
use crate::commission::bench::{BY_CURRENT, BY_TIME, BY_WAY, Bench, average};
use crate::commission::found::{CommissionError, Finding, Found, fail};
use crate::commission::id;
use crate::commission::id::AXES;
use crate::commission::known::Known;
use std::f64::consts::TAU;

/// Counts of a turn.
const COUNTS: f64 = 67_108_864.0;
/// Ticks over whose mean an angle is read.
const TICKS: usize = 1_000;
/// What the angles are off after it, rad: three counts.
const MOST_LEFT_RAD: f64 = 3e-7;
/// Until it is looked whether the jig is out, s, and how often: a minute with the nudges.
const LOOK_S: f64 = 0.5;
const LOOKS: usize = 75;

pub(super) fn run(
    bench: &mut Bench<'_>,
    known: &mut Known,
    found: &mut Found,
) -> Result<(), CommissionError> {
    bench.request(Task::PutOnJig)?;
    bench.delay(0.2)?;
    let angles = read(bench)?;
    let too_large = std::array::from_fn(|pivot| angles[pivot] - TAU * pivot as f64 / AXES as f64);
    set(bench, known, found, too_large)?;
    bench.delay(0.1)?;
    let angles = read(bench)?;
    let left = (0..AXES)
        .map(|pivot| {
            let off = (angles[pivot] - TAU * pivot as f64 / AXES as f64) / TAU;
            ((off - off.round()) * TAU).abs()
        })
        .fold(0.0, f64::max);
    found.push(Finding::new(
        "pivots in the jig, off 0, 120 and 240 deg",
        format!("{:.3} urad at most", left * 1e6),
        format!("under {:.1}", MOST_LEFT_RAD * 1e6),
        left < MOST_LEFT_RAD,
        "the platform has moved in the jig: put it in again",
    ));
    if left < MOST_LEFT_RAD {
        taken_out(bench)?;
    }
    Ok(())
}

/// Waits until the jig is out: what a nudge moves is not held.
fn taken_out(bench: &mut Bench<'_>) -> Result<(), CommissionError> {
    bench.request(Task::TakeOutJig)?;
    for _ in 0..LOOKS {
        bench.delay(LOOK_S)?;
        match nudges::ramp(bench, 0, nudges::MOST_V)?.by.as_str() {
            BY_WAY => return Ok(()),
            // It is held.
            BY_TIME | BY_CURRENT => {}
            by => {
                return fail(
                    format!("a nudge to see whether the jig is out has ended by `{by}`"),
                    "whoever has stopped it knows why; then --from zeros",
                );
            }
        }
    }
    fail(
        format!(
            "{:.1} V have not moved ring 1 by {:.0} mrad for a minute: the jig is in",
            nudges::MOST_V,
            nudges::WAY_RAD * 1e3
        ),
        "take it out, then --from zeros; if it is out, ring 1 is jammed: turn it by hand",
    )
}

/// Sets the zeros by what each angle is told too large by, rad.
pub(super) fn set(
    bench: &mut Bench<'_>,
    known: &Known,
    found: &mut Found,
    too_large_rad: [f64; AXES],
) -> Result<(), CommissionError> {
    for (pivot, too_large_rad) in too_large_rad.into_iter().enumerate() {
        let sign = if known.reversed_at_port[known.ports[pivot]] {
            -1.0
        } else {
            1.0
        };
        let now = bench.parameter(id::ENCODER_ZERO + pivot as u32)?;
        let zero = (now + sign * too_large_rad / TAU * COUNTS)
            .round()
            .rem_euclid(COUNTS);
        bench.set(&[(id::ENCODER_ZERO + pivot as u32, zero)])?;
        found.number(format!("zero of encoder {}", pivot + 1), zero, "counts");
        found.push(Finding::told(
            format!("zero of encoder {}", pivot + 1),
            format!("{zero:.0} counts"),
        ));
    }
    Ok(())
}

/// Mean angles of the pivots.
fn read(bench: &mut Bench<'_>) -> Result<[f64; AXES], CommissionError> {
    let mut angles = [0.0; AXES];
    for (pivot, angle) in angles.iter_mut().enumerate() {
        *angle = average(&bench.record(pivot, TICKS, 1, None)?.signals.angle_rad);
    }
    Ok(angles)
}

//! Gains by the ultimate gain (Ziegler and Nichols, Trans. ASME 64, 1942): they are raised together until noise and a kick ring on, in the
//! middle and far out; three tenths of that are used. At rest, where they are raised, friction damps what rings: with half of it, as the rule has
//! it, machines that turn have an Ms of 3 to 6, and some oscillate.

use super::hunting::unless_hunting;
use crate::commission::bench::Bench;
use crate::commission::found::{CommissionError, Finding, Found};
use crate::commission::id;
use crate::commission::id::AXES;
use crate::commission::known::Known;
use crate::commission::sines::NEAR_RIM;
use crate::record::RecordError;
use commissioning::tuning::{Gains, rest_stiffness};

/// Gains that a share of 1 stands for: position 1/s, velocity V s/rad, integral V/rad.
const WHOLE: [f64; 3] = [400.0, 40.0, 14_000.0];
/// Share with which a machine is driven before, from which the search goes up, and by how much at a time to what.
const FIRST_SHARE: f64 = 0.25;
const STEP: f64 = 1.2;
const MOST_SHARE: f64 = 4.0;
/// What is used of the share at which it does not ring yet.
const MARGIN: f64 = 0.3;
/// Where, mm.
const PLACES: [[f64; 2]; 2] = [[0.0, 0.0], [NEAR_RIM.x_mm, NEAR_RIM.y_mm]];
/// Ticks of a record, and of its end, which is looked at: 50 ms after the kick.
const TICKS: usize = 1_500;
const END: usize = 400;
/// Kick, V, and ms.
const KICK_V: f64 = 1.5;
const KICK_MS: f64 = 5.0;
/// How many times as large the current's change from tick to tick is where it rings, over that of the first share and the gains' part.
const RINGS: f64 = 3.0;
/// Least share that is good for anything.
const LEAST_SHARE: f64 = 0.07;

/// Gains of all pivots. The slower the velocity loop is, the slower must be what lies around it.
fn set(bench: &mut Bench<'_>, share: f64) -> Result<(), CommissionError> {
    let [position, velocity, integral] = WHOLE;
    let around = share.min(1.0);
    Ok(bench.set(&[
        (id::POSITION_GAIN, position * around),
        (id::VELOCITY_GAIN, velocity * share),
        (id::INTEGRAL_GAIN, integral * share * around),
    ])?)
}

/// Encoder counts within which a loop counts as settled that is as slow as with the first share, and those of the machine.
const WIDE_COUNTS: f64 = 100.0;
pub(super) const USUAL_COUNTS: f64 = 2.0;

/// The same for gains that were found.
pub(in crate::commission) fn rest_for(
    bench: &mut Bench<'_>,
    gains: &Gains,
) -> Result<(), CommissionError> {
    let stiffness = rest_stiffness(gains.least_velocity_v_s_rad());
    Ok(bench.set(&[(id::REST_STIFFNESS, stiffness)])?)
}

/// First frequencies of the filters of all pivots: 0 is none; and the inertia that gains are scheduled by, 0: they are not.
const FILTERS: [u32; 4] = [0x5450_0340, 0x5450_0343, 0x5450_0346, id::SCHEDULED_INERTIA];

/// Forgets what an earlier commissioning has found: gains as a controller has them at first, and nothing that shapes them.
pub(super) fn forget(bench: &mut Bench<'_>) -> Result<(), CommissionError> {
    bench.set(&FILTERS.map(|id| (id, 0.0)))?;
    set(bench, 1.0)
}

/// A loop as it is before anything is known: a share of the gains, and a settling window for them.
pub(super) fn begin_softly(bench: &mut Bench<'_>) -> Result<(), CommissionError> {
    bench.set(&[
        (id::SETTLING_COUNTS, WIDE_COUNTS),
        (id::REST_STIFFNESS, at_rest(FIRST_SHARE)),
    ])?;
    set(bench, FIRST_SHARE)
}

/// What counts as settled from now on, encoder counts.
pub(super) fn settle_within(bench: &mut Bench<'_>, counts: f64) -> Result<(), CommissionError> {
    Ok(bench.set(&[(id::SETTLING_COUNTS, counts)])?)
}

/// What counts as settled for loops that are not tuned yet.
pub(in crate::commission) fn settle_widely(bench: &mut Bench<'_>) -> Result<(), CommissionError> {
    settle_within(bench, WIDE_COUNTS)
}

fn at_rest(share: f64) -> f64 {
    rest_stiffness(share * WHOLE[1])
}

pub(super) fn run(
    bench: &mut Bench<'_>,
    _: &mut Known,
    found: &mut Found,
) -> Result<(), CommissionError> {
    // At rest the loop would answer with an eighth of its gains.
    bench.set(&[(id::REST_STIFFNESS, 1.0)])?;
    bench.reserve(TICKS)?;
    let mut least = MOST_SHARE;
    for [x, y] in PLACES {
        set(bench, FIRST_SHARE)?;
        go_to(bench, [x, y])?;
        let share = ultimate(bench, least)?;
        set(bench, FIRST_SHARE)?;
        least = least.min(share);
        found.push(Finding::told(
            format!("share of the gains at X {x:.0} Y {y:.0} before it rings"),
            format!("{share:.2}"),
        ));
    }
    let share = MARGIN * least;
    go_to(bench, [0.0, 0.0])?;
    set(bench, share)?;
    bench.set(&[(id::REST_STIFFNESS, at_rest(share))])?;
    found.push(Finding::new(
        "share that is used",
        format!("{share:.2}: velocity gain {:.1} V s/rad", WHOLE[1] * share),
        format!("over {LEAST_SHARE}"),
        share > LEAST_SHARE,
        "a transmission that gives way so much needs a notch (0x54500340), or to be made stiffer",
    ));
    Ok(())
}

/// Goes there, and comes to rest.
fn go_to(bench: &mut Bench<'_>, [x, y]: [f64; 2]) -> Result<(), CommissionError> {
    bench.ask(&format!("MOV X {x} Y {y}"))?;
    let waited = bench.wait_for_target(20.0);
    unless_hunting(bench, waited)
}

/// The largest share, of those tried up to a limit, at which nothing rings.
fn ultimate(bench: &mut Bench<'_>, limit: f64) -> Result<f64, CommissionError> {
    let mut quiet = [0.0; AXES];
    for (pivot, quiet) in quiet.iter_mut().enumerate() {
        *quiet = ringing(bench, pivot)?.unwrap_or(f64::INFINITY) / FIRST_SHARE;
    }
    let (mut good, mut share) = (FIRST_SHARE, FIRST_SHARE * STEP);
    while share <= limit {
        set(bench, share)?;
        for (pivot, quiet) in quiet.iter().enumerate() {
            match ringing(bench, pivot)? {
                Some(now) if now < RINGS * quiet * share => {}
                _ => return Ok(good),
            }
        }
        good = share;
        share *= STEP;
    }
    Ok(good)
}

/// Root mean square of the current's change from tick to tick, A, some time after a kick; `None` where that was a fault.
fn ringing(bench: &mut Bench<'_>, pivot: usize) -> Result<Option<f64>, CommissionError> {
    let line = format!("EXC STEP {} {KICK_V} {KICK_MS}", pivot + 1);
    let record = match bench.record(pivot, TICKS, 1, Some(&line)) {
        Err(RecordError::Refused { .. }) => return recovered(bench),
        record => record?,
    };
    if !bench.fault()?.is_empty() {
        return recovered(bench);
    }
    let end = &record.signals.current_a[TICKS - END..];
    let squares: f64 = end.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum();
    Ok(Some((squares / END as f64).sqrt()))
}

/// After a fault: held again, with the first gains.
fn recovered(bench: &mut Bench<'_>) -> Result<Option<f64>, CommissionError> {
    bench.clear_fault()?;
    set(bench, FIRST_SHARE)?;
    bench.hold()?;
    Ok(None)
}

//! Zeros without a jig: each ring is moved alone, both ways, until a guide is at its end; once from where the platform is, once from the middle.

use super::zeros;
use crate::commission::aside::Aside;
use crate::commission::bench::Bench;
use crate::commission::found::{CommissionError, Finding, Found, fail};
use crate::commission::id::AXES;
use crate::commission::known::Known;
use crate::commission::touch::{LIMITS, Touch};
use calibration::GUIDE_ENDS;
use commissioning::guide_ends;
use commissioning::guide_ends::GuideEnds;
use kinematics::{Pose, direct};
use std::f64::consts::TAU;

type Result<T> = std::result::Result<T, CommissionError>;

/// Rounds in which rings go to the middle, one after the other, a share of the way each time.
const SHARES: usize = 3;
/// Limits: what is left of contacts and ends over what is usual, what other zeros would leave over it, and how well zeros have to be known, rad.
const MOST_LEFT: f64 = 3.0;
const LEAST_NEXT_BEST: f64 = 3.0;
const MOST_DEVIATION_RAD: f64 = 10e-3;
const ADVICE: &str = "a ring was stopped by something else than the end of a guide: see that nothing is in the way; or use the jig (step `zeros`)";

pub(super) fn run(bench: &mut Bench<'_>, known: &mut Known, found: &mut Found) -> Result<()> {
    let before = Aside::set(bench, &LIMITS)?;
    let mut contacts = round(bench)?;
    let roughly = zeros_of(&contacts)?;
    // Zeros that may be wrong drive nothing.
    if is_in_doubt(&roughly) {
        judge(found, &roughly, contacts.len());
        return Ok(());
    }
    to_middle(bench, &roughly)?;
    contacts.extend(round(bench)?);
    let ends = zeros_of(&contacts)?;
    to_middle(bench, &ends)?;
    before.give_back(bench)?;
    judge(found, &ends, contacts.len());
    zeros::set(bench, known, found, ends.too_large_rad)
}

/// Where the pivots are as each ring is at either end of where it can go alone.
fn round(bench: &mut Bench<'_>) -> Result<Vec<[f64; AXES]>> {
    let mut contacts = Vec::new();
    for ring in 0..AXES {
        let start = bench.pivots_rad()?[ring];
        for sign in [1.0, -1.0] {
            contacts.push(Touch { ring, sign }.pivots_rad(bench)?);
        }
        go(bench, ring, start)?;
    }
    Ok(contacts)
}

fn zeros_of(contacts: &[[f64; AXES]]) -> Result<GuideEnds> {
    guide_ends(contacts, GUIDE_ENDS).or_else(|error| fail(error.to_string(), ADVICE))
}

/// Brings the platform into the middle, turned as it is, with these zeros.
fn to_middle(bench: &mut Bench<'_>, ends: &GuideEnds) -> Result<()> {
    for left in (0..SHARES).rev() {
        let told = bench.pivots_rad()?;
        let pivots = std::array::from_fn(|i| told[i] - ends.too_large_rad[i]);
        let Ok(pose) = direct::<f64>(&pivots) else {
            return fail("no platform can be where it is said to be", ADVICE);
        };
        let middle = kinematics::inverse(&Pose {
            x: 0.0,
            y: 0.0,
            theta: pose.theta,
        });
        let Ok(middle) = middle else {
            return fail("no pivots hold the platform in the middle", ADVICE);
        };
        for ring in 0..AXES {
            // As many turns as it has made, whatever the other rings' are.
            let off: f64 = (middle.pivots[ring] - pivots[ring]) / TAU;
            let off_rad = (off - off.round()) * TAU;
            go(bench, ring, told[ring] + off_rad / (left + 1) as f64)?;
        }
    }
    Ok(())
}

/// Moves a ring to a told angle.
fn go(bench: &mut Bench<'_>, ring: usize, to_rad: f64) -> Result<()> {
    let by_rad = to_rad - bench.pivots_rad()?[ring];
    Touch::go(bench, ring, by_rad)
}

/// Whether something else may have stopped a ring, or other zeros fit as well.
fn is_in_doubt(ends: &GuideEnds) -> bool {
    ends.left >= MOST_LEFT || ends.next_best <= LEAST_NEXT_BEST
}

fn judge(found: &mut Found, ends: &GuideEnds, contacts: usize) {
    found.push(Finding::new(
        format!("what {contacts} contacts and the guides' ends are off"),
        format!("{:.1} times what is usual", ends.left),
        format!("under {MOST_LEFT:.0}"),
        ends.left < MOST_LEFT,
        ADVICE,
    ));
    found.push(Finding::new(
        "what other zeros would leave",
        format!("{:.0} times as much", ends.next_best.min(1e3)),
        format!("over {LEAST_NEXT_BEST:.0}"),
        ends.next_best > LEAST_NEXT_BEST,
        ADVICE,
    ));
    found.push(Finding::new(
        "zeros are known to",
        format!("{:.1} mrad", ends.deviation_rad * 1e3),
        format!("under {:.0}", MOST_DEVIATION_RAD * 1e3),
        ends.deviation_rad < MOST_DEVIATION_RAD,
        ADVICE,
    ));
}

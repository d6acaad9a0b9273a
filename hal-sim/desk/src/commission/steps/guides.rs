//! Friction of the carriages along their guides, from the moves of `forces`, and how guides give way, from the resonances: no encoder sees either. Made up
//! for where the pivots follow no worse for it.

use super::forces::{HOME, lines};
use crate::commission::bench::{Bench, PEAK};
use crate::commission::found::{CommissionError, Finding, Found, fail};
use crate::commission::id;
use crate::commission::known::Known;
use commissioning::drive_model::{Mechanical, NAMES};

/// How well friction has to be known, over itself or over a newton, whichever is more, and the give over itself, to be made up for.
const MOST_UNCERTAIN: f64 = 0.15;
const LEAST_N: f64 = 1.0;
/// How much larger the following error may be with it, and by how much two such peaks differ anyway, rad.
const MOST_WORSE: f64 = 1.1;
const PEAKS_DIFFER_RAD: f64 = 5e-6;
const N_UM: f64 = 1e-6;

pub(super) fn run(
    bench: &mut Bench<'_>,
    known: &mut Known,
    found: &mut Found,
) -> Result<(), CommissionError> {
    let Some(carriages) = known.platform.map(|platform| platform.carriages) else {
        return fail(
            "what carriages rub is found by the moves of the step `forces`",
            "begin with the step `forces`",
        );
    };
    let coulomb_n = carriages.coulomb_n.max(0.0);
    let uncertain = carriages.deviation_n / coulomb_n.max(LEAST_N);
    found.number("friction of a carriage", coulomb_n, "N");
    found.push(Finding::told(
        "friction of a carriage along its guide, mean of three",
        format!(
            "{coulomb_n:.2} N, +-{:.2}, and {:.1} N s/m",
            carriages.deviation_n, carriages.viscous_n_s_m
        ),
    ));
    let mut values = Vec::new();
    if uncertain < MOST_UNCERTAIN {
        values.push((id::GUIDE_COULOMB, coulomb_n));
        values.push((id::GUIDE_VISCOUS, carriages.viscous_n_s_m.max(0.0)));
    }
    if let Some(model) = &known.model {
        let radius_m = 1e-3 * bench.parameter(id::TRACK_RADIUS)?;
        let (stiffness_n_um, deviation) = stiffness(&model.mechanical, radius_m);
        found.number("stiffness across a guide", stiffness_n_um, "N/um");
        found.push(Finding::told(
            "stiffness across a guide",
            format!("{stiffness_n_um:.1} N/um, +-{:.1} %", 100.0 * deviation),
        ));
        if deviation < MOST_UNCERTAIN {
            values.push((id::GUIDE_STIFFNESS, stiffness_n_um));
        }
    }
    if values.is_empty() {
        found.push(Finding::told(
            "made up for",
            "nothing: neither is known well enough",
        ));
        return Ok(());
    }
    make_up_for(bench, found, &values)
}

/// Across a guide, N/um, and its standard deviation over itself.
fn stiffness(mechanical: &Mechanical, radius_m: f64) -> (f64, f64) {
    let at = NAMES.iter().position(|name| *name == "guide stiffness");
    let deviation = at.and_then(|at| mechanical.deviations.get(at));
    (
        N_UM * mechanical.chain.guide_stiffness / (radius_m * radius_m),
        deviation.copied().unwrap_or(f64::INFINITY),
    )
}

/// Puts these parameters in force, unless the pivots follow worse with them.
fn make_up_for(
    bench: &mut Bench<'_>,
    found: &mut Found,
    values: &[(u32, f64)],
) -> Result<(), CommissionError> {
    let mut before = values.to_vec();
    for (id, value) in &mut before {
        *value = bench.parameter(*id)?;
    }
    let without_rad = followed(bench)?;
    bench.set(values)?;
    let with_rad = match followed(bench) {
        Err(error) if bench.is_faulted()? => {
            bench.clear_fault()?;
            bench.set(&before)?;
            bench.hold()?;
            found.push(Finding::told("tried, and not kept", error.to_string()));
            return Ok(());
        }
        with_rad => with_rad?,
    };
    let is_better = with_rad < MOST_WORSE * without_rad + PEAKS_DIFFER_RAD;
    if !is_better {
        bench.set(&before)?;
    }
    let told = format!(
        "{:.0} urad, {:.0} without",
        1e6 * with_rad,
        1e6 * without_rad
    );
    found.push(Finding::told(
        if is_better {
            "largest following error with that made up for"
        } else {
            "tried, and not kept: largest following error with that made up for"
        },
        told,
    ));
    Ok(())
}

/// The largest following error of a pivot over a round of moves, rad.
fn followed(bench: &mut Bench<'_>) -> Result<f64, CommissionError> {
    bench.number("LST?", PEAK)?;
    for line in lines(0).chain([HOME.to_owned()]) {
        bench.ask(&line)?;
        bench.stay()?;
    }
    Ok(bench.number("LST?", PEAK)?)
}

//! The loop as it is with the gains so far: in the middle, as identification has recorded it, and near the rim.

use super::identification::allow;
use super::step_response::step_response;
use crate::commission::bench::Bench;
use crate::commission::found::{CommissionError, Finding, Found, fail};
use crate::commission::id;
use crate::commission::known::Known;
use crate::commission::measured_loop::{MeasuredLoop, plot};
use crate::commission::servo_gains;
use crate::commission::sines::{CENTRE, NEAR_RIM, PEAK_V};
use commissioning::chain::Place;

/// Most that two ways of measuring the same may differ by.
const MOST_OFF: f64 = 0.2;

pub(super) fn run(
    bench: &mut Bench<'_>,
    known: &mut Known,
    found: &mut Found,
) -> Result<(), CommissionError> {
    let Some(model) = known.model.clone() else {
        return fail(
            "the windings and springs of this machine are not known",
            "begin with the step `identification`",
        );
    };
    let excited = known.excited.take();
    let peak_v = (excited.as_ref()).map_or(PEAK_V, |excited| excited.peak_v);
    allow(bench, peak_v)?;
    known.loops.clear();
    let gains = servo_gains::read(bench)?;
    let radius_m = 1e-3 * bench.parameter(id::TRACK_RADIUS)?;
    for spot in [CENTRE, NEAR_RIM] {
        let measured = match &excited {
            Some(excited) if spot == CENTRE => {
                MeasuredLoop::new(excited, (spot, &Place::centre()), &model)
            }
            _ => MeasuredLoop::measure(bench, spot, peak_v, &model)?,
        };
        found.push(told(&measured));
        measured.tell_numbers(found);
        let chain = &model.mechanical.chain;
        let off = measured
            .distance(&gains, chain, radius_m)
            .unwrap_or(f64::INFINITY);
        found.push(Finding::new(
            format!("S {} against what the gains make of the plant", spot.words()),
            format!("{:.1} % off in the median", 100.0 * off),
            format!("under {:.0} %", 100.0 * MOST_OFF),
            off < MOST_OFF,
            "the servo is not what its parameters say, or currents and windings are off: measure the windings again",
        ));
        found.plots.push(plot(&measured, None));
        known.loops.push(measured);
    }
    step_response(bench, found)
}

fn told(measured: &MeasuredLoop) -> Finding {
    Finding::told(
        format!("loop {}", measured.spot.words()),
        format!(
            "Ms {:.2}, S(30 Hz) {:.3}, crossover {:.0} Hz",
            measured.ms(),
            measured.rejection(),
            measured.crossover_hz()
        ),
    )
}

//! Each ring under a soft servo of its own, moved by a milliradian there and back.

use crate::commission::bench::Bench;
use crate::commission::found::{CommissionError, Finding, Found};
use crate::commission::id::AXES;
use crate::commission::known::Known;

/// Way, mrad; rate, mrad/s; time, ms.
const WAY_MRAD: f64 = 1.0;
const RATE_MRAD_S: f64 = 50.0;
const MS: f64 = 600.0;
/// Ticks from row to row of the record.
const EVERY: usize = 20;
/// Most that it may go too far, and be off at the end, over the way.
const MOST_OVERSHOOT: f64 = 0.6;
const MOST_LEFT: f64 = 0.1;

pub(super) fn run(
    bench: &mut Bench<'_>,
    _: &mut Known,
    found: &mut Found,
) -> Result<(), CommissionError> {
    for pivot in 0..AXES {
        for sign in [1.0, -1.0] {
            let line = format!(
                "EXC RING {} {} {RATE_MRAD_S} {MS}",
                pivot + 1,
                sign * WAY_MRAD
            );
            // Its last rows are of the time before it lets go.
            let rows = (MS / 1e3 / bench.period_s) as usize / EVERY - 20;
            let signals = bench.record(pivot, rows, EVERY, Some(&line))?.signals;
            bench.delay(0.3)?;
            bench.excitation_end()?;
            let start = signals.angle_rad[0];
            let way = |angle: f64| sign * (angle - start) / (WAY_MRAD * 1e-3);
            let most = signals
                .angle_rad
                .iter()
                .map(|angle| way(*angle))
                .fold(0.0, f64::max);
            let end = way(signals.angle_rad[rows - 1]);
            found.push(Finding::new(
                format!("pivot {} by {:+} mrad", pivot + 1, sign * WAY_MRAD),
                format!("{:.0} % at most, {:.0} % at the end", most * 100.0, end * 100.0),
                format!(
                    "under {:.0} %, and within {:.0} of 100",
                    100.0 * (1.0 + MOST_OVERSHOOT),
                    100.0 * MOST_LEFT
                ),
                most < 1.0 + MOST_OVERSHOOT && (end - 1.0).abs() < MOST_LEFT,
                "lower 0x54500D03, the share of the gains, or the gains, where it swings; where it stays behind, look for what rubs",
            ));
        }
    }
    Ok(())
}

//! What was found is kept, and is in force after it as before.

use super::nudges::USUAL_EXCITATION_V;
use crate::commission::bench::Bench;
use crate::commission::found::{CommissionError, Finding, Found};
use crate::commission::id;
use crate::commission::id::AXES;
use crate::commission::known::Known;

pub(super) fn run(
    bench: &mut Bench<'_>,
    known: &mut Known,
    found: &mut Found,
) -> Result<(), CommissionError> {
    bench.ask("SVO X 0")?;
    bench.delay(0.2)?;
    bench.give_back_recorder()?;
    // As much as a machine that nobody knows is given: whoever commissions it again finds it so.
    bench.set(&[(id::EXCITATION_V, USUAL_EXCITATION_V)])?;
    bench.ask("WPA 100")?;
    bench.ask("RPA")?;
    bench.delay(0.1)?;
    let mut same = bench.parameter(id::ENCODER_ORDER)? == Known::digits(&known.ports)
        && bench.parameter(id::BRIDGE_ORDER)? == Known::digits(&known.bridges);
    for pivot in 0..AXES {
        let kept = bench.parameter(id::of(id::RESISTANCE, pivot))?;
        same &= (kept - known.windings[pivot][0]).abs() < 1e-9;
    }
    found.push(Finding::new(
        "kept settings",
        if same {
            "read back as they were set"
        } else {
            "are not what was set"
        },
        "the same",
        same,
        "the flash does not keep what is written: EVT? tells why",
    ));
    Ok(())
}

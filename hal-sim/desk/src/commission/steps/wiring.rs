//! Encoders, supply and current sensors at rest, with the bridges asleep.

use super::gains;
use crate::commission::bench::{Bench, Recorded, average};
use crate::commission::found::{CommissionError, Finding, Found};
use crate::commission::id;
use crate::commission::id::AXES;
use crate::commission::known::Known;

/// Ticks of a look at an encoder's noise, and most of it: an encoder's own 200 nrad and half as much again.
const TICKS: usize = 1_000;
const MOST_NOISE_RAD: f64 = 300e-9;
/// Looks that a machine with little friction has to come to rest, now that its motors have been switched off.
const LOOKS: usize = 40;
/// Most that a current sensor is off, A.
const MOST_OFFSET_A: f64 = 0.05;
/// How far the supply may be off its nominal value.
const SUPPLY_SHARE: f64 = 0.1;

pub(super) fn run(
    bench: &mut Bench<'_>,
    _: &mut Known,
    found: &mut Found,
) -> Result<(), CommissionError> {
    bench.ask("CCL 1 ADVANCED")?;
    bench.ask("SVO X 0")?;
    bench.ask("FLC")?;
    bench.delay(0.1)?;
    bench.ask("CMS 0")?;
    for pivot in 0..AXES as u32 {
        bench.set(&[
            (id::ENCODER_ZERO + pivot, 0.0),
            (id::ENCODER_REVERSED + pivot, 0.0),
            (id::MOTOR_REVERSED + pivot, 0.0),
        ])?;
    }
    bench.set(&[(id::ENCODER_ORDER, 123.0), (id::BRIDGE_ORDER, 123.0)])?;
    bench.delay(0.05)?;
    gains::forget(bench)?;
    for port in 1..=AXES {
        let answers = bench.number("TST?", &format!("ENCODER{port}"))? == 1.0;
        found.push(Finding::new(
            format!("encoder at port {port}"),
            if answers {
                "answers"
            } else {
                "does not answer"
            },
            "answers",
            answers,
            "its plug, its supply, and its type: see BRINGUP.md, encoders",
        ));
    }
    if found.findings.iter().any(|finding| !finding.passed) {
        return Ok(());
    }
    let (mut supply_v, nominal_v) = (0.0, bench.parameter(id::NOMINAL_SUPPLY)?);
    for pivot in 0..AXES {
        let (record, noise_rad) = at_rest(bench, pivot)?;
        found.push(Finding::new(
            format!("noise of the encoder at port {}", pivot + 1),
            format!("{:.0} nrad rms", noise_rad * 1e9),
            format!("under {:.0}", MOST_NOISE_RAD * 1e9),
            noise_rad < MOST_NOISE_RAD,
            "is the machine at rest? If so: shield and termination of its cable",
        ));
        let offset_a = average(&record.signals.current_a);
        found.push(Finding::new(
            format!("offset of current sensor {}", pivot + 1),
            format!("{:.0} mA", offset_a * 1e3),
            format!("within {:.0}", MOST_OFFSET_A * 1e3),
            offset_a.abs() < MOST_OFFSET_A,
            "the sensor's reference and its filter",
        ));
        found.number(
            format!("noise of the encoder at port {}", pivot + 1),
            noise_rad * 1e9,
            "nrad",
        );
        supply_v = record.supply_v;
    }
    found.number("supply", supply_v, "V");
    found.push(Finding::new(
        "supply",
        format!("{supply_v:.1} V"),
        format!("{nominal_v:.0} V +-{:.0} %", SUPPLY_SHARE * 100.0),
        (supply_v / nominal_v - 1.0).abs() < SUPPLY_SHARE,
        "the supply, its fuse and contactor; parameter 0x54500806 is the nominal one",
    ));
    Ok(())
}

/// A pivot's record once it rests, or the last of those in which it had to come to rest; and the noise of its angle.
fn at_rest(bench: &mut Bench<'_>, pivot: usize) -> Result<(Recorded, f64), CommissionError> {
    let mut looks = 1;
    loop {
        let record = bench.record(pivot, TICKS, 1, None)?;
        let noise_rad = deviation(&record.signals.angle_rad);
        if noise_rad < MOST_NOISE_RAD || looks == LOOKS {
            return Ok((record, noise_rad));
        }
        looks += 1;
    }
}

fn deviation(values: &[f64]) -> f64 {
    let mean = average(values);
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (squares / values.len().max(1) as f64).sqrt()
}

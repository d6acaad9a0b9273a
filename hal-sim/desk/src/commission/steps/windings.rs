//! Short pulses of two sizes and both signs: resistance and inductance of each winding, and what the dead time takes.

use crate::commission::bench::Bench;
use crate::commission::found::{CommissionError, Finding, Found, fail};
use crate::commission::id;
use crate::commission::id::AXES;
use crate::commission::known::Known;
use commissioning::record::Timing;
use commissioning::winding::{WindingGuess, winding};

/// Pulses, V, how long they are, ms, and the ticks of a record: before them the bridge is given 2 ms to wake up.
const PULSES_V: [f64; 4] = [2.0, -2.0, 1.0, -1.0];
const PULSE_MS: f64 = 2.0;
const TICKS: usize = 100;

pub(super) fn run(
    bench: &mut Bench<'_>,
    known: &mut Known,
    found: &mut Found,
) -> Result<(), CommissionError> {
    for pivot in 0..AXES {
        let mut pulses = Vec::new();
        for volts in PULSES_V {
            let line = format!("EXC STEP {} {volts} {PULSE_MS}", pivot + 1);
            pulses.push(bench.record(pivot, TICKS, 1, Some(&line))?.signals);
            bench.delay(0.1)?;
        }
        let guess = guess(bench, pivot)?;
        let result = winding(&pulses, &Timing::STAGE, &guess);
        let measured = match result {
            Ok(measured) => measured,
            Err(error) => {
                return fail(
                    format!(
                        "motor of pivot {}, bridge {}: {error}",
                        pivot + 1,
                        known.bridges[pivot] + 1
                    ),
                    "its leads, its plug and its bridge; or set the motor's parameters (0x54500800 to 0x5450080A) to its data sheet's first",
                );
            }
        };
        known.windings[pivot] = [measured.resistance_ohm, measured.inductance_h];
        bench.set(&[
            (id::of(id::RESISTANCE, pivot), measured.resistance_ohm),
            (id::of(id::INDUCTANCE, pivot), measured.inductance_h),
        ])?;
        let name = format!("winding of pivot {}", pivot + 1);
        found.number(name.clone(), measured.resistance_ohm, "ohm");
        found.number(name, measured.inductance_h * 1e3, "mH");
        found.push(Finding::new(
            format!("winding of pivot {}", pivot + 1),
            format!(
                "{:.2} ohm, {:.2} mH, the dead time takes {:.2} V",
                measured.resistance_ohm,
                measured.inductance_h * 1e3,
                measured.dead_time_v
            ),
            "within a factor of two of its parameters",
            true,
            "",
        ));
    }
    Ok(())
}

fn guess(bench: &mut Bench<'_>, pivot: usize) -> Result<WindingGuess, CommissionError> {
    let mut value = |first: u32| bench.parameter(id::of(first, pivot));
    let (resistance_ohm, inductance_h) = (value(id::RESISTANCE)?, value(id::INDUCTANCE)?);
    let motor_constant = value(id::TORQUE_CONSTANT)? * value(id::GEAR_RATIO)?;
    let (dead_time_s, knee_a) = (value(id::DEAD_TIME)?, value(id::DEAD_TIME_KNEE)?);
    let (supply_v, pwm_hz) = (
        bench.parameter(id::NOMINAL_SUPPLY)?,
        bench.parameter(id::PWM_HZ)?,
    );
    Ok(WindingGuess {
        resistance_ohm,
        inductance_h,
        motor_constant,
        dead_time_v: dead_time_s * pwm_hz * supply_v,
        knee_a,
    })
}

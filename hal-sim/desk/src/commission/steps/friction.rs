//! Turning without end at steady rates, both ways: motor constants from the volts, friction from the currents.

use super::id;
use crate::commission::bench::{Bench, average};
use crate::commission::found::{CommissionError, Finding, fail};
use crate::commission::known::{AXES, Known};
use commissioning::friction::{SteadyRate, friction, mean};

/// Rates, rad/s, and how long each is kept before it is measured, s.
const RATES_RAD_S: [f64; 6] = [0.3, 1.0, 3.0, -0.3, -1.0, -3.0];
const REACHED_S: f64 = 1.5;
/// Rows of a record, about: it is of whole turns of the motor.
const ROWS: usize = 1_000;
const MOST_ROWS: usize = 1_100;

pub(super) fn run(
    bench: &mut Bench<'_>,
    known: &mut Known,
    found: &mut Vec<Finding>,
) -> Result<(), CommissionError> {
    let mut steady: [Vec<SteadyRate>; AXES] = Default::default();
    bench.reserve(MOST_ROWS)?;
    for rate in RATES_RAD_S {
        bench.ask(&format!("JOG W {}", rate.to_degrees()))?;
        bench.delay(REACHED_S)?;
        for (pivot, steady) in steady.iter_mut().enumerate() {
            steady.push(measure(bench, pivot, rate)?);
        }
    }
    bench.ask("HLT")?;
    bench.settle()?;
    bench.ask("MOV W 0")?;
    bench.wait_for_target(60.0)?;
    let mut all = Vec::new();
    for pivot in 0..AXES {
        let resistance_ohm = known.windings[pivot][0];
        match friction(&shared(&steady, pivot, resistance_ohm), resistance_ohm) {
            Ok(measured) => all.push(measured),
            Err(error) => {
                return fail(
                    format!("motor of pivot {}: {error}", pivot + 1),
                    "what rubs unevenly is a bearing, a gear or a cable",
                );
            }
        }
    }
    let [coulomb, viscous] = mean(&[all[0], all[1], all[2]]);
    for (pivot, one) in all.iter().enumerate() {
        let gear = bench.parameter(id::of(id::GEAR_RATIO, pivot))?;
        bench.set(&[
            (
                id::of(id::TORQUE_CONSTANT, pivot),
                one.motor_constant / gear,
            ),
            (id::of(id::COULOMB, pivot), coulomb),
            (id::of(id::VISCOUS, pivot), viscous.max(0.0)),
        ])?;
        found.push(Finding::told(
            format!("motor of pivot {}", pivot + 1),
            format!("{:.3} V s/rad at the ring", one.motor_constant),
        ));
    }
    found.push(Finding::told(
        "friction of a ring with its share of the platform, mean of three",
        format!("{coulomb:.3} N m, and {viscous:.3} N m s/rad"),
    ));
    Ok(())
}

/// A pivot's with the mean of the three currents. Carriages that do not slide hold a torque between the rings, another one each time that
/// the platform starts: the mean is friction, one alone is not. What a winding's own current takes of its volts stays its own.
fn shared(steady: &[Vec<SteadyRate>; AXES], pivot: usize, resistance_ohm: f64) -> Vec<SteadyRate> {
    (steady[pivot].iter().enumerate())
        .map(|(at, own)| {
            let current_a = steady.iter().map(|all| all[at].current_a).sum::<f64>() / AXES as f64;
            SteadyRate {
                volts: own.volts - resistance_ohm * (own.current_a - current_a),
                current_a,
                ..*own
            }
        })
        .collect()
}

fn measure(bench: &mut Bench<'_>, pivot: usize, rate: f64) -> Result<SteadyRate, CommissionError> {
    let motor_turn_s =
        std::f64::consts::TAU / (rate.abs() * bench.parameter(id::of(id::GEAR_RATIO, pivot))?);
    // Ten turns of the motor at least, and a second.
    let turns = (1.0 / motor_turn_s).ceil().max(10.0);
    let every = (turns * motor_turn_s / bench.period_s / ROWS as f64)
        .round()
        .max(1.0) as usize;
    let rows = (turns * motor_turn_s / bench.period_s / every as f64).round() as usize;
    let signals = bench.record(pivot, rows, every, None)?.signals;
    let seconds = (rows - 1) as f64 * every as f64 * bench.period_s;
    Ok(SteadyRate {
        rate_rad_s: (signals.angle_rad[rows - 1] - signals.angle_rad[0]) / seconds,
        current_a: average(&signals.current_a),
        volts: average(&signals.volts),
    })
}

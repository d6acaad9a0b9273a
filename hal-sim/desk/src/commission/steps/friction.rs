//! Turning without end at steady rates, both ways: motor constants from the volts, friction from the currents.

use crate::commission::bench::{ANGLE, Bench, CURRENT, DUTY, SUPPLY};
use crate::commission::found::{CommissionError, Finding, Found, fail};
use crate::commission::id;
use crate::commission::id::AXES;
use crate::commission::known::Known;
use crate::record::RecordError;
use commissioning::dead_time::dead_time_share;
use commissioning::friction::{MOST_RESIDUAL, SteadyRate, friction, mean};
use std::f64::consts::TAU;

/// Rates, rad/s, and how long each is kept before it is measured, s. Faster and faster one way, slower and slower the other: windings that grow
/// warm meanwhile take as much more of the volts at slow rates as at fast ones.
const RATES_RAD_S: [f64; 6] = [0.7, 1.4, 3.0, -3.0, -1.4, -0.7];
const REACHED_S: f64 = 1.5;
/// Rows of a record, about, which is of a whole turn of the platform, and how many of them there is room for.
const ROWS: f64 = 2_000.0;
const MOST_ROWS: usize = 2_200;

pub(super) fn run(
    bench: &mut Bench<'_>,
    known: &mut Known,
    found: &mut Found,
) -> Result<(), CommissionError> {
    let mut steady: [Vec<SteadyRate>; AXES] = Default::default();
    bench.reserve(MOST_ROWS)?;
    for rate in RATES_RAD_S {
        bench.turn(rate)?;
        bench.delay(REACHED_S)?;
        for (steady, one) in steady.iter_mut().zip(measure(bench, rate)?) {
            steady.push(one);
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
        known.motor_constants[pivot] = one.motor_constant;
        let motor_constant = known.motor_constant(pivot);
        let torque_constant = torque_constant(bench, pivot, motor_constant)?;
        bench.set(&[
            torque_constant,
            (id::of(id::COULOMB, pivot), coulomb),
            (id::of(id::VISCOUS, pivot), viscous.max(0.0)),
        ])?;
        found.number(
            format!("motor of pivot {}", pivot + 1),
            motor_constant,
            "V s/rad",
        );
        found.push(Finding::told(
            format!("motor of pivot {}", pivot + 1),
            format!("{motor_constant:.3} V s/rad at the ring"),
        ));
    }
    let left = all.iter().map(|one| one.residual).fold(0.0, f64::max);
    found.push(Finding::new(
        "what Coulomb's and viscous friction leave of the currents",
        format!("{:.1} % of Coulomb's at most", 100.0 * left),
        format!("under {:.0} %", 100.0 * MOST_RESIDUAL),
        left <= MOST_RESIDUAL,
        "what rubs unevenly is a bearing, a gear or a cable",
    ));
    found.number("Coulomb friction", coulomb, "N m");
    found.number("viscous friction", viscous, "N m s/rad");
    found.push(Finding::told(
        "friction of a ring with its share of the platform, mean of three",
        format!("{coulomb:.3} N m, and {viscous:.3} N m s/rad"),
    ));
    Ok(())
}

/// The parameter that tells a motor constant, and its value.
pub(super) fn torque_constant(
    bench: &mut Bench<'_>,
    pivot: usize,
    motor_constant: f64,
) -> Result<(u32, f64), RecordError> {
    let gear = bench.parameter(id::of(id::GEAR_RATIO, pivot))?;
    Ok((id::of(id::TORQUE_CONSTANT, pivot), motor_constant / gear))
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

/// Means over a turn of the platform, of all pivots at the same time: rings that do not run true move the carriages by some tens of micrometres
/// as they turn, further than these preslide, so that the torque that they hold between the rings changes with the angle.
fn measure(bench: &mut Bench<'_>, rate: f64) -> Result<[SteadyRate; AXES], CommissionError> {
    let turn_ticks = TAU / rate.abs() / bench.period_s;
    let every = (turn_ticks / ROWS).round().max(1.0);
    let rows = (turn_ticks / every).round() as usize;
    let mut tables = vec![SUPPLY.to_owned(), format!("1 {ANGLE}")];
    for option in [DUTY, CURRENT] {
        tables.extend((1..=AXES).map(|pivot| format!("{pivot} {option}")));
    }
    let record = bench.record_tables(&tables, rows, every as usize, None)?;
    let column = |at: usize| record.rows.iter().map(move |row| row[at]);
    let knee_a = bench.parameter(id::of(id::DEAD_TIME_KNEE, 0))?;
    let mean = |values: &mut dyn Iterator<Item = f64>| values.sum::<f64>() / rows as f64;
    let angles: Vec<f64> = column(1).collect();
    let seconds = (rows - 1) as f64 * every * bench.period_s;
    let rate_rad_s = (angles[rows - 1] - angles[0]).to_radians() / seconds;
    Ok([0, 1, 2].map(|pivot| SteadyRate {
        rate_rad_s,
        current_a: mean(&mut column(2 + AXES + pivot)),
        volts: mean(&mut column(0).zip(column(2 + pivot)).map(|(v, duty)| v * duty)),
        dead_time_share: mean(&mut column(2 + AXES + pivot).map(|i| dead_time_share(i, knee_a))),
    }))
}

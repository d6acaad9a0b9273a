//! Turning without end once more, and faster: how unevenly each gear turns. Made up for from here on, where the rings turn the more evenly for it.

use crate::commission::bench::Bench;
use crate::commission::found::{CommissionError, Finding, Found, fail};
use crate::commission::id;
use crate::commission::id::AXES;
use crate::commission::known::Known;
use crate::record::RecordError;
use commissioning::chain::{Load, Place};
use commissioning::gear::{self, Gear, GearError, Turning, gear, once_a_turn};
use commissioning::{Signals, Timing};
use nalgebra::{Complex, Matrix3, Vector3};
use std::f64::consts::TAU;

/// Rates, as shares of the largest that a pivot and the platform may have, and how long each is kept before it is measured, s.
const RATES: [f64; 4] = [0.7, 0.35, -0.35, -0.7];
const REACHED_S: f64 = 0.7;
/// Rows of a record, which is of a quarter turn of the platform.
const ROWS: usize = 2_000;
const TURN_RAD: f64 = 0.25 * TAU;
/// How often the fastest are measured once more, both ways.
const AGAIN: usize = 4;
/// An error that is not so many of its standard deviations is none that is known.
const LEAST_SURE: f64 = 5.0;

pub(super) fn run(
    bench: &mut Bench<'_>,
    known: &mut Known,
    found: &mut Found,
) -> Result<(), CommissionError> {
    let mut drives = Vec::new();
    for pivot in 0..AXES {
        drives.push(drive(bench, known, pivot)?);
    }
    let gears = Gears {
        inertia: inertia(bench)?,
        drives,
    };
    let rotation_rad_s = bench.parameter(id::ROTATION_SPEED)?.to_radians();
    let most_rad_s = f64::min(bench.parameter(id::PIVOT_RATE)?, rotation_rad_s);
    let rates = RATES.map(|share| share * most_rad_s);
    let before = set_aside(bench)?;
    bench.reserve(ROWS)?;
    let mut turnings = Default::default();
    let roughly = gears.find(bench, &rates, &mut turnings)?;
    still(bench)?;
    let is_sure = |gear: &Gear| gear.amplitude_rad > LEAST_SURE * gear.deviation_rad;
    let sure: Vec<bool> = roughly.gears.iter().map(is_sure).collect();
    if !sure.contains(&true) {
        tell(found, &roughly.gears);
        return Ok(bench.set(&before)?);
    }
    // Once more with that in force: rings that move less beside the steady motion tell apart what that asks for. Several times both ways: one
    // quarter turn has its own friction.
    bench.set(&values(&roughly.gears, &sure))?;
    let fast = [rates[0], rates[3]];
    let gently = gears.find(bench, &[fast; AGAIN].concat(), &mut turnings)?;
    still(bench)?;
    tell(found, &gently.gears);
    bench.set(&values(&gently.gears, &sure))?;
    let left_rad = uneven(&gears.turned(bench, rates[3])?);
    still(bench)?;
    if !is_better(found, left_rad, roughly.uneven_rad) {
        bench.set(&before)?;
    }
    Ok(())
}

/// What is known of drives, rings and platform.
struct Gears {
    drives: Vec<gear::Known>,
    inertia: Matrix3<f64>,
}

/// What was found of the three gears, and how unevenly the rings turned at the last of the rates.
struct Measured {
    gears: Vec<Gear>,
    uneven_rad: f64,
}

impl Gears {
    /// Of the three pivots, from these rates and what was recorded before. The platform turns on at the last of them.
    fn find(
        &self,
        bench: &mut Bench<'_>,
        rates: &[f64],
        turnings: &mut [Vec<Turning>; AXES],
    ) -> Result<Measured, CommissionError> {
        let mut uneven_rad = 0.0;
        for &rate in rates {
            let beside = self.turned(bench, rate)?;
            uneven_rad = uneven(&beside);
            for (pivot, turnings) in turnings.iter_mut().enumerate() {
                let Beside {
                    rate_rad_s,
                    current_a,
                    angle_rad,
                } = beside[pivot];
                let moved = moved(pivot, &beside, &self.inertia, self.drives[pivot].ratio);
                turnings.push(Turning {
                    rate_rad_s,
                    current_a,
                    moved,
                    ring: angle_rad,
                });
            }
        }
        let gears = (turnings.iter().zip(&self.drives))
            .map(|(turnings, drive)| gear(turnings, drive).or_else(no_gear))
            .collect::<Result<_, _>>()?;
        Ok(Measured { gears, uneven_rad })
    }

    /// What varies at each pivot while the platform turns at a rate, which it is brought to.
    fn turned(&self, bench: &mut Bench<'_>, rate: f64) -> Result<Vec<Beside>, CommissionError> {
        bench.turn(rate)?;
        bench.delay(REACHED_S)?;
        (self.drives.iter().enumerate())
            .map(|(pivot, drive)| turned(bench, pivot, rate, drive.ratio))
            .collect()
    }
}

/// The largest amplitude of a ring's following error, once a turn of its motor.
fn uneven(beside: &[Beside]) -> f64 {
    let amplitudes = beside.iter().map(|one| one.angle_rad.norm());
    amplitudes.fold(0.0, f64::max)
}

fn drive(bench: &mut Bench<'_>, known: &Known, pivot: usize) -> Result<gear::Known, RecordError> {
    let mut value = |first: u32| bench.parameter(id::of(first, pivot));
    Ok(gear::Known {
        ratio: value(id::GEAR_RATIO)?,
        motor_constant: known.motor_constant(pivot),
        motor_inertia_kg_m2: value(id::MOTOR_INERTIA)?,
    })
}

fn no_gear<T>(error: GearError) -> Result<T, CommissionError> {
    fail(error.to_string(), "look whether the platform turns evenly")
}

/// What was made up for before, which is not to be in what is measured.
fn set_aside(bench: &mut Bench<'_>) -> Result<Vec<(u32, f64)>, RecordError> {
    let mut before = Vec::new();
    for pivot in 0..AXES {
        for first in [id::GEAR_ERROR, id::GEAR_PHASE] {
            let id = id::of(first, pivot);
            before.push((id, bench.parameter(id)?));
        }
        bench.set(&[(id::of(id::GEAR_ERROR, pivot), 0.0)])?;
    }
    Ok(before)
}

/// What varies once a turn of a pivot's motor.
#[derive(Clone, Copy)]
struct Beside {
    rate_rad_s: f64,
    current_a: Complex<f64>,
    angle_rad: Complex<f64>,
}

/// A quarter turn of the platform at a rate.
fn turned(
    bench: &mut Bench<'_>,
    pivot: usize,
    rate: f64,
    ratio: f64,
) -> Result<Beside, CommissionError> {
    let ticks = TURN_RAD / rate.abs() / bench.period_s;
    let every = (ticks / ROWS as f64).round().max(1.0) as usize;
    let Signals {
        current_a,
        angle_rad,
        ..
    } = bench.record(pivot, ROWS, every, None)?.signals;
    let seconds = (ROWS - 1) as f64 * every as f64 * bench.period_s;
    let rate_rad_s = (angle_rad[ROWS - 1] - angle_rad[0]) / seconds;
    let once = |values: &[f64]| once_a_turn(values, &angle_rad, ratio).or_else(no_gear);
    let Timing {
        angle_s, current_s, ..
    } = Timing::STAGE;
    Ok(Beside {
        rate_rad_s,
        // To when the angle was latched.
        current_a: once(&current_a)? * Complex::cis(-ratio * rate_rad_s * (current_s - angle_s)),
        angle_rad: once(&angle_rad)?,
    })
}

/// Of rings with their drives and the platform with its load in the middle, as the controller has been told.
fn inertia(bench: &mut Bench<'_>) -> Result<Matrix3<f64>, RecordError> {
    let mut rings = Vector3::zeros();
    for pivot in 0..AXES {
        rings[pivot] = bench.parameter(id::of(id::INERTIA, pivot))?;
    }
    let radius_m = 1e-3 * bench.parameter(id::TRACK_RADIUS)?;
    let payload_kg = bench.parameter(id::PAYLOAD_MASS)?;
    let (x_m, y_m) = (
        1e-3 * bench.parameter(id::PAYLOAD_X)?,
        1e-3 * bench.parameter(id::PAYLOAD_Y)?,
    );
    let load = Load {
        mass: (bench.parameter(id::PLATFORM_MASS)? + payload_kg) * radius_m * radius_m,
        inertia: bench.parameter(id::PLATFORM_INERTIA)?
            + bench.parameter(id::PAYLOAD_INERTIA)?
            + payload_kg * (x_m * x_m + y_m * y_m),
        moment: [x_m, y_m].map(|place_m| payload_kg * place_m * radius_m),
    };
    Ok(Matrix3::from_diagonal(&rings) + load.at_rings(&Place::centre()))
}

/// What the motion of all rings beside a steady one asks for at one of them. Each is known over its own angle, and they are a third of a turn apart.
fn moved(pivot: usize, beside: &[Beside], inertia: &Matrix3<f64>, ratio: f64) -> Complex<f64> {
    (beside.iter().enumerate())
        .map(|(other, one)| {
            let apart = (other as f64 - pivot as f64) * TAU / AXES as f64;
            one.angle_rad * Complex::cis(ratio * apart) * inertia[(pivot, other)]
        })
        .sum()
}

/// The parameters that make up for those gears whose error is known.
fn values(gears: &[Gear], sure: &[bool]) -> Vec<(u32, f64)> {
    let of_gear = |(pivot, gear): (usize, &Gear)| {
        [
            (id::of(id::GEAR_ERROR, pivot), 1e6 * gear.amplitude_rad),
            (id::of(id::GEAR_PHASE, pivot), gear.phase_rad.to_degrees()),
        ]
    };
    let known = gears.iter().enumerate().filter(|(pivot, _)| sure[*pivot]);
    known.flat_map(of_gear).collect()
}

fn tell(found: &mut Found, gears: &[Gear]) {
    for (number, gear) in (1..).zip(gears) {
        let amplitude_urad = 1e6 * gear.amplitude_rad;
        found.number(format!("gear of pivot {number}"), amplitude_urad, "urad");
        found.push(Finding::told(
            format!("gear of pivot {number}, once a turn of its motor"),
            format!(
                "{amplitude_urad:.0} urad, +-{:.1}, at {:.0} deg",
                1e6 * gear.deviation_rad,
                gear.phase_rad.to_degrees()
            ),
        ));
    }
}

/// Whether the rings turn more evenly with gears made up for.
fn is_better(found: &mut Found, left_rad: f64, before_rad: f64) -> bool {
    let (left_urad, before_urad) = (1e6 * left_rad, 1e6 * before_rad);
    let is_better = left_urad <= before_urad;
    let name = "following error once a turn of a motor";
    found.number(format!("{name}, gears made up for"), left_urad, "urad");
    found.number(
        format!("{name}, gears not made up for"),
        before_urad,
        "urad",
    );
    let not_kept = if is_better {
        ""
    } else {
        "tried, and not kept: "
    };
    found.push(Finding::told(
        format!("{not_kept}largest {name} with that made up for"),
        format!("{left_urad:.2} urad, {before_urad:.2} without"),
    ));
    is_better
}

fn still(bench: &mut Bench<'_>) -> Result<(), CommissionError> {
    bench.ask("HLT")?;
    bench.settle()?;
    bench.ask("MOV W 0")?;
    bench.wait_for_target(60.0)
}

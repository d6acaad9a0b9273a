//! The error of each encoder within a period of its scale (sub-divisional error), while the platform turns slowly: found, and taken from its
//! readings. It repeats with the lines of the scale, a thousand times a second and more, over what the servo follows.

use crate::commission::bench::{ANGLE, Bench};
use crate::commission::found::{CommissionError, Finding, Found};
use crate::commission::id::{self, AXES};
use crate::commission::known::Known;
use commissioning::subdivision::{Harmonics, size_rad, subdivision, sum};
use std::f64::consts::TAU;

/// Rate of the turn, rad/s, how long it takes to be steady, s, and rows of a record, every tick: as many as there is room for.
const RATE_RAD_S: f64 = 0.5;
const REACHED_S: f64 = 1.0;
const ROWS: usize = 5_400;
/// Looks at it. The servo follows the error by some hundredths, so that the second finds a rest of what the first has found. The last says
/// what is left.
const LOOKS: usize = 3;
/// Most that two records may differ, and that may be left, over what was found; less than this is not told from noise, rad.
const MOST_SHARE: f64 = 0.2;
const LEAST_RAD: f64 = 30e-9;
/// Most that the controller takes away of a harmonic, rad.
const MOST_RAD: f64 = 1e-5;
/// Counts of a turn.
const COUNTS: f64 = 67_108_864.0;
/// Longest way back, s.
const LONGEST_S: f64 = 60.0;

pub(super) fn run(
    bench: &mut Bench<'_>,
    _: &mut Known,
    found: &mut Found,
) -> Result<(), CommissionError> {
    let periods = periods(bench)?;
    if periods == [0; AXES] {
        found.push(Finding::told(
            "errors within the periods of the encoders' scales",
            "not looked for: nobody has said how many periods a turn has; --scale-periods does, from the encoders' data sheet",
        ));
        return Ok(());
    }
    let mut corrections = [Harmonics::default(); AXES];
    let mut sizes_rad = [0.0; AXES];
    for look in 0..LOOKS {
        correct(bench, &periods, &corrections)?;
        for (pivot, pair) in measure(bench, &periods)?.iter().enumerate() {
            let Some([one, other]) = pair else {
                if look == 0 && periods[pivot] > 0 {
                    let why = format!("{} periods are too few or too many", periods[pivot]);
                    found.push(Finding::told(name(pivot), format!("not looked for: {why}")));
                }
                continue;
            };
            let mean = sum(one, other).map(|both| 0.5 * both);
            if look == 0 {
                let apart_rad = size_rad(&sum(one, &other.map(|one| -one)));
                if is_worth_it(found, pivot, &mean, apart_rad) {
                    sizes_rad[pivot] = size_rad(&mean);
                    corrections[pivot] = mean;
                }
            } else if sizes_rad[pivot] > 0.0 && look + 1 < LOOKS {
                corrections[pivot] = sum(&corrections[pivot], &mean);
            } else if sizes_rad[pivot] > 0.0 && !is_gone(found, pivot, &mean, sizes_rad[pivot]) {
                corrections[pivot] = Harmonics::default();
            }
        }
        if sizes_rad == [0.0; AXES] {
            break;
        }
    }
    // Without those that did not help.
    correct(bench, &periods, &corrections)?;
    bench.ask("MOV X 0 Y 0 W 0")?;
    bench.wait_for_target(LONGEST_S)
}

/// Periods of the scales in a turn: what the person beside the machine knows, else what the controller was told; 0 for not known.
fn periods(bench: &mut Bench<'_>) -> Result<[u32; AXES], CommissionError> {
    let mut periods = [bench.scale_periods().unwrap_or_default(); AXES];
    if periods == [0; AXES] {
        for (pivot, periods) in periods.iter_mut().enumerate() {
            *periods = bench.parameter(id::of(id::SCALE_PERIODS, pivot))? as u32;
        }
    }
    Ok(periods)
}

/// Tells the controller what to take away, which takes a servo that is off.
fn correct(
    bench: &mut Bench<'_>,
    periods: &[u32; AXES],
    corrections: &[Harmonics; AXES],
) -> Result<(), CommissionError> {
    bench.ask("SVO X 0")?;
    bench.delay(0.3)?;
    for (pivot, harmonics) in corrections.iter().enumerate() {
        let first = id::of(id::SCALE_PERIODS, pivot);
        bench.set(&[(first, f64::from(periods[pivot]))])?;
        for (id, harmonic) in (first + 1..).step_by(2).zip(harmonics) {
            let (amplitude_rad, phase_rad) = harmonic.to_polar();
            let phase_tenths_deg = (10.0 * phase_rad.to_degrees()).round();
            bench.set(&[
                (id, (amplitude_rad * 1e9).round()),
                (id + 1, phase_tenths_deg),
            ])?;
        }
    }
    bench.hold()
}

/// What two records show, one after the other, in a steady turn.
fn measure(
    bench: &mut Bench<'_>,
    periods: &[u32; AXES],
) -> Result<[Option<[Harmonics; 2]>; AXES], CommissionError> {
    let tables: Vec<_> = (1..=AXES).map(|pivot| format!("{pivot} {ANGLE}")).collect();
    let mut mounting = [[0.0; 2]; AXES];
    for (number, mounting) in (0_u32..).zip(&mut mounting) {
        *mounting = [
            bench.parameter(id::ENCODER_ZERO + number)? / COUNTS * TAU,
            1.0 - 2.0 * bench.parameter(id::ENCODER_REVERSED + number)?,
        ];
    }
    bench.reserve(ROWS)?;
    bench.turn(RATE_RAD_S)?;
    bench.delay(REACHED_S)?;
    let mut seen = [[None; 2]; AXES];
    for record in 0..2 {
        let rows = bench.record_tables(&tables, ROWS, 1, None)?.rows;
        for (pivot, seen) in seen.iter_mut().enumerate() {
            let [zero_rad, direction] = mounting[pivot];
            let readings = rows.iter();
            let readings: Vec<_> = readings
                .map(|row| zero_rad + direction * row[pivot].to_radians())
                .collect();
            seen[record] = subdivision(&readings, periods[pivot]);
        }
    }
    bench.ask("HLT")?;
    bench.settle()?;
    Ok(seen.map(|[one, other]| one.zip(other).map(|(one, other)| [one, other])))
}

/// Whether what was found is an error that repeats, and that can be taken away; else it says why it stays.
fn is_worth_it(found: &mut Found, pivot: usize, mean: &Harmonics, apart_rad: f64) -> bool {
    let size_rad = size_rad(mean);
    let why = if size_rad < LEAST_RAD {
        Some(format!("under {:.0} nrad", LEAST_RAD * 1e9))
    } else if apart_rad > MOST_SHARE * size_rad {
        let percent = 100.0 * apart_rad / size_rad;
        Some(format!("two records differ by {percent:.0} % of it"))
    } else {
        (mean.iter())
            .any(|harmonic| harmonic.norm() > MOST_RAD)
            .then(|| "more than can be taken away".to_owned())
    };
    if let Some(why) = &why {
        found.push(Finding::told(
            name(pivot),
            format!("{}, which stays: {why}", urad(size_rad)),
        ));
    }
    why.is_none()
}

/// Whether the correction has taken most of it away; else it says that it is left as it was.
fn is_gone(found: &mut Found, pivot: usize, left: &Harmonics, before_rad: f64) -> bool {
    let left_rad = size_rad(left);
    let share = left_rad / before_rad;
    let is_gone = share < MOST_SHARE;
    let told = format!("{}, {} of it left", urad(before_rad), urad(left_rad));
    found.number(name(pivot), before_rad * 1e6, "urad");
    found.push(if is_gone {
        let limit = format!("under {:.0} % left", 100.0 * MOST_SHARE);
        Finding::new(name(pivot), told, limit, true, "")
    } else {
        Finding::told(name(pivot), format!("{told}: it stays as it was"))
    });
    is_gone
}

fn name(pivot: usize) -> String {
    format!(
        "error of encoder {} within a period of its scale",
        pivot + 1
    )
}

fn urad(size_rad: f64) -> String {
    format!("{:.3} urad", size_rad * 1e6)
}

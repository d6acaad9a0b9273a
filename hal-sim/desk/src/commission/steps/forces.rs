//! Moves around the middle: whether what the motors have to do for them fits the zeros of the encoders. No loop can know those: any
//! three angles are a pose. So it is looked at once more in commissioning, and after service. The same moves tell what rings and platform weigh, each.

use super::carried;
use crate::commission::bench::Bench;
use crate::commission::found::{CommissionError, Finding, Found, fail};
use crate::commission::id;
use crate::commission::known::Known;
use commissioning::platform::{Evaluation, PlatformError, Tour};
use commissioning::zeros::zero_errors;

/// Out, across and turned, as X and Y in mm and W in deg: so that a load off its centre is not taken for a wrong zero.
const MOVES: [[f64; 3]; 12] = [
    [30.0, 0.0, 0.0],
    [-15.0, 26.0, 0.0],
    [-15.0, -26.0, 0.0],
    [30.0, 0.0, 60.0],
    [-30.0, 0.0, 60.0],
    [15.0, 26.0, 60.0],
    [15.0, -26.0, 60.0],
    [-30.0, 0.0, -60.0],
    [0.0, 30.0, 30.0],
    [0.0, -30.0, 30.0],
    [0.0, 0.0, 90.0],
    [0.0, 0.0, 0.0],
];
pub(super) const HOME: &str = "MOV X 0 Y 0 W 0";
/// Rounds, each at other angles of all rings: what gears, motors and bearings do at one angle does not repeat in the next.
const ROUNDS: usize = 8;
/// What a round is turned by, about the middle and about the platform's own, rad and deg.
const TURNED_RAD: f64 = 0.65;
const TURNED_W: f64 = -40.0;
/// Of the first of them, slowly: with zeros that are far off a guide may come to its end, where a following error ends it.
const SLOW_MOVES: usize = 3;
/// Their share of the speed.
const SLOWLY: f64 = 0.1;
/// Longest of them, s.
const LONGEST_S: f64 = 60.0;
/// Longest way home, s.
const HOME_S: f64 = 3.0;
/// Rows of a move's record, and ticks a row: to the end of most moves, so that they brake as often as they accelerate.
const ROWS: usize = 2_000;
const EVERY: usize = 2;
/// Shorter than a move's acceleration.
const SMOOTHING_S: f64 = 0.004;
/// Most that a zero may be off the mean of all, and that it may be uncertain by (one standard deviation), rad: one that is off by 22 mrad is 15 off
/// the mean, and moves the platform by 1.5 mm. Sound machines are told to be off by up to 8, and to be known to 2.
const MOST_OFF_RAD: f64 = 0.015;
const MOST_UNCERTAIN_RAD: f64 = 0.005;
const UNSURE: &str = "friction that changes hides it: look for what rubs, then once more; or find the zeros in the jig or by the guides' ends (--only zeros, --only ends)";
const TORQUE: &str = "look at that pivot's current sensor, and at its gear ratio if the three are not alike; then windings and motor constant once more (--from windings)";
const WRONG: &str = "find the zeros again, in the jig (--only zeros) or by the guides' ends (--only ends), or look for a scale that has come loose";

pub(super) fn run(
    bench: &mut Bench<'_>,
    known: &mut Known,
    found: &mut Found,
) -> Result<(), CommissionError> {
    look_slowly(bench)?;
    let tours = tours(bench, known)?;
    let track_radius_m = 1e-3 * bench.parameter(id::TRACK_RADIUS)?;
    let how = Evaluation {
        track_radius_m,
        smoothing_s: SMOOTHING_S,
        gear_ratio: bench.parameter(id::of(id::GEAR_RATIO, 0))?,
        presliding: 1e-6 * bench.parameter(id::GUIDE_PRESLIDING)? / track_radius_m,
    };
    let zeros = match zero_errors(&tours, &how) {
        Ok(zeros) => zeros,
        Err(error @ PlatformError::Gain { .. }) => return fail(error.to_string(), TORQUE),
        Err(error) => return fail(error.to_string(), UNSURE),
    };
    known.platform = Some(zeros.platform);
    found.push(Finding::new(
        "by forces the zeros are known to",
        format!("+-{:.0} mrad", 1e3 * zeros.deviation_rad),
        format!("under {:.0}", 1e3 * MOST_UNCERTAIN_RAD),
        zeros.deviation_rad < MOST_UNCERTAIN_RAD,
        UNSURE,
    ));
    for (number, off_rad) in (1..).zip(zeros.too_large_rad) {
        found.push(Finding::new(
            format!("pivot {number} is told too far left by, beside the mean of all"),
            format!("{:.1} mrad", 1e3 * off_rad),
            format!("under {:.0} either way", 1e3 * MOST_OFF_RAD),
            off_rad.abs() < MOST_OFF_RAD,
            WRONG,
        ));
    }
    match &known.model {
        Some(model) if found.findings.iter().all(|finding| finding.passed) => {
            carried::set_parts(bench, found, &model.mechanical, &zeros.platform)
        }
        _ => Ok(()),
    }
}

fn look_slowly(bench: &mut Bench<'_>) -> Result<(), CommissionError> {
    let lines: Vec<_> = lines(0).take(SLOW_MOVES).collect();
    let mut lines: Vec<_> = lines.iter().map(String::as_str).collect();
    lines.push(HOME);
    bench.follow_slowly(SLOWLY, &lines, LONGEST_S).map(drop)
}

/// The moves of a round.
pub(super) fn lines(round: usize) -> impl Iterator<Item = String> {
    let (sin, cos) = (round as f64 * TURNED_RAD).sin_cos();
    MOVES.into_iter().map(move |[x, y, w]| {
        format!(
            "MOV X {:.1} Y {:.1} W {:.1}",
            x * cos - y * sin,
            x * sin + y * cos,
            w + round as f64 * TURNED_W
        )
    })
}

/// All moves, recorded.
fn tours(bench: &mut Bench<'_>, known: &Known) -> Result<Vec<Tour>, CommissionError> {
    bench.reserve(ROWS)?;
    let mut tours = Vec::new();
    for line in (0..ROUNDS).flat_map(lines) {
        let signals = bench.record_all(ROWS, EVERY, &line)?;
        bench.stay()?;
        let torque_n_m = std::array::from_fn(|pivot| {
            let current = signals[pivot].current_a.iter();
            current
                .map(|one| known.motor_constant(pivot) * one)
                .collect()
        });
        tours.push(Tour {
            step_s: bench.period_s * EVERY as f64,
            angle_rad: signals.map(|one| one.angle_rad),
            torque_n_m,
        });
    }
    bench.ask(HOME)?;
    // Parameters are taken between motions. A stage that creeps on by friction is not waited for.
    if !bench.settles_within(HOME_S)? {
        bench.ask("HLT")?;
    }
    bench.stay()?;
    Ok(tours)
}

//! Gains and notches by optimisation: the least sensitivity at 30 Hz whose Ms stays small everywhere, on the model of this machine and on its
//! loops as they were measured. They are kept if the loops that they give, measured again, are better than those that were.

use super::gains::{settle_as_usual, settle_widely};
use crate::commission::bench::Bench;
use crate::commission::found::{CommissionError, Finding, Found, fail};
use crate::commission::id;
use crate::commission::known::Known;
use crate::commission::measured_loop::{MOST_MS, MeasuredLoop, plot};
use crate::commission::servo_gains;
use crate::record::RecordError;
use commissioning::chain::{Chain, Place};
use commissioning::drive_model::DriveModel;
use commissioning::record::Timing;
use commissioning::tuning::{Gains, Limits, Plant, margins, tune};

/// Places of the model, track radii: in the middle, and a ring's width from the rim, once towards each guide.
const PLACES: [[f64; 2]; 4] = [[0.0, 0.0], [0.7, 0.0], [-0.35, 0.6], [-0.35, -0.6]];
/// What is sought on the model: a little less than what is asked of the loops. A resonance may be high where its phase is good: Ms tells.
const LIMITS: Limits = Limits {
    ms: 1.9,
    resonance_peak: 10.0,
    share: 1.0,
};
/// What gains are lowered by where they ask too much of a measured loop, and how often at most.
const LESS: f64 = 0.92;
const MOST_LESS: usize = 12;
/// Moves that have to come to their end, and how long each may take, s.
const MOVES: [&str; 4] = [
    "MOV X 30 Y 30 W 90",
    "MOV X -30 Y -30 W -90",
    "MOV X 1 Y 0 W 0",
    "MOV X 0 Y 0 W 0",
];
const LONGEST_S: f64 = 5.0;
/// How often loops are measured again with less.
const MOST_TRIES: usize = 3;

pub(super) fn run(
    bench: &mut Bench<'_>,
    known: &mut Known,
    found: &mut Found,
) -> Result<(), CommissionError> {
    let (Some(model), false) = (known.model.clone(), known.loops.is_empty()) else {
        return fail(
            "the loops of this machine are not measured",
            "begin with the step `identification`",
        );
    };
    let former = servo_gains::read(bench)?;
    let radius_m = 1e-3 * bench.parameter(id::TRACK_RADIUS)?;
    let mut gains = match optimum(known, &model, radius_m) {
        Ok(gains) => gains,
        Err(error) => {
            found.push(kept(&format!("{error}")));
            return Ok(());
        }
    };
    for _ in 0..MOST_LESS {
        if predicted_ms(known, &model, &gains, radius_m) <= MOST_MS {
            break;
        }
        gains = gains.slowed(LESS);
    }
    for _ in 0..MOST_TRIES {
        let after = match with(bench, known, &model, [&gains, &former])? {
            Ok(after) => after,
            Err(why) => {
                found.push(Finding::told("tried, and not kept", why));
                gains = gains.slowed(LESS * LESS);
                continue;
            }
        };
        if worst_ms(&after) > MOST_MS {
            found.push(Finding::told("tried, and not kept", told(&after)));
            gains = gains.slowed(LESS);
            continue;
        }
        if worst_rejection(&after) >= worst_rejection(&known.loops)
            && worst_ms(&known.loops) <= MOST_MS
        {
            break;
        }
        tell(found, known, &gains, &after);
        known.loops = after;
        return Ok(());
    }
    servo_gains::write(bench, &former)?;
    found.push(kept("measured, they are not better"));
    Ok(())
}

fn optimum(
    known: &Known,
    model: &DriveModel,
    radius_m: f64,
) -> Result<Gains, commissioning::tuning::TuningError> {
    // Carriages that slide hold nothing: a loop has to be stable then, too, and without a spring to the ground each plant is an integrator.
    let chain = Chain {
        along_stiffness: 0.0,
        along_damping: 0.0,
        ..model.mechanical.chain
    };
    let mut plants: Vec<_> = (PLACES.iter())
        .filter_map(|[x, y]| Place::new(*x, *y))
        .map(|place| Plant::from_model(&model.electrical, &chain, &place, &Timing::STAGE))
        .collect();
    plants.extend(measured_plants(known, model, radius_m));
    let centre = Place::centre();
    let tuned = tune(
        &plants,
        &model.electrical,
        &chain.resonances_hz(&centre),
        chain.inertia(&centre)[(0, 0)],
        &Timing::STAGE,
        &LIMITS,
    )?;
    Ok(tuned.gains)
}

fn measured_plants<'a>(
    known: &'a Known,
    model: &'a DriveModel,
    radius_m: f64,
) -> impl Iterator<Item = Plant> + 'a {
    (known.loops.iter())
        .filter_map(move |measured| measured.plant(&model.mechanical.chain, radius_m))
}

/// Ms that gains would have on the plants as they were measured.
fn predicted_ms(known: &Known, model: &DriveModel, gains: &Gains, radius_m: f64) -> f64 {
    measured_plants(known, model, radius_m)
        .map(|plant| margins(&plant, gains, Timing::STAGE.tick_s).ms)
        .fold(0.0, f64::max)
}

/// The loops with other gains; why not, where the stage does not bear them.
fn with(
    bench: &mut Bench<'_>,
    known: &Known,
    model: &DriveModel,
    [gains, former]: [&Gains; 2],
) -> Result<Result<Vec<MeasuredLoop>, String>, CommissionError> {
    servo_gains::write(bench, gains)?;
    let mut after = Vec::new();
    for before in &known.loops {
        match MeasuredLoop::measure(bench, before.spot, model) {
            Ok(measured) => after.push(measured),
            Err(CommissionError::Controller(error @ RecordError::Refused { .. })) => {
                return back(bench, former, error.to_string()).map(Err);
            }
            Err(CommissionError::Failed(failure)) => {
                return back(bench, former, failure.what).map(Err);
            }
            Err(error) => return Err(error),
        }
    }
    match settles(bench) {
        Err(CommissionError::Failed(failure)) => back(bench, former, failure.what).map(Err),
        done => done.map(|()| Ok(after)),
    }
}

/// Short moves, to the window that the machine will have: a loop that only turns tells nothing of rest.
fn settles(bench: &mut Bench<'_>) -> Result<(), CommissionError> {
    settle_as_usual(bench)?;
    for line in MOVES {
        bench.ask(line)?;
        bench.wait_for_target(LONGEST_S)?;
    }
    settle_widely(bench)
}

/// Holds the stage with the gains that it had; why it has to.
fn back(bench: &mut Bench<'_>, former: &Gains, why: String) -> Result<String, CommissionError> {
    if bench.is_faulted()? {
        bench.clear_fault()?;
    } else {
        bench.ask("STP")?;
        bench.delay(0.3)?;
    }
    servo_gains::write(bench, former)?;
    settle_widely(bench)?;
    bench.hold()?;
    Ok(why)
}

fn worst_ms(loops: &[MeasuredLoop]) -> f64 {
    loops.iter().map(MeasuredLoop::ms).fold(0.0, f64::max)
}

fn worst_rejection(loops: &[MeasuredLoop]) -> f64 {
    loops
        .iter()
        .map(MeasuredLoop::rejection)
        .fold(0.0, f64::max)
}

fn told(loops: &[MeasuredLoop]) -> String {
    format!(
        "Ms {:.2}, S(30 Hz) {:.3} at the worst place",
        worst_ms(loops),
        worst_rejection(loops)
    )
}

fn kept(why: &str) -> Finding {
    Finding::told("gains of the ultimate gain are kept", why)
}

fn tell(found: &mut Found, known: &Known, gains: &Gains, after: &[MeasuredLoop]) {
    for (now, before) in after.iter().zip(&known.loops) {
        found.push(Finding::new(
            format!("Ms {}", now.spot.words()),
            format!("{:.2}, before {:.2}", now.ms(), before.ms()),
            format!("at most {MOST_MS}"),
            now.ms() <= MOST_MS,
            "",
        ));
        found.push(Finding::told(
            format!("S(30 Hz) and crossover {}", now.spot.words()),
            format!(
                "{:.3} and {:.0} Hz, before {:.3} and {:.0} Hz",
                now.rejection(),
                now.crossover_hz(),
                before.rejection(),
                before.crossover_hz()
            ),
        ));
        found.plots.push(plot(now, Some(before)));
    }
    for (number, pivot) in (1..).zip(&gains.pivots) {
        let [first, second] = pivot.filters.notches;
        found.push(Finding::told(
            format!("gains of pivot {number}"),
            format!(
                "position {:.0} 1/s, velocity {:.1} V s/rad, integral {:.0} V/rad; notches at {:.0} Hz (gain {:.2}) and {:.0} Hz ({:.2})",
                pivot.gains.position_1_s,
                pivot.gains.velocity_v_s_rad,
                pivot.gains.integral_v_rad,
                first.frequency_hz,
                first.gain,
                second.frequency_hz,
                second.gain
            ),
        ));
    }
}

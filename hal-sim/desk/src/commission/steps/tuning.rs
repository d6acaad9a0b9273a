//! Gains and notches by optimisation: the least sensitivity at 30 Hz whose Ms stays small everywhere, on the model of this machine and on its
//! loops as they were measured. They are kept if the loops that they give, measured again, are better than those that were.

use super::gains::{USUAL_COUNTS, rest_for, settle_widely, settle_within};
use crate::commission::bench::Bench;
use crate::commission::found::{CommissionError, Finding, Found, fail};
use crate::commission::id;
use crate::commission::known::Known;
use crate::commission::measured_loop::{MeasuredLoop, plot};
use crate::commission::servo_gains;
use crate::record::RecordError;
use commissioning::chain::{Chain, Place};
use commissioning::drive_model::DriveModel;
use commissioning::record::Timing;
use commissioning::tuning::{Gains, Limits, MOST_MS, PLACES, Plant, SEARCHED, Sought, tune};

/// What gains are lowered by that the stage does not bear.
const NOT_BORNE: f64 = 0.92 * 0.92;
/// Moves that have to come to their end, and how long each may take, s.
const MOVES: [&str; 4] = [
    "MOV X 30 Y 30 W 90",
    "MOV X -30 Y -30 W -90",
    "MOV X 1 Y 0 W 0",
    "MOV X 0 Y 0 W 0",
];
const LONGEST_S: f64 = 5.0;
/// Within what they have to settle, encoder counts: friction of the guides may hold the stage a little off, and `verification` finds how far.
const BORNE_COUNTS: f64 = 2.0 * USUAL_COUNTS;
/// How often loops are measured with gains and with slower or faster ones.
const MOST_TRIES: usize = 4;
/// What their Ms is brought to, from which on it is enough; how gains have to go with it, and by how much at a time at most.
const AIMED_MS: f64 = 1.95;
const ENOUGH_MS: f64 = 1.8;
const MS_POWER: f64 = 1.5;
const LEAST_BY: f64 = 0.6;
const MOST_BY: f64 = 1.25;

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
    let search = Search::new(known, &model, radius_m);
    for gains in search.candidates(&former) {
        if let Some((gains, after)) = search.best(bench, known, [&gains, &former], found)? {
            put(bench, &gains)?;
            tell(found, known, &gains, &after);
            search.tell_heavier(found, &gains);
            known.loops = after;
            return Ok(());
        }
    }
    put(bench, &former)?;
    for measured in &known.loops {
        measured.tell_numbers(found);
    }
    let (ms, was) = (worst_ms(&known.loops), told(&known.loops));
    found.push(Finding::new(
        "the gains that were are kept: nothing that was tried is better",
        was,
        format!("Ms at most {MOST_MS}"),
        ms <= MOST_MS,
        "look for what rubs or is loose; then once more from `identification` on",
    ));
    Ok(())
}

/// What gains are sought on: the model, and the loops as they were measured.
#[derive(Clone)]
struct Search<'a> {
    model: &'a DriveModel,
    radius_m: f64,
    chain: Chain,
    /// With what it carries at times besides, where it does.
    heavier: Option<Chain>,
    measured: Vec<Plant>,
}

impl<'a> Search<'a> {
    fn new(known: &Known, model: &'a DriveModel, radius_m: f64) -> Self {
        let chain = model.mechanical.chain.sliding();
        let more_kg = known.also_carries_kg;
        let search = Self {
            model,
            radius_m,
            chain,
            heavier: (more_kg > 0.0).then(|| chain.carrying(more_kg, radius_m)),
            measured: Vec::new(),
        };
        search.on(&known.loops)
    }

    /// The same on these loops in place of others.
    fn on(&self, loops: &[MeasuredLoop]) -> Self {
        let chain = &self.model.mechanical.chain;
        let plants = (loops.iter()).filter_map(|measured| measured.plant(chain, self.radius_m));
        Self {
            measured: plants.collect(),
            ..self.clone()
        }
    }

    /// With a load, as it was found, as it may be, and as it seldom is. The controller schedules its gains by the load that it knows.
    fn with_load(&self, chain: &Chain, places: &[[f64; 2]]) -> [Vec<Plant>; 3] {
        let (model, timing) = (self.model, &Timing::STAGE);
        let at = |chain| Plant::at_places(&model.electrical, chain, places, timing);
        let known = at(&self.chain);
        [
            at(chain),
            Plant::as_they_may_be(model, chain, places, timing),
            Plant::as_they_seldom_are(model, chain, places, timing),
        ]
        .map(|plants| {
            (plants.into_iter().zip(known.iter().cycle()))
                .map(|(plant, known)| plant.scheduled_by(known))
                .collect()
        })
    }

    /// With what is on it, and with what it carries at times besides: as it was found, as it may be, and as it seldom is.
    fn plants(&self, places: &[[f64; 2]]) -> [Vec<Plant>; 3] {
        let mut plants = self.with_load(&self.chain, places);
        if let Some(heavier) = &self.heavier {
            for (plants, heavier) in plants.iter_mut().zip(self.with_load(heavier, places)) {
                plants.extend(heavier);
            }
        }
        plants
    }

    /// What gains are predicted to be with what it carries at times besides.
    fn tell_heavier(&self, found: &mut Found, gains: &Gains) {
        let heavier = (self.heavier.iter()).flat_map(|chain| self.with_load(chain, &PLACES));
        let heavier: Vec<_> = heavier.flatten().collect();
        if let Some(worst) = gains.at_worst(&heavier) {
            found.push(Finding::new(
                "Ms with what it also carries, as predicted",
                format!("{:.2}; S(30 Hz) {:.3}", worst.ms, worst.rejection),
                format!("at most {MOST_MS}"),
                worst.are_sound(MOST_MS),
                "have it carry less besides, or tune again whenever that stands there",
            ));
            found.number("Ms with what it also carries", worst.ms, "");
        }
    }

    /// All that gains have to be sound on.
    fn all(&self) -> Vec<Plant> {
        [self.plants(&PLACES).concat(), self.measured.clone()].concat()
    }

    /// Gains of the search, slowed until the model at every place and the loops as they were measured keep Ms; their worst rejection.
    fn sought(&self) -> Option<(Gains, f64)> {
        let centre = Place::centre();
        let [as_found, as_it_may_be, seldom] = self.plants(&PLACES[..SEARCHED]);
        let elsewhere = [seldom, self.plants(&PLACES[SEARCHED..]).concat()].concat();
        let tuned = tune(
            Sought {
                found: &[&as_found[..], &self.measured].concat(),
                may_be: &as_it_may_be,
                elsewhere: &elsewhere,
            },
            &self.model.electrical,
            &self.chain.resonances_hz(&centre),
            self.chain.inertia(&centre)[(0, 0)],
            &Limits::WITH_FRICTION,
        );
        self.sound(&tuned.ok()?.gains)
    }

    fn sound(&self, gains: &Gains) -> Option<(Gains, f64)> {
        let (gains, worst) = gains.slowed_until_sound(&self.all(), MOST_MS)?;
        Some((gains, worst.rejection))
    }

    /// Gains to try, the most promising first: those of the search, and the former ones.
    fn candidates(&self, former: &Gains) -> Vec<Gains> {
        let candidates = [self.sought(), self.sound(former)];
        let mut candidates: Vec<_> = candidates.into_iter().flatten().collect();
        candidates.sort_by(|a, b| a.1.total_cmp(&b.1));
        candidates.into_iter().map(|(gains, _)| gains).collect()
    }

    /// The best that was measured with gains and with some that are as much slower or faster as the loops ask for, where it is better than what was.
    /// Where loops do not keep Ms, gains are sought once more on what these show, and not on the former ones: near the edge a loop tells more of its
    /// plant than far from it.
    fn best(
        &self,
        bench: &mut Bench<'_>,
        known: &Known,
        [gains, former]: [&Gains; 2],
        found: &mut Found,
    ) -> Result<Option<(Gains, Vec<MeasuredLoop>)>, CommissionError> {
        let (mut gains, mut best) = (*gains, None);
        let was = worst_rejection(&known.loops);
        let mut least = if worst_ms(&known.loops) <= MOST_MS {
            was
        } else {
            f64::INFINITY
        };
        for tries in 0..MOST_TRIES {
            let after = match with(bench, known, self.model, [&gains, former])? {
                Ok(after) => after,
                Err(why) => {
                    found.push(Finding::told("tried, and not kept", why));
                    if best.is_some() {
                        break;
                    }
                    gains = gains.slowed(NOT_BORNE);
                    continue;
                }
            };
            let (ms, rejection) = (worst_ms(&after), worst_rejection(&after));
            let is_better = ms <= MOST_MS && rejection < least;
            if is_better {
                least = rejection;
                best = Some((gains, after.clone()));
            } else {
                found.push(Finding::told("tried, and not kept", told(&after)));
            }
            if ms <= MOST_MS && (ms >= ENOUGH_MS || !is_better) || ms > MOST_MS && best.is_some() {
                break;
            }
            let by = (AIMED_MS / ms).powf(MS_POWER);
            let next = gains.slowed(by.clamp(LEAST_BY, MOST_BY));
            let nearer = self.on(&after);
            gains = if ms <= MOST_MS {
                match nearer.sound_and_faster(&next, &gains) {
                    Some(faster) => faster,
                    None => break,
                }
            } else if tries == 0 {
                (nearer.sought()).map_or(next, |(sought, _)| sought)
            } else {
                next
            };
        }
        Ok(best)
    }

    /// Gains slowed until they keep Ms, where they are faster than others still. The lines of a measured loop lie far apart: a resonance between two of
    /// them only the model shows.
    fn sound_and_faster(&self, gains: &Gains, others: &Gains) -> Option<Gains> {
        let (sound, _) = self.sound(gains)?;
        (sound.least_velocity_v_s_rad() > others.least_velocity_v_s_rad()).then_some(sound)
    }
}

/// The loops with other gains; why not, where the stage does not bear them.
fn with(
    bench: &mut Bench<'_>,
    known: &Known,
    model: &DriveModel,
    [gains, former]: [&Gains; 2],
) -> Result<Result<Vec<MeasuredLoop>, String>, CommissionError> {
    put(bench, gains)?;
    let mut after = Vec::new();
    for before in &known.loops {
        match MeasuredLoop::measure(bench, before.spot, before.peak_v, model) {
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

/// Short moves: a loop that only turns tells nothing of rest.
fn settles(bench: &mut Bench<'_>) -> Result<(), CommissionError> {
    settle_within(bench, BORNE_COUNTS)?;
    for line in MOVES {
        bench.ask(line)?;
        bench.wait_for_target(LONGEST_S)?;
    }
    settle_widely(bench)
}

/// Gains, and what rest leaves of them.
fn put(bench: &mut Bench<'_>, gains: &Gains) -> Result<(), CommissionError> {
    servo_gains::write(bench, gains)?;
    rest_for(bench, gains)
}

/// Holds the stage with the gains that it had; why it has to.
fn back(bench: &mut Bench<'_>, former: &Gains, why: String) -> Result<String, CommissionError> {
    if bench.is_faulted()? {
        bench.clear_fault()?;
    } else {
        bench.ask("STP")?;
        bench.delay(0.3)?;
    }
    put(bench, former)?;
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

fn tell(found: &mut Found, known: &Known, gains: &Gains, after: &[MeasuredLoop]) {
    for (now, before) in after.iter().zip(&known.loops) {
        now.tell_numbers(found);
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
        found.number(
            format!("velocity gain of pivot {number}"),
            pivot.gains.velocity_v_s_rad,
            "V s/rad",
        );
        found.number(
            format!("position gain of pivot {number}"),
            pivot.gains.position_1_s,
            "1/s",
        );
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

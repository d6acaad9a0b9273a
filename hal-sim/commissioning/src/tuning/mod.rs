//! Gains and filters for a machine: the best rejection of what is slow, at margins that are kept at every place and with every load.
//!
//! All numbers of the servo are varied at once (`evolution`); what breaks a limit costs. At the end the velocity gain goes as high as the limits
//! allow. Position gain and corner of the integral go with the velocity gain, so that a slower servo is the same with time stretched, and small
//! gains are safe.
//!
//! | file | idea |
//! |---|---|
//! | `evolution` | the search |
//! | `servo` | the servo of a pivot as a frequency response |
//! | `plant` | what the servos see |
//! | `margins` | sensitivity and stability of the three loops together |

mod evolution;
mod margins;
mod plant;
mod servo;

pub use margins::{
    BEYOND, Gains, MOST_MS, Margins, REJECTION_HZ, margins, rest_stiffness, sensitivity,
    worst_direction,
};
pub use plant::{PLACES, Plant, SEARCHED, angle_by_volts, grid};
pub use servo::PivotGains;

use crate::drive_model::Electrical;
use evolution::{Effort, Evolution};
use firmware::parameters::{self, FeedbackFilters, Lead, Notch};
use margins::Enough;
use nalgebra::DVector;
use std::f64::consts::TAU;

/// What must be kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Largest singular value of the sensitivity, on plants as they were found.
    pub ms: f64,
    /// Largest peak of the loop beyond its crossover.
    pub resonance_peak: f64,
    /// Share of the velocity gain that would just keep them.
    pub share: f64,
    /// What a tail costs, over what rejection is worth: a position gain or a corner of the integral that is low, by its logarithm.
    pub tail: f64,
    /// Frequency up to which a lead raises the gain, Hz.
    pub lead_to_hz: f64,
}

/// Up to 3,000 Hz S(30 Hz) would be a tenth less, a fifth on a machine of which all is known; and servos would bounce motors that no friction holds
/// through the gaps of their gears, at 1 kHz, for as long as the full loop is in force after a move.
const LEAD_TO_HZ: f64 = 1_500.0;

impl Limits {
    /// Ms of 1.9, -6 dB at resonances, all of the gain.
    pub const USUAL: Self = Self {
        ms: 1.9,
        resonance_peak: 0.5,
        share: 1.0,
        tail: 0.0,
        lead_to_hz: LEAD_TO_HZ,
    };

    /// What is sought on a model of the machine: a little less than what is asked of its loops. A resonance may be high where its phase is
    /// good: Ms tells.
    pub const ON_MODEL: Self = Self {
        ms: 1.9,
        resonance_peak: 10.0,
        share: 1.0,
        tail: 0.0,
        lead_to_hz: LEAD_TO_HZ,
    };

    /// The same of a machine whose guides have friction, which holds it off where a tail is slow: some rejection is given for a faster one.
    pub const WITH_FRICTION: Self = Self {
        tail: 0.2,
        ..Self::ON_MODEL
    };
}

/// Share of the integral gain with which an identified machine learns what changes (parameter 0x54500303). What is learnt while it turns acts as so
/// much more integral, which no gains here are sought with, and answers to the motors' ripple.
pub const IDENTIFIED_LEARNING: f64 = 0.25;

/// Gains, and what they are predicted to give at the worst place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tuned {
    /// The gains.
    pub gains: Gains,
    /// Worst of all places and loads.
    pub margins: Margins,
}

/// What gains are sought on.
#[derive(Clone, Copy, Debug)]
pub struct Sought<'a> {
    /// The machine as it was found, at places that differ much.
    pub found: &'a [Plant],
    /// What it may be as well, there: gains may come nearer to [`MOST_MS`] on it.
    pub may_be: &'a [Plant],
    /// Both at places that differ little from those: searched on only if what is found does not keep [`MOST_MS`] there.
    pub elsewhere: &'a [Plant],
}

/// Why there are no gains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum TuningError {
    /// No plants.
    #[error("no plant to tune for: give at least the one in the middle of the disk")]
    NoPlant,
    /// Not even small gains keep the limits.
    #[error(
        "not even small gains keep the limits: look at the model's resonances and their damping"
    )]
    NotEvenSmall,
}

/// Ranges that are searched, inside those of the parameters.
const VELOCITY: [f64; 2] = [3.0, 500.0];
/// Position gain and corner of the integral, 1/s, which do the same: a lower one of either hardly costs rejection at 30 Hz, and leaves a tail of
/// tens of milliseconds after every move, or one that never ends, where friction holds. What is under the second number may cost ([`Limits::tail`]).
const CORNER: [f64; 2] = [60.0, 2_000.0];
const TAIL_UNDER: f64 = 150.0;
/// Lowest frequency of a notch over the lowest resonance, the highest, Hz, its width over its frequency, and its gain. A wide and deep one far below what
/// resonates, where the servos' corners are, would reject more at 30 Hz with a loop that half its gain makes unstable.
const NOTCH_FROM: f64 = 0.5;
const NOTCH_TO_HZ: f64 = 9_000.0;
const WIDTH: [f64; 2] = [0.01, 2.0];
const DEPTH: [f64; 2] = [0.02, 1.0];
/// The next velocity gain that is tried, over the one before, and halvings between the two that keep the limits and do not; where those of a shape
/// begin that a search has ended at, over its own.
const NEXT: f64 = 0.83;
const HALVINGS: usize = 5;
const ABOVE: f64 = 1.2;
/// A search, and below it for how many generations it is followed at most. The valleys are many, and their first generations hardly tell how deep they are.
const EFFORT: Effort = Effort {
    step: 0.3,
    children: 24,
    until: 1e-3,
};
const LAST: usize = 200;
/// First generations on plants of which all is known; on all that a machine may be, and on what was found, where it may be more than that.
const ON_CERTAIN: First = First {
    generations: 100,
    followed: 3,
};
const ON_ALL: First = First {
    generations: 60,
    followed: 2,
};
const ON_FOUND: First = First {
    generations: 60,
    followed: 1,
};
/// The lowest resonance of a machine of which none is known.
const NO_RESONANCE_HZ: f64 = 1_000.0;
/// Largest singular value of the sensitivity on what a machine may be as well: a little less than [`MOST_MS`], for what no model has.
const MAY_BE_MS: f64 = 1.95;
/// What a limit that is passed costs, over what rejection is worth; what an unstable loop does.
const PENALTY: f64 = 20.0;
const UNSTABLE: f64 = 100.0;

/// First generations: how many from each start, and how many of these searches are followed.
#[derive(Clone, Copy)]
struct First {
    generations: usize,
    followed: usize,
}

/// The worst margins, exact where they are beyond the limits, and the largest Ms over its limit.
type Worst = (Margins, f64);

/// Position gain and corner of the integral over the corner of the velocity loop, and two notches as frequency, width over frequency, gain.
type Shape = [f64; 8];

/// Gains for plants at several places and with several loads, and for those that they may be as well: searches are ranked on a third of the
/// frequencies; the last search, and what is found, keeps the limits on all. `resonances_hz`: of
/// the model in the middle of the disk ([`crate::chain::Chain::resonances_hz`]); the lowest says where notches are tried. `scheduled_inertia_kg_m2`:
/// what the gains are for, or 0.
///
/// # Errors
/// [`TuningError`].
pub fn tune(
    sought: Sought<'_>,
    electrical: &[Electrical; 3],
    resonances_hz: &[f64],
    scheduled_inertia_kg_m2: f64,
    limits: &Limits,
) -> Result<Tuned, TuningError> {
    if sought.found.is_empty() {
        return Err(TuningError::NoPlant);
    }
    let may_be = [sought.may_be, sought.elsewhere].concat();
    let lowest_hz = resonances_hz.first().copied().unwrap_or(NO_RESONANCE_HZ);
    let on = |found, may_be| Search {
        found,
        may_be,
        electrical,
        scheduled_inertia_kg_m2,
        notch_hz: [NOTCH_FROM * lowest_hz, NOTCH_TO_HZ],
        limits,
    };
    let thinned = |plants: &[Plant]| plants.iter().map(Plant::thinned).collect::<Vec<_>>();
    let [found, also] = [sought.found, sought.may_be].map(thinned);
    let as_found = on(&found, &[]);
    let as_it_may_be = on(&found, &also);
    let last = on(sought.found, sought.may_be);
    let whole = on(sought.found, &may_be);
    let begun = starts(lowest_hz);
    // Where a machine may be much, most searches on all of it end at gains that hardly move it, and one on what was found does not.
    let firsts = if also.is_empty() {
        vec![(&as_found, ON_CERTAIN)]
    } else {
        vec![(&as_it_may_be, ON_ALL), (&as_found, ON_FOUND)]
    };
    let ended: Vec<_> = (firsts.into_iter())
        .flat_map(|(on, first)| {
            let start = |shape| on.start(shape).or_else(|| as_found.start(shape));
            on.begun(begun.iter().filter_map(start), first)
        })
        .map(|search| last.followed(search))
        .collect();
    let (_, mut tuned) = last.best(&ended).ok_or(TuningError::NotEvenSmall)?;
    let is_sound = |(margins, _): &Worst| margins.are_sound(MOST_MS);
    if whole.worst(&tuned.gains, is_sound).is_none() {
        // A load that is off the centre swings otherwise at every place: slower gains of this shape may be far from the best that keep Ms there. From
        // gains that do not keep it, a search may end at some that hardly move the stage.
        let everywhere = whole.best(&ended).and_then(|(at, slower)| {
            let start = Evolution::new(&unknowns(&shape_of(at), &slower), EFFORT);
            let ended = whole.followed(start);
            Some(whole.best(std::slice::from_ref(&ended))?.1)
        });
        tuned = everywhere.unwrap_or(tuned);
    }
    let mut gains = tuned.gains;
    gains.pivots = gains.pivots.map(|pivot| pivot.scaled(limits.share));
    let margins = ([sought.found, sought.may_be].into_iter())
        .filter_map(|plants| gains.at_worst(plants))
        .reduce(Margins::worse)
        .ok_or(TuningError::NoPlant)?;
    Ok(Tuned { gains, margins })
}

/// Shapes to start from: no notch at work, where resonances lie far above what the servos reach; two that are wide and shallow, about the lowest
/// resonance and where the loop falls, which turn the phase of all that lies about them; and a narrow one at the lowest resonance with a wide one. What
/// narrow ones at every pair of resonances lead to, these lead to as well; from a narrow one to a wide one a search hardly finds.
fn starts(lowest_hz: f64) -> Vec<Shape> {
    let none = [0.25, 0.2, lowest_hz, 0.4, 0.95, 2.0 * lowest_hz, 0.4, 0.95];
    let wide = [0.8, 1.25, 1.8].map(|times| {
        [1_500.0, 2_350.0].map(|second_hz| {
            [
                0.35,
                0.33,
                times * lowest_hz,
                1.2,
                0.65,
                second_hz,
                1.2,
                0.65,
            ]
        })
    });
    let narrow = [[1_400.0, 0.15], [2_000.0, 0.5]]
        .map(|[second_hz, gain]| [0.45, 0.45, lowest_hz, 0.25, 0.6, second_hz, 1.5, gain]);
    [&[none][..], wide.as_flattened(), &narrow].concat()
}

fn unknowns(shape: &Shape, found: &Tuned) -> DVector<f64> {
    let velocity = found.gains.pivots[0].gains.velocity_v_s_rad;
    let all = shape.iter().copied().chain([velocity]).map(f64::ln);
    DVector::from_iterator(shape.len() + 1, all)
}

fn shape_of(unknowns: &DVector<f64>) -> Shape {
    std::array::from_fn(|k| unknowns[k].exp())
}

fn velocity_of(unknowns: &DVector<f64>) -> f64 {
    within(unknowns[unknowns.len() - 1].exp(), VELOCITY)
}

/// Velocity gains to try, down from one.
fn falling(most: f64) -> impl Iterator<Item = f64> {
    std::iter::successors(Some(most), |velocity| Some(velocity * NEXT))
        .take_while(|velocity| *velocity > VELOCITY[0])
}

fn within(value: f64, [least, most]: [f64; 2]) -> f64 {
    value.clamp(least, most)
}

/// How far a value is over a limit, by its logarithm.
fn over(value: f64, limit: f64) -> f64 {
    f64::max(0.0, (value / limit).ln())
}

struct Search<'a> {
    found: &'a [Plant],
    may_be: &'a [Plant],
    electrical: &'a [Electrical; 3],
    scheduled_inertia_kg_m2: f64,
    notch_hz: [f64; 2],
    limits: &'a Limits,
}

impl Search<'_> {
    /// A shape with the largest velocity gain at which it keeps the limits; `None` where there is none.
    fn start(&self, shape: &Shape) -> Option<DVector<f64>> {
        let found = self.best_velocity(shape, falling(VELOCITY[1]))?;
        Some(unknowns(shape, &found))
    }

    /// The best of the first generations from these points.
    fn begun(&self, starts: impl Iterator<Item = DVector<f64>>, first: First) -> Vec<Evolution> {
        let from = |start: DVector<f64>| {
            let mut search = Evolution::new(&start, EFFORT);
            search.go_on(first.generations, |at| self.cost(at));
            search
        };
        let mut searches: Vec<_> = starts.map(from).collect();
        searches.sort_by(|a, b| a.best().1.total_cmp(&b.best().1));
        searches.truncate(first.followed);
        searches
    }

    /// Where a search ends.
    fn followed(&self, mut search: Evolution) -> DVector<f64> {
        search.go_on(LAST, |at| self.cost(at));
        search.best().0.clone()
    }

    /// How far notches are out of their ranges, where nothing else tells a search which way is back.
    fn outside(&self, shape: &Shape) -> f64 {
        let [_, _, notches @ ..] = shape;
        (notches
            .iter()
            .zip([self.notch_hz, WIDTH, DEPTH].iter().cycle()))
        .map(|(&value, &range)| (value / within(value, range)).ln().powi(2))
        .sum()
    }

    fn gains(&self, shape: &Shape, velocity: f64) -> Gains {
        let [position, corner, f1, w1, g1, f2, w2, g2] = *shape;
        let notch = |hz: f64, width: f64, gain: f64| Notch {
            frequency_hz: within(hz, self.notch_hz),
            width_hz: within(hz * within(width, WIDTH), [1.0, NOTCH_TO_HZ]),
            gain: within(gain, DEPTH),
        };
        let volts_per_torque = |drive: &Electrical| drive.resistance_ohm / drive.motor_constant;
        let first = volts_per_torque(&self.electrical[0]);
        let inertia = match self.scheduled_inertia_kg_m2 {
            scheduled if scheduled > 0.0 => scheduled,
            _ => self.found[0].inertia[0],
        };
        let velocity_1_s = velocity / (first * inertia);
        let pivots = self.electrical.map(|drive| {
            // A motor that takes more volts for its torque gets more.
            let velocity_v_s_rad = velocity * volts_per_torque(&drive) / first;
            let corner_1_s = |of: f64| within(of * velocity_1_s, CORNER);
            PivotGains {
                gains: parameters::Gains {
                    velocity_v_s_rad,
                    position_1_s: corner_1_s(position),
                    integral_v_rad: velocity_v_s_rad * corner_1_s(corner),
                },
                filters: FeedbackFilters {
                    notches: [notch(f1, w1, g1), notch(f2, w2, g2)],
                    lead: Lead {
                        from_hz: drive.resistance_ohm / drive.inductance_h / TAU,
                        to_hz: self.limits.lead_to_hz,
                    },
                },
            }
        });
        Gains {
            pivots,
            scheduled_inertia_kg_m2: self.scheduled_inertia_kg_m2,
        }
    }

    /// The worst of all plants; `None` at the first that does not do.
    fn worst(&self, gains: &Gains, does: impl Fn(&Worst) -> bool) -> Option<Worst> {
        let resonance_peak = self.limits.resonance_peak;
        let with = |ms: f64| move |plant| (plant, Enough { ms, resonance_peak });
        // What a machine may be passes the limits first.
        let may_be = self.may_be.iter().map(with(MAY_BE_MS));
        let found = self.found.iter().map(with(self.limits.ms));
        let all = may_be.chain(found);
        let mut worst: Option<Worst> = None;
        for (margins, (_, Enough { ms, .. })) in gains.on_each(all.clone()).zip(all) {
            let this = (margins, margins.ms / ms);
            if !does(&this) {
                return None;
            }
            worst = Some(worst.map_or(this, |(margins, ms_over)| {
                (margins.worse(this.0), ms_over.max(this.1))
            }));
        }
        worst
    }

    fn is_kept(&self, (margins, ms_over): &Worst) -> bool {
        margins.is_stable && *ms_over <= 1.0 && margins.resonance_peak <= self.limits.resonance_peak
    }

    fn cost(&self, unknowns: &DVector<f64>) -> f64 {
        let gains = self.gains(&shape_of(unknowns), velocity_of(unknowns));
        let Some((margins, ms_over)) = self.worst(&gains, |(margins, _)| margins.is_stable) else {
            return UNSTABLE;
        };
        self.loss(&Tuned { gains, margins })
            + self.outside(&shape_of(unknowns))
            + PENALTY
                * (over(ms_over, 1.0) + over(margins.resonance_peak, self.limits.resonance_peak))
    }

    /// What is to be least of gains that keep the limits.
    fn loss(&self, tuned: &Tuned) -> f64 {
        let parameters::Gains {
            velocity_v_s_rad,
            position_1_s,
            integral_v_rad,
        } = tuned.gains.pivots[0].gains;
        let corners = [position_1_s, integral_v_rad / velocity_v_s_rad];
        let tails: f64 = corners.map(|corner| over(TAIL_UNDER, corner)).iter().sum();
        tuned.margins.rejection.ln() + self.limits.tail * tails
    }

    /// The best of these, each with the largest velocity gain that keeps the limits.
    fn best<'a>(&self, ends: &'a [DVector<f64>]) -> Option<(&'a DVector<f64>, Tuned)> {
        let tuned = |at| self.best_velocity(&shape_of(at), falling(ABOVE * velocity_of(at)));
        (ends.iter())
            .filter_map(|at| Some((at, tuned(at)?)))
            .min_by(|(_, a), (_, b)| self.loss(a).total_cmp(&self.loss(b)))
    }

    /// The largest velocity gain that keeps the limits, from the first of these down. Where a resonance is only held at higher gains, smaller ones
    /// do not keep them: no halving from the smallest finds it.
    fn best_velocity(&self, shape: &Shape, falling: impl Iterator<Item = f64>) -> Option<Tuned> {
        let tuned = |velocity: f64| {
            let gains = self.gains(shape, velocity);
            let (margins, _) = self.worst(&gains, |worst| self.is_kept(worst))?;
            Some(Tuned { gains, margins })
        };
        let mut high = None;
        for velocity in falling {
            let Some(mut best) = tuned(velocity) else {
                high = Some(velocity);
                continue;
            };
            let (mut low, mut high) = (velocity, high.unwrap_or(velocity));
            for _ in 0..HALVINGS {
                let middle = (low * high).sqrt();
                if let Some(found) = tuned(middle) {
                    (low, best) = (middle, found);
                } else {
                    high = middle;
                }
            }
            return Some(best);
        }
        None
    }
}

//! A target that is renewed again and again along a straight path: how much the speed swings.

use crate::check::Walked;
use crate::motion_bench::reference::{Reference, per_axis};
use crate::motion_bench::{AXIS_UNIT, CONSTRAINTS, at, at_rest};
use crate::planner::{Motion, retargeted};
use firmware::motion::{AxisState, Plan, Position};
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// Ticks between two targets, 20 ms.
pub const PERIOD: u64 = 400;
/// How far from the rim a path begins and ends.
const FROM_RIM_MM: f64 = 5.0;
const SPEEDS_MM_S: [f64; 2] = [50.0, 150.0];
/// Distances of paths from the disk's centre.
const BESIDE_MM: [f64; 2] = [0.0, 40.0];
const DIRECTIONS: u32 = 24;
/// Part of the targets' speed that who keeps up with them has.
const KEEPS_UP: f64 = 0.99;

/// Straight through the disk, theta at rest.
struct Path {
    mm_s: f64,
    beside_mm: f64,
    direction: f64,
}

impl Path {
    fn half_mm(&self) -> f64 {
        let usable_mm = CONSTRAINTS.usable_radius * CONSTRAINTS.geometry.radius_mm;
        ((usable_mm - FROM_RIM_MM).powi(2) - self.beside_mm.powi(2)).sqrt()
    }

    /// The last target's number.
    fn targets(&self) -> u64 {
        let seconds = 2.0 * self.half_mm() / self.mm_s;
        (seconds * CONSTRAINTS.limits.rate_hz / PERIOD as f64) as u64
    }

    /// Target `number`; 0 is where the stage is at rest before.
    fn target(&self, number: u64) -> Position {
        let seconds = (number * PERIOD) as f64 / CONSTRAINTS.limits.rate_hz;
        let along = self.mm_s * seconds - self.half_mm();
        let (sin, cos) = self.direction.sin_cos();
        at(
            along * cos - self.beside_mm * sin,
            along * sin + self.beside_mm * cos,
            0.0,
        )
    }
}

/// Speeds at the ticks of the steady part, mm/s: on the second half of a path. They take some 25 targets to be the same
/// from target to target.
#[derive(Default)]
struct Steady(Vec<f64>);

impl Steady {
    /// Takes a tick on the way to target `number`.
    fn take(&mut self, path: &Path, number: u64, state: &[AxisState; 3]) {
        if 2 * number > path.targets() {
            let mm_s = CONSTRAINTS.geometry.radius_mm * CONSTRAINTS.limits.rate_hz;
            let [x, y] = [0, 1].map(|i| state[i].velocity as f64 / AXIS_UNIT * mm_s);
            self.0.push(x.hypot(y));
        }
    }

    /// The swing as a part of the mean; none where the targets are faster.
    fn swing(&self, path: &Path) -> Option<f64> {
        let mean = self.0.iter().sum::<f64>() / self.0.len() as f64;
        let most = self.0.iter().copied().fold(f64::MIN, f64::max);
        let least = self.0.iter().copied().fold(f64::MAX, f64::min);
        (mean > KEEPS_UP * path.mm_s).then(|| (most - least) / mean)
    }
}

/// What comes of the paths at one speed and distance, in all directions.
#[derive(Default)]
pub struct Swings {
    pub mm_s: f64,
    pub beside_mm: f64,
    pub paths: usize,
    /// In order, of those that kept up with the targets.
    pub ours: Vec<f64>,
    /// The same of rsruckig.
    pub reference: Vec<f64>,
    /// Paths on which rsruckig found nothing for a target.
    pub reference_none: usize,
    /// Targets that ours came to rest before.
    pub stops_first: u32,
}

impl Swings {
    /// At all speeds and distances.
    pub fn all(walked: &mut Option<Walked>) -> Vec<Self> {
        let kinds = SPEEDS_MM_S.map(|mm_s| BESIDE_MM.map(|beside_mm| (mm_s, beside_mm)));
        let kinds = kinds.as_flattened().iter();
        kinds
            .map(|&(mm_s, beside_mm)| Self::new(mm_s, beside_mm, walked))
            .collect()
    }

    fn new(mm_s: f64, beside_mm: f64, walked: &mut Option<Walked>) -> Self {
        let mut swings = Self {
            mm_s,
            beside_mm,
            ..Self::default()
        };
        for k in 0..DIRECTIONS {
            let path = Path {
                mm_s,
                beside_mm,
                direction: TAU * f64::from(k) / f64::from(DIRECTIONS),
            };
            swings.paths += 1;
            let steady = swings.follow(&path, walked);
            swings.ours.extend(steady.swing(&path));
            match followed_by_the_reference(&path) {
                Some(steady) => swings.reference.extend(steady.swing(&path)),
                None => swings.reference_none += 1,
            }
        }
        swings.ours.sort_by(f64::total_cmp);
        swings.reference.sort_by(f64::total_cmp);
        swings
    }

    /// The planner under test, each way left for the next when its target comes.
    fn follow(&mut self, path: &Path, walked: &mut Option<Walked>) -> Steady {
        let (mut now, mut at) = (resting(path.target(0)), 0);
        let mut steady = Steady::default();
        for number in 1..=path.targets() {
            let way = retargeted(&now, at, path.target(number), &CONSTRAINTS);
            let way = way.expect("a target inside the disk");
            // The first one is left for at rest.
            self.stops_first += u32::from(number > 1 && way.rests_before());
            if let Some(walked) = walked {
                walked.take(&way, &CONSTRAINTS);
            }
            for tick in at..at + PERIOD {
                let (motion, tick) = way.under_way(&now, tick);
                steady.take(path, number, &motion.state_after(tick));
            }
            let (next, tick) = way.under_way(&now, at + PERIOD);
            (now, at) = (next.clone(), tick);
        }
        steady
    }
}

/// A plan that is over.
fn resting(at: Position) -> Motion {
    Motion {
        plan: Plan {
            end: at,
            ..Plan::default()
        },
        from: at_rest(at),
    }
}

fn followed_by_the_reference(path: &Path) -> Option<Steady> {
    let square = per_axis(&CONSTRAINTS.limits, FRAC_1_SQRT_2);
    let mut state = at_rest(path.target(0));
    let mut steady = Steady::default();
    for number in 1..=path.targets() {
        let reference = Reference::new(&state, &path.target(number), &square)?;
        for tick in 0..PERIOD {
            steady.take(path, number, &reference.state_after(tick as f64));
        }
        state = reference.state_after(PERIOD as f64);
    }
    Some(steady)
}

//! Planning a straight line from rest to rest.
//!
//! First the fastest motion under the limits of the line alone, in closed form ([`Profile`]). If the pivots can follow it, as
//! most short and slow lines, that is it. Otherwise the demands on the pivots are laid out along the line ([`Grid`]), the
//! fastest speed that they allow at every place is found ([`fastest`]), replaced by a few stretches of constant acceleration
//! ([`under`]) and limited in jerk ([`pace`]). What roundings and corners still leave over a limit is taken off the whole
//! motion. The profile, slowed down until the pivots follow, competes: the shorter of the two is taken.

pub(crate) mod jerk_ramps;
pub(crate) mod path;
pub(crate) mod path_profile;
pub(crate) mod pivot_demand;
pub(crate) mod quotient;
pub(crate) mod rounded_ramps;
pub(crate) mod segments;
pub(crate) mod topp;

pub use super::check::target::{check_line, check_target};
use super::constraints::Constraints;
use super::limits::PathLimits;
use super::plan::{Plan, PlanStart, Position};
use super::profile::rest_to_rest::RestToRestProfile;
use super::refusal::Refusal;
use crate::motion::line::jerk_ramps::pace;
use crate::motion::line::path::Path;
use crate::motion::line::path_profile::Pace;
use crate::motion::line::pivot_demand::{Grid, Moment};
use crate::motion::line::segments::{Polygon, thin, under};
use crate::motion::line::topp::{PLACES, fastest};
use crate::number::float::{FloatMinMax, i64_to_f32_fast, ticks_to_f32};
use crate::number::{cbrt_f32, sqrt_f32};
use heapless::Vec;

/// Plans the straight line `from` -> `to` (both at rest): all three axes start and end together, and the end is exact.
#[inline(never)]
pub fn plan_line(
    id: u32,
    from: Position,
    to: Position,
    ground: &Constraints,
) -> Result<Plan, Refusal> {
    check_line(&from, &to, ground)?;
    let mut plan = Plan {
        id,
        start: PlanStart::Rest(from),
        pieces: Vec::new(),
        nudge: [0; 3],
        end: to,
    };
    if from == to {
        return Ok(plan);
    }
    // Planned in the same direction whichever way it is gone: backwards is forwards backwards. From the inside out, so that
    // it does not matter either where on the mechanism it is.
    let out = |[x, y, _]: Position| {
        i64_to_f32_fast(x) * i64_to_f32_fast(x) + i64_to_f32_fast(y) * i64_to_f32_fast(y)
    };
    let turned_round = (out(from), from) > (out(to), to);
    let [first, last] = if turned_round { [to, from] } else { [from, to] };
    let path = Path::new(&first, &last, ground);
    let mut pace = Pace::default();
    (Way::new(&path, ground).write(&mut pace)).ok_or(Refusal::InvalidLimits)?;
    if turned_round {
        pace.beats.reverse();
    }
    pace.play(&mut plan, &from).ok_or(Refusal::InvalidLimits)?;
    Ok(plan)
}

/// A line and what limits motion along it.
struct Way<'a> {
    path: &'a Path,
    limits: PathLimits,
    pivot_rate: f32,
    pivot_acceleration: f32,
    hz: f32,
}

/// Looks at a motion in a stretch of it, besides those at the places it passes.
const LOOKS: u32 = 1;
/// Room that a motion gets for roundings when it is slowed down.
const SPARE: f32 = 1.001_5;

impl<'a> Way<'a> {
    fn new(path: &'a Path, ground: &Constraints) -> Self {
        let limits = &ground.limits;
        let length_mm = path.length * ground.geometry.radius_mm as f32;
        Self {
            path,
            limits: limits.for_line(length_mm, path.turn.to_degrees()),
            pivot_rate: limits.pivot_rate_rad_s as f32,
            pivot_acceleration: limits.pivot_acceleration_rad_s2 as f32,
            hz: limits.rate_hz as f32,
        }
    }

    /// Writes the fastest motion found.
    fn write(&self, pace: &mut Pace) -> Option<()> {
        let profile = RestToRestProfile::new(&self.limits, self.hz)?;
        profile.write(pace);
        if self.pivots_follow_anywhere(&profile) {
            return Some(());
        }
        let mut grid = Grid::new(&self.limits);
        grid.fill(self.path, self.pivot_rate, self.pivot_acceleration);
        let excess = self.excess(pace, &grid);
        if excess <= 1.0 {
            return Some(());
        }
        let slowed = profile.slowed(excess)?;
        let shaped = self.shape(&grid, pace);
        if shaped.is_none() || pace.ticks() >= slowed.ticks() {
            slowed.write(pace);
        }
        Some(())
    }

    /// Writes the motion that follows the pivots' limits.
    fn shape(&self, grid: &Grid, paced: &mut Pace) -> Option<()> {
        let mut z = [0.0; PLACES];
        fastest(grid, &mut z);
        let mut polygon = Polygon::new();
        under(&z, grid.stretches(), self.limits.acceleration, &mut polygon)?;
        thin(&mut polygon, &self.limits);
        pace(&polygon, SPARE, &self.limits, self.hz, paced)?;
        let excess = self.excess(paced, grid);
        if excess <= 1.0 {
            return Some(());
        }
        // With the jerk of the same motion played slower it is just that, and needs no second look.
        let slower = excess * SPARE;
        let limits = PathLimits {
            jerk: self.limits.jerk / (slower * slower * slower),
            ..self.limits
        };
        pace(&polygon, SPARE * slower, &limits, self.hz, paced)
    }

    /// Whether the worst that the profile can ask of the pivots at the places furthest out keeps their limits.
    fn pivots_follow_anywhere(&self, profile: &RestToRestProfile) -> bool {
        let rate = self.hz / ticks_to_f32(profile.travel);
        let acceleration = rate * self.hz / ticks_to_f32(profile.ramp);
        let (first, second) = self.path.worst();
        first * rate <= self.pivot_rate
            && first * acceleration + second * rate * rate <= self.pivot_acceleration
    }

    /// The largest excess of a motion over its limits (see [`Grid::excess`]), jerk included.
    fn excess(&self, pace: &Pace, grid: &Grid) -> f32 {
        let places = grid.stretches() as f32;
        let unit = pace.unit() * self.hz * self.hz * self.hz;
        let mut now = Moment::default();
        let mut worst = 0.0_f32;
        let (mut acceleration, mut jerk) = (0.0_f32, 0.0_f32);
        for beat in &pace.beats {
            let seconds = ticks_to_f32(beat.ticks) / self.hz;
            let push = beat.jerk as f32 * unit;
            jerk = jerk.fmax(push.abs());
            let way = now.after(seconds, push).s - now.s;
            let steps = LOOKS + (way.abs() * places) as u32;
            let step = seconds / steps as f32;
            for _ in 0..steps {
                now = now.after(step, push);
                worst = worst.fmax(grid.excess(&now));
            }
            // Largest at an end of a stretch.
            acceleration = acceleration.fmax(now.acceleration.abs());
        }
        let worst = worst.fmax(acceleration / self.limits.acceleration);
        let jerk = jerk / self.limits.jerk;
        let worst = sqrt_f32(worst);
        if jerk > 1.0 {
            worst.fmax(cbrt_f32(jerk))
        } else {
            worst
        }
    }
}

impl Moment {
    /// `seconds` later under a constant jerk.
    fn after(&self, seconds: f32, jerk: f32) -> Self {
        let half = 0.5 * seconds;
        let acceleration = self.acceleration + jerk * seconds;
        let third = self.acceleration + jerk * seconds * (1.0 / 3.0);
        Self {
            s: self.s + seconds * (self.rate + half * third),
            rate: self.rate + half * (self.acceleration + acceleration),
            acceleration,
        }
    }
}

//! Planning a straight line from rest to rest.
//!
//! First the fastest motion under the limits of the line alone, in closed form. If the pivots can follow it, as most
//! short and slow lines, that is it. Otherwise the demands on the pivots are laid out along the line, the fastest speed
//! that they allow at every place is found, replaced by a few segments of constant acceleration and limited in jerk.
//! What roundings and corners still leave over a limit is taken off the whole motion. The profile, slowed down until
//! the pivots follow, competes: the shorter of the two is taken.
//!
//! | file | idea |
//! |---|---|
//! | here | the steps above, and which profile is taken |
//! | `path` | the line as the pivots see it: derivatives of their angles by the path parameter |
//! | `disk` | whether the line stays inside the usable disk |
//! | `pivot_demand` | the pivots' demands on a grid of places along the line |
//! | `topp` | the largest squared speed at every place: time-optimal path parametrisation; and that curve as a few segments of constant acceleration |
//! | `jerk_ramps` | the steps of acceleration between them as ramps of limited jerk |
//! | `rounded_ramps` | the ramps in whole numbers, at rest to the bit at the end |

pub(crate) mod disk;
pub(super) mod jerk_ramps;
pub(crate) mod path;
pub(super) mod pivot_demand;
pub(super) mod rounded_ramps;
pub(super) mod topp;

use disk::check_line;
use jerk_ramps::write_path_profile;
use motion::constraints::{Constraints, PathLimits};
use motion::plan::quantise::PathProfile;
use motion::plan::{Plan, PlanStart, Position};
use motion::profile::rest_to_rest::RestToRestProfile;
use motion::refusal::Refusal;
use motion::tolerances::ROUNDING_MARGIN;
use number::float::{FloatMinMax, i64_to_f32_fast, ticks_to_f32};
use number::{cbrt_f32, sqrt_f32};
use path::Path;
use pivot_demand::{DemandGrid, PathState};
use topp::{
    Corners, GRID_POINTS, fit_segments_below, remove_close_corners, velocity_limit_squared,
};

/// Plans the straight line `from` -> `to` (both at rest): all three axes start and end together, and the end is exact.
#[inline(never)]
pub fn plan_line(
    id: u32,
    from: Position,
    to: Position,
    constraints: &Constraints,
) -> Result<Plan, Refusal> {
    check_line(&from, &to, constraints)?;
    let mut plan = Plan::new(id, PlanStart::Rest(from), to);
    if from == to {
        return Ok(plan);
    }
    // Planned in the same direction whichever way it is gone: backwards is forwards backwards. From the inside out, so
    // that it does not matter either where on the mechanism it is.
    let out = |[x, y, _]: Position| {
        i64_to_f32_fast(x) * i64_to_f32_fast(x) + i64_to_f32_fast(y) * i64_to_f32_fast(y)
    };
    let turned_round = (out(from), from) > (out(to), to);
    let [first, last] = if turned_round { [to, from] } else { [from, to] };
    let path = Path::new(&first, &last, constraints);
    let mut path_profile = PathProfile::default();
    (LinePlanner::new(&path, constraints).write(&mut path_profile))
        .ok_or(Refusal::InvalidLimits)?;
    if turned_round {
        path_profile.segments.reverse();
    }
    path_profile
        .write_plan(&mut plan, &from)
        .ok_or(Refusal::InvalidLimits)?;
    Ok(plan)
}

/// A line and what limits motion along it.
struct LinePlanner<'a> {
    path: &'a Path,
    limits: PathLimits,
    pivot_rate: f32,
    pivot_acceleration: f32,
    hz: f32,
}

impl<'a> LinePlanner<'a> {
    fn new(path: &'a Path, constraints: &Constraints) -> Self {
        let limits = &constraints.limits;
        Self {
            path,
            limits: (constraints.motion_limits()).for_line(path.length, path.turn.abs()),
            pivot_rate: limits.pivot_rate_rad_s as f32,
            pivot_acceleration: limits.pivot_acceleration_rad_s2 as f32,
            hz: limits.rate_hz as f32,
        }
    }

    /// Writes the fastest motion found.
    fn write(&self, path_profile: &mut PathProfile) -> Option<()> {
        let profile = RestToRestProfile::new(&self.limits, self.hz)?;
        profile.write(path_profile);
        if self.pivots_follow_anywhere(&profile) {
            return Some(());
        }
        let mut grid = DemandGrid::new(&self.limits);
        grid.fill(self.path, self.pivot_rate, self.pivot_acceleration);
        let excess = self.excess(path_profile, &grid);
        if excess <= 1.0 {
            return Some(());
        }
        let slowed = profile.slowed(excess)?;
        let shaped = self.write_topp_profile(&grid, path_profile);
        if shaped.is_none() || path_profile.ticks() >= slowed.ticks() {
            slowed.write(path_profile);
        }
        Some(())
    }

    /// Writes the motion that follows the pivots' limits.
    fn write_topp_profile(&self, grid: &DemandGrid, path_profile: &mut PathProfile) -> Option<()> {
        let mut z = [0.0; GRID_POINTS];
        velocity_limit_squared(grid, &mut z);
        let mut corners = Corners::new();
        fit_segments_below(&z, grid.intervals(), self.limits.acceleration, &mut corners)?;
        remove_close_corners(&mut corners, &self.limits);
        let write = |slower: f32, profile: &mut PathProfile| {
            let jerk = self.limits.jerk / (slower * slower * slower);
            write_path_profile(&corners, ROUNDING_MARGIN * slower, jerk, self.hz, profile)
        };
        write(1.0, path_profile)?;
        let excess = self.excess(path_profile, grid);
        if excess <= 1.0 {
            return Some(());
        }
        // With the jerk of the same motion played slower it is just that, and needs no second look.
        write(excess * ROUNDING_MARGIN, path_profile)
    }

    /// Whether the worst that the profile can ask of the pivots at the places furthest out keeps their limits.
    fn pivots_follow_anywhere(&self, profile: &RestToRestProfile) -> bool {
        let rate = self.hz / ticks_to_f32(profile.travel);
        let acceleration = rate * self.hz / ticks_to_f32(profile.ramp);
        let (first, second) = self.path.worst();
        first * rate <= self.pivot_rate
            && first * acceleration + second * rate * rate <= self.pivot_acceleration
    }

    /// The largest excess of a motion over its limits (see [`DemandGrid::excess`]), jerk included.
    fn excess(&self, path_profile: &PathProfile, grid: &DemandGrid) -> f32 {
        let unit = path_profile.unit() * self.hz * self.hz * self.hz;
        let mut now = PathState::default();
        let mut worst = 0.0_f32;
        let (mut acceleration, mut jerk) = (0.0_f32, 0.0_f32);
        for segment in &path_profile.segments {
            let seconds = ticks_to_f32(segment.ticks) / self.hz;
            let push = segment.jerk as f32 * unit;
            jerk = jerk.fmax(push.abs());
            let way = now.after(seconds, push).s - now.s;
            // Each place that it passes, and an instant besides.
            let steps = 1 + (way.abs() * grid.intervals() as f32) as u32;
            let step = seconds / steps as f32;
            for _ in 0..steps {
                now = now.after(step, push);
                worst = worst.fmax(grid.excess(&now));
            }
            // Largest at an end of a segment.
            acceleration = acceleration.fmax(now.acceleration.abs());
        }
        let worst = worst.fmax(acceleration / self.limits.acceleration);
        sqrt_f32(worst).fmax(cbrt_f32(jerk / self.limits.jerk))
    }
}

impl PathState {
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

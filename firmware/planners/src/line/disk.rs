//! Whether a line stays inside the usable disk on its way.
//!
//! The platform centre goes `C = P - R(theta) p`. With p = 0 it goes straight, and nowhere is it further out than at an
//! end. In general `f = |C|^2 = |P|^2 + |p|^2 - 2 P.R p` is at most `(|P| + |p|)^2`: only the parts of the line with P
//! further out than the disk's radius less |p| need a look, one at each end. Each is walked from its end on: f'' has a
//! bound B, so from a place where f is below the limit by `g` the centre stays inside for a way of
//! `(sqrt(f'^2 + 2 B g) - f') / B` (see `steady_motion`). A whole turn leaves the disk there, because at some
//! orientation the two lengths add up.

use super::path::Path;
use crate::steady_motion::{SteadyMotion, crossing};
use core::f32::consts::TAU;
use motion::check::workspace::check_target;
use motion::constraints::Constraints;
use motion::plan::Position;
use motion::refusal::Refusal;
use motion::tolerances::LINE_SQUARED_RADII;
use number::float::{FloatMinMax, hypot};
use number::sqrt_f32;

/// Most steps of a walk: a line that goes along the rim any longer counts as leaving it.
const MOST_STEPS: usize = 150;
/// Places looked at for how far a line gets that leaves the disk.
const SAMPLES: usize = 48;

/// Whether the straight line between two positions can be moved along: the same answer as that of
/// [`plan_line`](crate::plan_line).
#[inline(never)]
pub fn check_line(
    from: &Position,
    to: &Position,
    constraints: &Constraints,
) -> Result<(), Refusal> {
    check_target(to, constraints)?;
    if !constraints.limits.all_positive() {
        return Err(Refusal::InvalidLimits);
    }
    let usable = constraints.usable_radius as f32;
    // A line of no length has no bend to walk along.
    if constraints.rotation_centre == [0.0; 2] || from == to {
        return Ok(());
    }
    let path = Path::new(from, to, constraints);
    let there = Walk::new(&path, from[2], constraints, false);
    let back = Walk::new(&path, to[2], constraints, true);
    // Or no further out than it starts, when it starts outside.
    let start = there.motion.square(0.0).0;
    let limit = start.fmax(usable * usable) + LINE_SQUARED_RADII;
    let Some((radius, fraction)) = there.exit(limit).or_else(|| back.exit(limit)) else {
        return Ok(());
    };
    let mm = constraints.geometry.radius_mm;
    Err(Refusal::LeavesDisk {
        radius_mm: f64::from(radius) * mm,
        usable_mm: constraints.usable_radius * mm,
        fraction: f64::from(fraction),
    })
}

/// A walk from one end of a line, with the path parameter for seconds.
struct Walk {
    motion: SteadyMotion,
    /// Half of B.
    second_derivative: f32,
    backwards: bool,
}

impl Walk {
    fn new(path: &Path, theta: i64, constraints: &Constraints, backwards: bool) -> Self {
        let ends = [path.from, path.point(1.0)];
        let sign = if backwards { -1.0 } else { 1.0 };
        let motion = SteadyMotion {
            point: ends[usize::from(backwards)],
            theta,
            velocity: path.displacement.map(|way| way * sign),
            turning: path.turn * sign,
            centre: constraints.centre(),
        };
        let furthest = ends
            .into_iter()
            .fold(0.0_f32, |most, [x, y]| most.fmax(hypot(x, y)));
        let turn = path.turn.abs();
        Self {
            second_derivative: path.length * path.length
                + motion.arm() * turn * (2.0 * path.length + turn * furthest),
            motion,
            backwards,
        }
    }

    /// Where the centre is furthest out, and after which part of the way, if it leaves the disk before the point is so far
    /// in that every orientation is inside.
    #[inline(never)]
    fn exit(&self, limit: f32) -> Option<(f32, f32)> {
        // A little more than a turn, so that every orientation is met in spite of roundings.
        let turn = (1.01 * TAU / self.motion.turning.abs()).fmin(1.0);
        if !self.leaves(turn, limit) {
            return None;
        }
        let mut worst = (0.0, 0.0);
        for k in 0..=SAMPLES {
            let s = turn * k as f32 / SAMPLES as f32;
            let radius = sqrt_f32(self.motion.square(s).0);
            if radius > worst.0 {
                worst = (radius, if self.backwards { 1.0 - s } else { s });
            }
        }
        Some(worst)
    }

    fn leaves(&self, turn: f32, limit: f32) -> bool {
        let every_orientation = sqrt_f32(limit) - self.motion.arm();
        let mut s = 0.0;
        for _ in 0..MOST_STEPS {
            let [x, y] = self.motion.point_after(s);
            if hypot(x, y) <= every_orientation || s >= 1.0 {
                return false;
            }
            let (square, half_rate) = self.motion.square(s);
            if square > limit || s >= turn {
                return true;
            }
            let step = crossing(square - limit, half_rate, self.second_derivative);
            s = (s + step.fmax(LEAST_STEP)).fmin(turn);
        }
        true
    }
}

/// Least step of a walk, so that it gets on in spite of roundings.
const LEAST_STEP: f32 = 1e-6;

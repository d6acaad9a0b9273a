//! Whether an ending and a line that overlap keep to the limits of path and rotation, in floats: what the pivots and the
//! workspace ask for is left to the check.

use heapless::Vec;
use motion::constraints::{MotionLimits, Speeds};
use motion::plan::MAX_PIECES;
use motion::tolerances::OVERLAP;
use number::float::{FloatMinMax, ticks_to_f32};

/// Where a motion's jerk changes: the state there, track radii, rad and seconds.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Corner {
    pub at_s: f32,
    pub v: [f32; 3],
    pub a: [f32; 3],
    pub j: [f32; 3],
}

/// Those of a motion; at the last one it is at rest.
pub(super) type Corners = Vec<Corner, { MAX_PIECES + 1 }>;

impl Corner {
    /// The state at a later time.
    #[inline(never)]
    pub fn at(&self, at_s: f32) -> Self {
        let seconds = at_s - self.at_s;
        let half = seconds / 2.0;
        Self {
            at_s,
            v: each!(i => self.v[i] + seconds * (self.a[i] + half * self.j[i])),
            a: each!(i => self.a[i] + seconds * self.j[i]),
            j: self.j,
        }
    }
}

/// What the sum keeps to.
pub(super) struct Overlap {
    limits: MotionLimits,
    hz: f32,
    /// How often a delay is halved in the search.
    halvings: usize,
}

impl Overlap {
    pub fn new(limits: &MotionLimits, hz: f32, halvings: usize) -> Self {
        let mut limits = limits.scaled(OVERLAP, OVERLAP);
        limits.speed = limits.speed.scaled(OVERLAP);
        Self {
            limits,
            hz,
            halvings,
        }
    }

    /// The least delay up to `most` ticks that is found; `None` where `most` is too short.
    pub fn least_delay(&self, ending: &[Corner], line: &[Corner], most: u64) -> Option<u64> {
        if !self.is_kept(ending, line, most) {
            return None;
        }
        if self.is_kept(ending, line, 0) {
            return Some(0);
        }
        let (mut low, mut high) = (0_u64, most);
        for _ in 0..self.halvings {
            let middle = low.midpoint(high);
            if self.is_kept(ending, line, middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        Some(high)
    }

    /// Whether the limits are kept while both are under way: at every corner of either, and speed in the middle between.
    fn is_kept(&self, mut ending: &[Corner], mut line: &[Corner], delay: u64) -> bool {
        let delay_s = ticks_to_f32(delay) / self.hz;
        let mut now_s = delay_s;
        while let ([a, a_end, ..], [b, b_end, ..]) = (ending, line) {
            let (a_end_s, b_end_s) = (a_end.at_s, b_end.at_s + delay_s);
            let until_s = a_end_s.fmin(b_end_s);
            if until_s > now_s {
                let limits = &self.limits;
                let (a, b) = (a.at(now_s), b.at(now_s - delay_s));
                let sum = Corner {
                    at_s: now_s,
                    v: each!(i => a.v[i] + b.v[i]),
                    a: each!(i => a.a[i] + b.a[i]),
                    j: each!(i => a.j[i] + b.j[i]),
                };
                if !(is_within(&sum.j, &limits.jerk)
                    && is_within(&sum.a, &limits.acceleration)
                    && is_within(&sum.v, &limits.speed)
                    && is_within(&sum.at((now_s + until_s) / 2.0).v, &limits.speed))
                {
                    return false;
                }
                now_s = until_s;
            }
            if a_end_s <= until_s {
                ending = &ending[1..];
            }
            if b_end_s <= until_s {
                line = &line[1..];
            }
        }
        true
    }
}

/// Whether a vector is within a limit.
fn is_within([x, y, theta]: &[f32; 3], limit: &Speeds) -> bool {
    x * x + y * y <= limit.linear * limit.linear && theta.abs() <= limit.angular
}

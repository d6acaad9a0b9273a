//! The plain line from where an ending comes to rest, and whether an ending and a line that overlap keep to the limits of
//! path and rotation, in floats: what the pivots and the workspace ask for is left to the check.

use super::ending::{Corner, Leaving};
use motion::constraints::{MotionLimits, PathLimits, Speeds};
use motion::profile::rest_to_rest::RestToRestProfile;
use motion::tolerances::OVERLAP;
use number::float::{FloatMinMax, hypot, ticks_to_f32};

/// Where the jerk of the path parameter changes: times since the line began, and the state there.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LineCorner {
    pub at_s: f32,
    pub rate: f32,
    pub acceleration: f32,
    pub jerk: f32,
}

/// A plain line: its way (track radii, rad) and its profile.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub way: [f32; 3],
    pub profile: RestToRestProfile,
}

impl Line {
    /// Along `way` (zero in what does not move) with a share of the limits of acceleration and jerk; `None` where there
    /// is no way to go, or one that takes longer than can be counted.
    pub fn new(way: [f32; 3], share: f32, leaving: &Leaving<'_>) -> Option<Self> {
        if way == [0.0; 3] {
            return None;
        }
        let (length, turn) = (hypot(way[0], way[1]), way[2].abs());
        let least = |limit: &Speeds| (limit.linear / length).fmin(limit.angular / turn);
        let limits = PathLimits {
            rate: least(&leaving.limits.speed),
            acceleration: least(&leaving.limits.acceleration) * share,
            jerk: least(&leaving.limits.jerk) * share,
        };
        let profile = RestToRestProfile::new(&limits, leaving.hz)?;
        Some(Self { way, profile })
    }

    /// The same, slower by a factor.
    pub fn slowed(&self, slower: f32) -> Option<Self> {
        Some(Self {
            profile: self.profile.slowed(slower)?,
            ..*self
        })
    }

    /// Its corners.
    pub fn corners(&self, hz: f32) -> [LineCorner; 8] {
        let tick_s = 1.0 / hz;
        let RestToRestProfile { jerk, ramp, travel } = self.profile;
        let [b1, b2, b3] = [jerk, ramp, travel].map(|ticks| ticks_to_f32(ticks) * tick_s);
        let rate = 1.0 / b3;
        let acceleration = rate / b2;
        let jerk = acceleration / b1;
        let half = acceleration * b1 / 2.0;
        let corner = |at_s, rate, acceleration, jerk| LineCorner {
            at_s,
            rate,
            acceleration,
            jerk,
        };
        [
            corner(0.0, 0.0, 0.0, jerk),
            corner(b1, half, acceleration, 0.0),
            corner(b2, rate - half, acceleration, -jerk),
            corner(b1 + b2, rate, 0.0, 0.0),
            corner(b3, rate, 0.0, -jerk),
            corner(b3 + b1, rate - half, -acceleration, 0.0),
            corner(b3 + b2, half, -acceleration, jerk),
            corner(b1 + b2 + b3, 0.0, 0.0, 0.0),
        ]
    }
}

/// Translation, rotation, or both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Part {
    Translation,
    Rotation,
    Whole,
}

impl Part {
    /// Whether the sizes of a sum of two vectors are within a limit.
    #[inline]
    pub fn is_within(self, a: &[f32; 3], way: &[f32; 3], rate: f32, limit: &Speeds) -> bool {
        let [x, y, theta] = each!(i => a[i] + way[i] * rate);
        let translation = x * x + y * y <= limit.linear * limit.linear;
        let rotation = theta.abs() <= limit.angular;
        match self {
            Self::Translation => translation,
            Self::Rotation => rotation,
            Self::Whole => translation && rotation,
        }
    }

    /// One vector in what is of this part, the other in what is not.
    pub fn select<T>(
        self,
        [x, y, theta]: [T; 3],
        [other_x, other_y, other_theta]: [T; 3],
    ) -> [T; 3] {
        match self {
            Self::Translation => [x, y, other_theta],
            Self::Rotation => [other_x, other_y, theta],
            Self::Whole => [x, y, theta],
        }
    }
}

/// What the sum keeps to.
pub(super) struct Overlap {
    limits: MotionLimits,
    hz: f32,
}

/// How often a delay is halved in the search.
const HALVINGS: usize = 3;

impl Overlap {
    pub fn new(leaving: &Leaving<'_>) -> Self {
        let mut limits = leaving.limits.scaled(OVERLAP, OVERLAP);
        limits.speed = limits.speed.scaled(OVERLAP);
        Self {
            limits,
            hz: leaving.hz,
        }
    }

    /// The least delay up to `most` ticks that is found; `None` where `most` is too short.
    pub fn least_delay(
        &self,
        ending: &[Corner],
        line: &Line,
        part: Part,
        most: u64,
    ) -> Option<u64> {
        let corners = line.corners(self.hz);
        let is_kept = |delay: u64| self.corners_are_kept(ending, &line.way, &corners, part, delay);
        if !is_kept(most) {
            return None;
        }
        if is_kept(0) {
            return Some(0);
        }
        let (mut low, mut high) = (0_u64, most);
        for _ in 0..HALVINGS {
            let middle = low.midpoint(high);
            if is_kept(middle) {
                high = middle;
            } else {
                low = middle;
            }
        }
        Some(high)
    }

    /// Whether the limits are kept while both are under way: at every corner of either, and speed in the middle between.
    pub fn is_kept(&self, ending: &[Corner], line: &Line, part: Part, delay: u64) -> bool {
        self.corners_are_kept(ending, &line.way, &line.corners(self.hz), part, delay)
    }

    fn corners_are_kept(
        &self,
        ending: &[Corner],
        way: &[f32; 3],
        line: &[LineCorner],
        part: Part,
        delay: u64,
    ) -> bool {
        let delay_s = ticks_to_f32(delay) / self.hz;
        let (mut endings, mut lines) = (ending.windows(2), line.windows(2));
        let mut now_s = delay_s;
        let (Some(mut ended), Some(mut lined)) =
            (endings.find(|pair| pair[1].at_s > now_s), lines.next())
        else {
            return true;
        };
        loop {
            let (a, b) = (&ended[0], &lined[0]);
            let ends_s = [ended[1].at_s, lined[1].at_s + delay_s];
            let until_s = ends_s[0].fmin(ends_s[1]);
            let (t, u) = (now_s - a.at_s, now_s - delay_s - b.at_s);
            let middle = (until_s - now_s) / 2.0;
            let state = |t: f32, u: f32| {
                let (half, late) = (t / 2.0, u / 2.0);
                (
                    each!(i => a.v[i] + t * (a.a[i] + half * a.j[i])),
                    each!(i => a.a[i] + t * a.j[i]),
                    b.rate + u * (b.acceleration + late * b.jerk),
                    b.acceleration + u * b.jerk,
                )
            };
            let (v, acc, rate, acceleration) = state(t, u);
            let (v_middle, _, rate_middle, _) = state(t + middle, u + middle);
            let kept = |vector: &[f32; 3], times: f32, limit: &Speeds| {
                part.is_within(vector, way, times, limit)
            };
            if !(kept(&a.j, b.jerk, &self.limits.jerk)
                && kept(&acc, acceleration, &self.limits.acceleration)
                && kept(&v, rate, &self.limits.speed)
                && kept(&v_middle, rate_middle, &self.limits.speed))
            {
                return false;
            }
            now_s = until_s;
            if ends_s[0] <= now_s {
                let Some(next) = endings.next() else {
                    return true;
                };
                ended = next;
            }
            if ends_s[1] <= now_s {
                let Some(next) = lines.next() else {
                    return true;
                };
                lined = next;
            }
        }
    }
}

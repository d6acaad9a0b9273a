//! Whether an ending and a line that overlap keep to the limits of path and rotation, in floats: what the pivots and
//! the workspace ask for is left to the check.

use super::ending::{Corner, Leaving};
use super::line::{Line, LineCorner};
use motion::profile::velocity::AccelerationLimits;
use motion::speeds::Speeds;
use motion::tolerances::OVERLAP;
use number::float::{FloatMinMax, ticks_to_f32};

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
    speed: Speeds,
    acceleration: Speeds,
    jerk: Speeds,
    hz: f32,
}

/// How often a delay is halved in the search.
const HALVINGS: usize = 3;

impl Overlap {
    pub fn new(leaving: &Leaving<'_>) -> Self {
        let AccelerationLimits { acceleration, jerk } = leaving.limits;
        Self {
            speed: leaving.speed.scaled(OVERLAP),
            acceleration: acceleration.scaled(OVERLAP),
            jerk: jerk.scaled(OVERLAP),
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
        let next_ending = |endings: &mut core::slice::Windows<'_, Corner>| {
            endings.next().map(|pair| (pair[0], pair[1].at_s))
        };
        let next_line = |lines: &mut core::slice::Windows<'_, LineCorner>| {
            (lines.next()).map(|pair| (pair[0], pair[1].at_s + delay_s))
        };
        let Some(mut ended) = next_ending(&mut endings) else {
            return true;
        };
        let Some(mut lined) = next_line(&mut lines) else {
            return true;
        };
        let mut now_s = delay_s;
        while ended.1 <= now_s {
            match next_ending(&mut endings) {
                Some(next) => ended = next,
                None => return true,
            }
        }
        loop {
            let (a, b) = (&ended.0, &lined.0);
            let until_s = ended.1.fmin(lined.1);
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
            if !(kept(&a.j, b.jerk, &self.jerk)
                && kept(&acc, acceleration, &self.acceleration)
                && kept(&v, rate, &self.speed)
                && kept(&v_middle, rate_middle, &self.speed))
            {
                return false;
            }
            now_s = until_s;
            if ended.1 <= now_s {
                match next_ending(&mut endings) {
                    Some(next) => ended = next,
                    None => return true,
                }
            }
            if lined.1 <= now_s {
                match next_line(&mut lines) {
                    Some(next) => lined = next,
                    None => return true,
                }
            }
        }
    }
}

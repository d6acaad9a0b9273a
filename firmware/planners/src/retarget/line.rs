//! The line of a candidate, in floats: a plain profile along a way.

use super::ending::Leaving;
use motion::limits::PathLimits;
use motion::profile::rest_to_rest::RestToRestProfile;
use motion::profile::velocity::AccelerationLimits;
use motion::speeds::Speeds;
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
        let AccelerationLimits { acceleration, jerk } = &leaving.limits;
        let least = |limit: &Speeds| (limit.linear / length).fmin(limit.angular / turn);
        let limits = PathLimits {
            rate: least(&leaving.speed),
            acceleration: least(acceleration) * share,
            jerk: least(jerk) * share,
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

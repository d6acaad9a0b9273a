//! Where a motion may go: the disk for the platform's centre, the bounds for the moved point, for stops too.

use super::sample::{Arc, Sample};
use super::{Broken, Look};
use crate::motion::brake::Brake;
use crate::motion::constraints::{Bounds, Constraints};
use crate::motion::plan::axis_state::AxisState;
use crate::motion::plan::units::{PER_AXIS_UNIT, PER_POSITION_UNIT, TickLimits};
use crate::number::float::{FloatMinMax, hypot, i64_to_f32_fast};
use core::f32::consts::TAU;

/// See the module.
pub(crate) struct Reach {
    radius: f32,
    bounds: Bounds,
    /// The moved point in the platform's axes, and its distance from the platform's centre.
    pub centre: [f32; 2],
    pub arm: f32,
}

/// What translation and rotation brake with, per second.
pub(crate) struct Braking {
    /// Acceleration, and its inverse.
    most: [f32; 2],
    over_most: [f32; 2],
    /// Inverse of the jerk.
    over_jerk: [f32; 2],
}

impl Braking {
    /// Of limits at `hz` ticks a second.
    pub fn new(limits: &TickLimits, hz: f32) -> Self {
        let units = [PER_AXIS_UNIT * hz * hz, PER_AXIS_UNIT * TAU * hz * hz];
        let each = [&limits.translation, &limits.rotation];
        let most = [0, 1].map(|i| each[i].acceleration * units[i]);
        Self {
            most,
            over_most: most.map(|most| 1.0 / most),
            over_jerk: [0, 1].map(|i| 1.0 / (each[i].jerk * units[i] * hz)),
        }
    }
}

/// Slack of single precision: 0.02 um on the reference stage.
const RIM: f32 = 2e-7;

impl Reach {
    pub fn new(ground: &Constraints) -> Self {
        let centre = ground.rotation_centre.map(|value| value as f32);
        Self {
            radius: ground.usable_radius as f32,
            bounds: ground.bounds,
            centre,
            arm: hypot(centre[0], centre[1]),
        }
    }

    /// How far each axis may go down and up from here, track radii and rad.
    pub fn rooms(&self, axes: &[AxisState; 3]) -> [[f32; 2]; 3] {
        let unit = [
            PER_POSITION_UNIT,
            PER_POSITION_UNIT,
            TAU * PER_POSITION_UNIT,
        ];
        [0, 1, 2].map(|i| {
            let here = axes[i].rounded();
            self.bounds[i].map(|bound| i64_to_f32_fast(bound.saturating_sub(here)) * unit[i])
        })
    }

    /// Holds a stretch against the bounds; `rise` is how far translation and rotation can rise between its ends.
    pub fn check_way(
        &self,
        rooms: &[[f32; 2]; 3],
        from: &Sample,
        to: &Sample,
        rise: [f32; 2],
    ) -> Result<(), Broken> {
        for i in 0..3 {
            let rise = rise[i / 2];
            let (low, high) = (
                from.way[i].fmin(to.way[i]) - rise,
                from.way[i].fmax(to.way[i]) + rise,
            );
            if !(rooms[i][0] - RIM <= low && high <= rooms[i][1] + RIM) {
                return Err(Broken::Reach);
            }
        }
        Ok(())
    }

    /// A distance of the platform's centre from the track's, if that is inside the disk.
    pub fn inside(&self, distance: f32) -> Result<f32, Broken> {
        if distance <= self.radius + RIM {
            Ok(distance)
        } else {
            Err(Broken::Reach)
        }
    }

    /// Of the platform's centre from the track's.
    pub fn distance(&self, arc: &Arc, sample: &Sample) -> f32 {
        if self.arm > 0.0 {
            arc.platform(sample, self.centre).radius()
        } else {
            let [x, y] = arc.place(sample);
            hypot(x, y)
        }
    }

    /// Whether a stop from here ends far from every edge: a bound of its way, twice what it is as a rule, for a few operations.
    pub fn far_inside(&self, rooms: &[[f32; 2]; 3], at: &Look, braking: &Braking) -> bool {
        let release = [0, 1].map(|i| (at.a[i] + braking.most[i]) * braking.over_jerk[i]);
        let gained = [0, 1].map(|i| at.v[i] + at.a[i] * release[i]);
        let lasts = [0, 1].map(|i| 2.0 * release[i] + gained[i] * braking.over_most[i]);
        let [way, turn] = gained.map(|speed| speed * lasts[0].fmax(lasts[1]));
        let ways = [way, way, turn];
        let here = &at.sample.way;
        let clear = |i: usize| rooms[i][0] <= here[i] - ways[i] && here[i] + ways[i] <= rooms[i][1];
        at.far + self.arm + way <= self.radius && clear(0) && clear(1) && clear(2)
    }

    /// Holds a stop from a state against disk and bounds: at the ends of its three segments.
    pub fn check_stop(
        &self,
        arc: &Arc,
        rooms: &[[f32; 2]; 3],
        at: &Sample,
        brake: &Brake,
        hz: f32,
    ) -> Result<(), Broken> {
        let [t1, t2, t3] = brake.about().map(|ticks| ticks / hz);
        let mut spots = [*at; 3];
        for i in 0..3 {
            let (v, a) = (at.v[i], at.a[i]);
            let whole = t1 / 2.0 + t2 + t3 / 2.0;
            if !(whole > 0.0) {
                continue;
            }
            let peak = -(v + a * t1 / 2.0) / whole;
            let v1 = v + (a + peak) * t1 / 2.0;
            let v2 = v1 + peak * t2;
            spots[0].way[i] = at.way[i] + t1 * (v + t1 * (a / 3.0 + peak / 6.0));
            spots[1].way[i] = spots[0].way[i] + t2 * (v1 + peak * t2 / 2.0);
            spots[2].way[i] = spots[1].way[i] + t3 * (v2 + peak * t3 / 3.0);
        }
        for spot in &spots {
            self.check_way(rooms, spot, spot, [0.0; 2])?;
            self.inside(self.distance(arc, spot))?;
        }
        Ok(())
    }
}

//! Where a motion may go: the disk for the platform's centre, the bounds for the moved point, for stops too.

use super::interval::IntervalEnd;
use super::interval::Violation;
use crate::constraints::{Bounds, Constraints, MotionLimits};
use crate::plan::axis_state::AxisState;
use crate::plan::axis_state::PER_POSITION_UNIT;
use crate::plan::cubic_segment::{CubicSegment, MotionState};
use crate::profile::velocity::{VelocityProfile, stop_displacements};
use crate::tolerances::WORKSPACE_RADII;
use core::f32::consts::TAU;
use number::float::{FloatMinMax, hypot, i64_to_f32_fast};

/// See the module.
pub struct Workspace {
    radius: f32,
    bounds: Bounds,
    /// The moved point in the platform's axes, and its distance from the platform's centre.
    pub centre: [f32; 2],
    pub arm: f32,
}

/// What translation and rotation brake with, per second.
pub struct StopLimits {
    limits: MotionLimits,
    /// Acceleration, and its inverse.
    most: [f32; 2],
    over_most: [f32; 2],
    /// Inverse of the jerk.
    over_jerk: [f32; 2],
}

impl StopLimits {
    pub fn new(limits: MotionLimits) -> Self {
        let most = [limits.acceleration.linear, limits.acceleration.angular];
        let jerk = [limits.jerk.linear, limits.jerk.angular];
        Self {
            limits,
            most,
            over_most: most.map(|most| 1.0 / most),
            over_jerk: jerk.map(|jerk| 1.0 / jerk),
        }
    }
}

impl Workspace {
    pub fn new(constraints: &Constraints) -> Self {
        let centre = constraints.centre();
        Self {
            radius: constraints.usable_radius as f32,
            bounds: constraints.bounds,
            centre,
            arm: hypot(centre[0], centre[1]),
        }
    }

    /// How far each axis may go down and up from here, track radii and rad.
    pub fn bound_distances(&self, axes: &[AxisState; 3]) -> [[f32; 2]; 3] {
        let unit = [
            PER_POSITION_UNIT,
            PER_POSITION_UNIT,
            TAU * PER_POSITION_UNIT,
        ];
        each!(i => {
            let here = axes[i].rounded();
            self.bounds[i].map(|bound| i64_to_f32_fast(bound.saturating_sub(here)) * unit[i])
        })
    }

    /// Holds an interval against the bounds; `rise` is how far translation and rotation can rise between its ends.
    pub fn check_bounds(
        &self,
        bound_distances: &[[f32; 2]; 3],
        from: &MotionState,
        to: &MotionState,
        rise: [f32; 2],
    ) -> Result<(), Violation> {
        for i in 0..3 {
            let rise = rise[i / 2];
            let (low, high) = (
                from.displacement[i].fmin(to.displacement[i]) - rise,
                from.displacement[i].fmax(to.displacement[i]) + rise,
            );
            if !(bound_distances[i][0] - WORKSPACE_RADII <= low
                && high <= bound_distances[i][1] + WORKSPACE_RADII)
            {
                return Err(Violation::Bounds(i));
            }
        }
        Ok(())
    }

    /// A distance of the platform's centre from the track's, if that is inside the disk.
    pub fn check_disk(&self, distance: f32) -> Result<f32, Violation> {
        if distance <= self.radius + WORKSPACE_RADII {
            Ok(distance)
        } else {
            Err(Violation::Disk(distance))
        }
    }

    /// Of the platform's centre from the track's.
    #[inline(never)]
    pub fn centre_distance(&self, segment: &CubicSegment, sample: &MotionState) -> f32 {
        if self.arm > 0.0 {
            segment.platform(sample, self.centre).radius()
        } else {
            let [x, y] = segment.point(sample);
            hypot(x, y)
        }
    }

    /// Whether a stop from here ends far from every edge: a bound of its way, twice what it is as a rule, for a few
    /// operations.
    fn stop_is_clear_of_edges(
        &self,
        bound_distances: &[[f32; 2]; 3],
        at: &IntervalEnd,
        braking: &StopLimits,
    ) -> bool {
        let release = both!(i => (at.a[i] + braking.most[i]) * braking.over_jerk[i]);
        let gained = both!(i => at.v[i] + at.a[i] * release[i]);
        let lasts = both!(i => 2.0 * release[i] + gained[i] * braking.over_most[i]);
        let [way, turn] = both!(k => gained[k] * lasts[0].fmax(lasts[1]));
        let ways = [way, way, turn];
        let here = &at.sample.displacement;
        let clear = |i: usize| {
            bound_distances[i][0] <= here[i] - ways[i] && here[i] + ways[i] <= bound_distances[i][1]
        };
        at.point_distance + self.arm + way <= self.radius && clear(0) && clear(1) && clear(2)
    }

    /// Holds a stop from here against disk and bounds: at the ends of its three segments.
    pub fn check_stop(
        &self,
        segment: &CubicSegment,
        bound_distances: &[[f32; 2]; 3],
        end: &IntervalEnd,
        limits: &StopLimits,
    ) -> Result<(), Violation> {
        if self.stop_is_clear_of_edges(bound_distances, end, limits) {
            return Ok(());
        }
        let at = &end.sample;
        let stop = VelocityProfile::new(at, &[0.0; 3], &limits.limits);
        for displacement in stop_displacements(at, stop.rough_times_s()) {
            let spot = MotionState {
                displacement,
                ..*at
            };
            self.check_bounds(bound_distances, &spot, &spot, [0.0; 2])?;
            self.check_disk(self.centre_distance(segment, &spot))?;
        }
        Ok(())
    }
}

//! From the pose's setpoint to those of the three pivots, and what a tick is to follow.

use super::config::Config;
use super::servo::platform_torques;
use crate::motion::{Position, Setpoint};
use crate::number::Fixed;
use kinematics::{
    Angle, Guide, Inverse, PivotMotion, Pose, in_platform_axes, inverse,
    pivot_motion_in_platform_axes,
};

/// Setpoints of the three pivots.
#[derive(Clone, Debug)]
pub(super) struct PivotSetpoints {
    pub angles: [Angle; 3],
    pub motion: PivotMotion<f32>,
    pub torques: [f32; 3],
    /// Distances along the guides, track radii, and the cosines of their angles to the tangents: all that is used of the guides
    /// later.
    pub lengths: [f32; 3],
    pub cosines: [f32; 3],
}

impl PivotSetpoints {
    /// Room for them, or all at rest at these angles, where nobody asks for guides. Zeros stand in no constant: that would be read from
    /// flash.
    pub fn at_rest(angles: [Angle; 3]) -> Self {
        Self {
            angles,
            motion: PivotMotion {
                rates: [0.0; 3],
                accelerations: [0.0; 3],
            },
            torques: [0.0; 3],
            lengths: [0.0; 3],
            cosines: [0.0; 3],
        }
    }
}

/// What a tick is to follow, known before it begins: see [`next_setpoint`](super::next_setpoint).
#[derive(Clone, Debug, Default)]
pub(super) struct NextSetpoint {
    /// Of the point that is moved.
    pub point: Setpoint,
    /// Of the platform's own centre.
    pub platform: Setpoint,
    /// Whether the plan goes on after it.
    pub moving: bool,
    /// Of the pivots, where the servo is on.
    pub pivots: Option<PivotSetpoints>,
    /// Whether that of the pivot that is inspected hardly moves.
    pub slowly: bool,
}

/// Setpoint of the pose to setpoints of the pivots, if it is a pose of the mechanism. They are written where they are kept: handed
/// back they were copied three times on their way, 570 cycles of each tick.
#[inline(never)]
pub(super) fn pivot_setpoints(
    config: &Config,
    setpoint: &Setpoint,
    wanted: &mut PivotSetpoints,
) -> Option<()> {
    let Inverse { pivots, guides } = inverse(&pose(&setpoint.position)?).ok()?;
    let guides = guides.map(|guide: Guide<Fixed>| guide.map(Fixed::to_f32));
    let (twist, acceleration) = in_platform_axes(&guides, &setpoint.twist, &setpoint.acceleration);
    wanted.angles = pivots;
    wanted.motion = pivot_motion_in_platform_axes(&guides, &twist, &acceleration);
    wanted.torques = platform_torques(&config.servo.body, &guides, &twist, &acceleration);
    wanted.lengths = [guides[0].rho(), guides[1].rho(), guides[2].rho()];
    wanted.cosines = guides.map(|guide| guide.cosine);
    Some(())
}

/// The pose of a position, as far as it is one of the mechanism.
#[inline]
pub(super) fn pose(position: &Position) -> Option<Pose<Fixed>> {
    Some(Pose {
        x: Fixed::from_position(position[0])?,
        y: Fixed::from_position(position[1])?,
        theta: Angle::from_units(position[2]),
    })
}

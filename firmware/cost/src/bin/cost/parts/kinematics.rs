//! The mechanism in the tick's numbers.

use crate::bench::{Bench, no_result};
use crate::table::CallResult;
use firmware::number::Fixed;
use firmware_cost::random::Random;
use firmware_cost::states::{moved, pose};
use kinematics::{
    Acceleration, Angle, Inverse, PivotMotion, Pose, Twist, direct, in_platform_axes, inverse,
    pivot_motion_in_platform_axes,
};

/// Counts inverse and direct kinematics.
#[inline(never)]
pub fn run(bench: &mut Bench) {
    bench.part(
        "inverse kinematics: position, rate, acceleration",
        Bench::SHORT,
        moved,
        |(pose, twist, acceleration)| pivots_of(pose, twist, acceleration),
        |_, pivots| refused(pivots.is_none()),
    );
    bench.part(
        "inverse kinematics: position",
        Bench::SHORT,
        moved,
        |(pose, ..)| inverse(pose),
        |_, pivots| refused(pivots.is_err()),
    );
    bench.part(
        "direct kinematics",
        Bench::SHORT,
        pivots,
        direct::<Fixed>,
        |_, pose| refused(pose.is_err()),
    );
    bench.part(
        "sine and cosine",
        Bench::SHORT,
        |random| Angle::from_units(random.bits() as i64),
        |&angle| <Fixed as kinematics::Scalar>::sin_cos(angle),
        no_result,
    );
}

/// Setpoint of the pose to setpoints of the pivots, as the tick has it.
fn pivots_of(
    pose: &Pose<Fixed>,
    twist: &Twist<f32>,
    acceleration: &Acceleration<f32>,
) -> Option<([Angle; 3], PivotMotion<f32>)> {
    let Inverse { pivots, guides } = inverse(pose).ok()?;
    let guides = guides.map(|guide| guide.map(Fixed::to_f32));
    let (twist, acceleration) = in_platform_axes(&guides, twist, acceleration);
    let motion = pivot_motion_in_platform_axes(&guides, &twist, &acceleration);
    Some((pivots, motion))
}

fn pivots(random: &mut Random) -> [Angle; 3] {
    match inverse(&pose(random)) {
        Ok(inverse) => inverse.pivots,
        // Answered by the first pose that has pivots, which all of the usable disk have.
        Err(_) => [Angle::ZERO; 3],
    }
}

fn refused(refused: bool) -> CallResult {
    CallResult { refused, ticks: 0 }
}

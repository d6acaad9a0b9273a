//! The tick's numbers against double precision: position kinematics in fixed point, over the whole disk and +-10,000 turns.
//!
//! Both get the very same inputs: a fixed-point length is a double exactly, and an angle is reduced to its fraction of a turn
//! before it becomes one, so that doubles are good to 1e-15 here and turns cost them nothing.

mod proptest_settings;

use firmware::motion::RotationCentre;
use firmware::number::Fixed;
use kinematics::{Angle, Pose, direct, inverse};
use proptest::prelude::*;
use proptest_settings::settings;
use std::f64::consts::{PI, TAU};

/// A quarter of an encoder LSB: the goal.
const QUARTER_LSB_RAD: f64 = 2.3e-8;
/// What it does: pinned, so that a loss of digits is seen long before the goal.
const PIVOT_RAD: f64 = 8.0e-9;
/// With a centre of rotation up to a track radius from the platform's.
const PIVOT_OFF_CENTRE_RAD: f64 = 9.2e-9;
const CENTRE: f64 = 6.1e-9;
const THETA_RAD: f64 = 4.1e-9;
/// There and back.
const CENTRE_BACK: f64 = 7.4e-9;
const THETA_BACK_RAD: f64 = 3.3e-9;
/// Between two poses that differ by a third of a turn.
const RENAMED_RAD: f64 = 9.7e-9;
const _: () = assert!(
    PIVOT_RAD < PIVOT_OFF_CENTRE_RAD
        && PIVOT_OFF_CENTRE_RAD < QUARTER_LSB_RAD
        && CENTRE < QUARTER_LSB_RAD
        && THETA_RAD < QUARTER_LSB_RAD
);

const UNIT_RAD: f64 = TAU / 4_294_967_296.0;
const TURNS: i64 = 10_000;

/// An angle's fraction of a turn, exactly, in (-pi, pi].
fn reduced(angle: Angle) -> f64 {
    f64::from(angle.fraction() as i32) * UNIT_RAD
}

/// `angle` minus `exact`, with whole turns taken out of both: `turns` and a small rest.
fn difference(angle: Angle, exact_rad: f64) -> f64 {
    let rad = reduced(angle) - exact_rad;
    rad - TAU * (rad / TAU).round()
}

fn pose_at(r: f64, direction: f64, theta: Angle) -> Pose<Fixed> {
    Pose {
        x: Fixed::from_f64(r * direction.cos()),
        y: Fixed::from_f64(r * direction.sin()),
        theta,
    }
}

fn exactly(pose: &Pose<Fixed>) -> Pose<f64> {
    Pose {
        x: pose.x.to_f64(),
        y: pose.y.to_f64(),
        theta: reduced(pose.theta),
    }
}

/// Largest error of a pivot, rad, and whether its turns are right.
fn pivot_error(pose: &Pose<Fixed>) -> f64 {
    let fixed = inverse(pose).expect("inside the track").pivots;
    let exact = inverse(&exactly(pose)).expect("inside the track").pivots;
    let whole = Angle::from_units(pose.theta.units() - i64::from(pose.theta.fraction() as i32));
    let mut worst = 0.0_f64;
    for (fixed, exact) in fixed.into_iter().zip(exact) {
        // Turns and all: what is left after theta's whole turns is within two.
        worst = worst.max(((fixed - whole).units() as f64 * UNIT_RAD - exact).abs());
        worst = worst.max(difference(fixed, exact).abs());
    }
    worst
}

/// Errors of centre (track radii) and orientation (rad) of the direct solution from the pivots of a pose.
fn pose_error(pivots: &[Angle; 3]) -> (f64, f64) {
    let fixed = direct::<Fixed>(pivots).expect("feasible pivots");
    // All turned by the first's whole turns: nothing but theta's turns changes.
    let whole = Angle::from_units(i64::from(pivots[0].turns()) << 32);
    let near = pivots.map(|pivot| (pivot - whole).units() as f64 * UNIT_RAD);
    let exact = direct::<f64>(&near).expect("feasible pivots");
    let centre = (fixed.x.to_f64() - exact.x).hypot(fixed.y.to_f64() - exact.y);
    let theta = (fixed.theta - whole).units() as f64 * UNIT_RAD - exact.theta;
    (centre, theta.abs())
}

/// The disk in 40 rings, 89 directions, 61 orientations, with turns from all over the range.
fn grid() -> impl Iterator<Item = Pose<Fixed>> {
    let mut scatter = 1u64;
    (0..=40).flat_map(move |ring| {
        (0..89).flat_map(move |spoke| {
            (0..61).map(move |_| {
                scatter = scatter
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1_442_695_040_888_963_407 ^ (ring * 89 + spoke));
                let units = (scatter >> 16) as i64 % (TURNS << 32);
                let theta = Angle::from_units(if scatter & 1 == 0 { units } else { -units });
                pose_at(0.8 * ring as f64 / 40.0, TAU * spoke as f64 / 89.0, theta)
            })
        })
    })
}

#[test]
fn pivot_setpoints_are_exact_to_a_quarter_lsb() {
    let worst = grid().map(|pose| pivot_error(&pose)).fold(0.0, f64::max);
    println!("worst pivot error {worst:e} rad");
    assert!(worst < PIVOT_RAD, "{worst:e} rad");
}

#[test]
fn measured_poses_are_exact_to_a_quarter_lsb() {
    let (mut centre, mut theta) = (0.0_f64, 0.0_f64);
    for pose in grid() {
        let error = pose_error(&inverse(&pose).expect("inside the track").pivots);
        (centre, theta) = (centre.max(error.0), theta.max(error.1));
    }
    println!("worst error of the centre {centre:e} track radii, of the orientation {theta:e} rad");
    assert!(centre < CENTRE && theta < THETA_RAD, "{centre:e} {theta:e}");
}

/// Largest error of a pivot, rad, when not the platform's centre is commanded but the point at `point` (track radii).
fn pivot_error_off_centre(pose: &Pose<Fixed>, point: [f64; 2]) -> f64 {
    let centre = RotationCentre::new(point).expect("near enough");
    let [x, y] = centre.point();
    let commanded = {
        // Where the point is, to the unit below: the platform is then near `pose`, wherever exactly.
        let (sin, cos) = reduced(pose.theta).sin_cos();
        let units = |radii: f64| (radii * 4_294_967_296.0) as i64;
        [
            pose.x.to_position() + units(x * cos - y * sin),
            pose.y.to_position() + units(x * sin + y * cos),
            pose.theta.units(),
        ]
    };
    let exact = {
        let (sin, cos) = reduced(pose.theta).sin_cos();
        Pose {
            x: commanded[0] as f64 / 4_294_967_296.0 - (x * cos - y * sin),
            y: commanded[1] as f64 / 4_294_967_296.0 - (x * sin + y * cos),
            theta: reduced(pose.theta),
        }
    };
    let platform = centre.to_platform(&commanded);
    let fixed = inverse(&Pose {
        x: Fixed::from_position(platform[0]).expect("inside the track"),
        y: Fixed::from_position(platform[1]).expect("inside the track"),
        theta: Angle::from_units(platform[2]),
    });
    let exact = inverse(&exact).expect("inside the track").pivots;
    (fixed.expect("inside the track").pivots.into_iter())
        .zip(exact)
        .map(|(fixed, exact)| difference(fixed, exact).abs())
        .fold(0.0, f64::max)
}

#[test]
fn pivot_setpoints_are_exact_about_any_centre() {
    let mut worst = 0.0_f64;
    for (k, pose) in grid().enumerate() {
        let (r, direction) = (((k % 97) as f64 / 96.0).sqrt() * 0.999_999, k as f64);
        let point = [r * direction.cos(), r * direction.sin()];
        worst = worst.max(pivot_error_off_centre(&pose, point));
    }
    println!("worst pivot error about a centre {worst:e} rad");
    assert!(worst < PIVOT_OFF_CENTRE_RAD, "{worst:e} rad");
}

fn poses() -> impl Strategy<Value = Pose<Fixed>> {
    (0.0..=0.8_f64, -PI..PI, -TURNS << 32..=TURNS << 32)
        .prop_map(|(r, direction, units)| pose_at(r, direction, Angle::from_units(units)))
}

proptest! {
    #![proptest_config(settings(20_000))]

    #[test]
    fn any_pose_is_exact(pose in poses()) {
        prop_assert!(pivot_error(&pose) < PIVOT_RAD);
        let (centre, theta) = pose_error(&inverse(&pose).unwrap().pivots);
        prop_assert!(centre < CENTRE && theta < THETA_RAD);
    }

    #[test]
    fn a_pose_comes_back(pose in poses()) {
        let back = direct::<Fixed>(&inverse(&pose).unwrap().pivots).unwrap();
        let off = (back.x - pose.x).to_f64().hypot((back.y - pose.y).to_f64());
        prop_assert!(off < CENTRE_BACK, "{off:e}");
        let theta = (back.theta - pose.theta).units() as f64 * UNIT_RAD;
        prop_assert!(theta.abs() < THETA_BACK_RAD, "{theta:e}");
    }

    #[test]
    fn whole_turns_change_nothing(pose in poses(), turns in -TURNS..=TURNS) {
        let whole = Angle::from_units(turns << 32);
        let turned = Pose { theta: pose.theta + whole, ..pose };
        let (one, other) = (inverse(&pose).unwrap(), inverse(&turned).unwrap());
        prop_assert_eq!(one.guides, other.guides);
        prop_assert_eq!(one.pivots.map(|pivot| pivot + whole), other.pivots);
        let (one, other) = (direct::<Fixed>(&one.pivots).unwrap(), direct::<Fixed>(&other.pivots).unwrap());
        prop_assert_eq!((one.x, one.y, one.theta + whole), (other.x, other.y, other.theta));
    }

    #[test]
    fn a_third_of_a_turn_renames_the_pivots(pose in poses()) {
        let turned = Pose { theta: pose.theta + Angle::DEG_120, ..pose };
        let [one, two, three] = inverse(&pose).unwrap().pivots;
        let [a, b, c] = inverse(&turned).unwrap().pivots;
        // 120 deg is a third of a unit short, and every pivot has its own roundings.
        for (renamed, pivot) in [(a, two), (b, three), (c, one + Angle::TURN)] {
            let off = (renamed - pivot).units() as f64 * UNIT_RAD;
            prop_assert!(off.abs() < RENAMED_RAD, "{off:e}");
        }
    }
}

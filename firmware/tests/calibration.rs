//! The tick's calibration: encoder setpoints and measured poses of built machines against
//! double precision and against poses and readings computed elsewhere, and that no correction changes a bit where there
//! is none.

#[path = "../../kinematics/tests/built_machine/mod.rs"]
mod built_machine;
mod proptest_settings;

use built_machine::{BuiltMachine, all, lines};
use firmware::calibration::Calibration;
use firmware::number::Fixed;
use kinematics::{
    Acceleration, Angle, Corrections, Curves, Guide, Line, PivotCoefficients, Pose, Series,
    Tangents, Twist, corrected_direct, corrected_inverse, corrected_pivot_motion, direct,
    in_platform_axes, inverse, pivot_motion,
};
use proptest::prelude::*;
use proptest_settings::settings;
use std::f64::consts::{PI, TAU};
use std::sync::LazyLock;

/// All told; a quarter of an encoder LSB is 2.3e-8 rad.
const GOAL_RAD: f64 = 2.0e-8;
/// What it does: pinned, so that a loss of digits is seen before the goal. Against the vectors, and over the whole
/// disk.
const SETPOINT_RAD: f64 = 1.05e-8;
const SETPOINT_ON_DISK_RAD: f64 = 1.4e-8;
/// Of a measured pose, in track radii and rad.
const POSE: f64 = 8.5e-9;
const _: () = assert!(SETPOINT_RAD < GOAL_RAD && SETPOINT_ON_DISK_RAD < GOAL_RAD);

fn calibration(pivots: &[PivotCoefficients; 3]) -> Calibration {
    Corrections::new(pivots, Series::new).expect("within the limits")
}

const IDEAL: Calibration = Corrections {
    lines: [Line::IDEAL; 3],
    curves: [Series::ZERO; 3],
};

static BUILT: LazyLock<Calibration> = LazyLock::new(|| calibration(&all().pivots));

/// As far off as is taken, every number this way or the other.
static WORST: LazyLock<[Calibration; 2]> = LazyLock::new(|| {
    [1.0, -1.0].map(|sign| {
        calibration(
            &[PivotCoefficients {
                encoder_zero_rad: PI * sign,
                radius_error: 0.02 * sign,
                ring_centre: [0.01 * sign; 2],
                guide_error_rad: -0.02 * sign,
                guide_offset: 0.02 * sign,
                encoder_rad: [[8e-5 * sign; 2]; 12],
                runout: [[1.99e-4 * sign; 2]; 5],
                straightness: [2.49e-4 * sign; 8],
            }; 3],
        )
    })
});

fn exact(pivots: &[PivotCoefficients; 3]) -> Corrections<f64, Series<f64>> {
    Corrections::new(pivots, Series::new).expect("within the limits")
}

fn angle(rad: f64) -> Angle {
    Angle::from_radians(rad).expect("a few turns")
}

fn rounded(pose: &Pose<f64>) -> Pose<Fixed> {
    Pose {
        x: Fixed::from_f64(pose.x),
        y: Fixed::from_f64(pose.y),
        theta: angle(pose.theta),
    }
}

fn exactly(pose: &Pose<Fixed>) -> Pose<f64> {
    Pose {
        x: pose.x.to_f64(),
        y: pose.y.to_f64(),
        theta: pose.theta.radians(),
    }
}

fn at(r: f64, direction: f64, theta: f64) -> Pose<f64> {
    Pose {
        x: r * direction.cos(),
        y: r * direction.sin(),
        theta,
    }
}

fn poses(radius: f64) -> impl Strategy<Value = Pose<f64>> {
    (0.0..radius, -PI..PI, -PI..PI).prop_map(|(r, direction, theta)| at(r, direction, theta))
}

/// Largest errors of the encoder setpoints (rad) of a machine's poses: against the rows, whose poses fixed point has to
/// round, and against double precision from the rounded poses.
fn setpoint_errors(machine: &BuiltMachine) -> [f64; 2] {
    let calibration = calibration(&machine.pivots);
    let exact = exact(&machine.pivots);
    let mut worst = [0.0_f64; 2];
    for row in &machine.rows {
        let pose = rounded(&row.pose);
        let setpoints = corrected_inverse(&pose, &calibration).expect("inside the track");
        let double = corrected_inverse(&exactly(&pose), &exact).expect("inside the track");
        for i in 0..3 {
            let setpoint = setpoints.encoders[i].radians();
            worst[0] = worst[0].max((setpoint - row.encoders[i]).abs());
            worst[1] = worst[1].max((setpoint - double.encoders[i]).abs());
        }
    }
    println!("{}: {worst:?} rad", machine.name);
    worst
}

#[test]
fn setpoints_agree_with_the_vectors() {
    for machine in [lines(), all()] {
        let worst = setpoint_errors(&machine);
        assert!(
            worst.iter().all(|&error| error <= SETPOINT_RAD),
            "{worst:?}"
        );
    }
}

/// 45 rings and 89 directions, 31 orientations each, all of them different.
#[test]
fn setpoints_are_exact_to_a_quarter_lsb_on_the_whole_disk() {
    let exact = exact(&all().pivots);
    let mut worst = 0.0_f64;
    for k in 0..45 * 89 * 31 {
        let (ring, spoke) = (f64::from(k % 45) / 44.0, f64::from(k / 45 % 89) / 89.0);
        let turn = (f64::from(k) * 0.618_033_988_749_895).fract() - 0.5;
        let pose = rounded(&at(0.8 * ring, TAU * spoke, TAU * turn));
        let setpoints = corrected_inverse(&pose, &BUILT).expect("inside the track");
        let double = corrected_inverse(&exactly(&pose), &exact).expect("inside the track");
        for i in 0..3 {
            let error = setpoints.encoders[i].radians() - double.encoders[i];
            worst = worst.max(error.abs());
        }
    }
    println!("{worst:e} rad");
    assert!(worst <= SETPOINT_ON_DISK_RAD, "{worst:e} rad");
}

#[test]
fn measured_poses_agree_with_the_vectors_after_two_steps() {
    for machine in [lines(), all()] {
        let calibration = calibration(&machine.pivots);
        let mut worst = [0.0_f64; 2];
        for row in &machine.rows {
            let encoders = row.encoders.map(angle);
            let pose = exactly(&corrected_direct(&encoders, &calibration, 2).expect("a pose"));
            worst[0] = worst[0].max((pose.x - row.pose.x).hypot(pose.y - row.pose.y));
            worst[1] = worst[1].max((pose.theta - row.pose.theta).abs());
        }
        println!("{}: centre, theta: {worst:?}", machine.name);
        assert!(worst.iter().all(|&error| error <= POSE), "{worst:?}");
    }
}

/// Beyond the guide's ends the straightness goes on straight.
#[test]
fn straightness_goes_on_beyond_the_ends() {
    for pivot in all().pivots {
        let series = Series::<f32>::new(&pivot);
        let at = |rho: f32| Curves::<Fixed>::straightness(&series, rho);
        for (end, beyond) in [(0.15_f32, [-3.0_f32, 0.0, 0.14]), (1.85, [1.86, 2.0, 9.0])] {
            let from = at(end);
            for rho in beyond {
                let straight = from.value + from.slope * (rho - end);
                assert!((at(rho).value - straight).abs() < 1e-6 * rho.abs().max(1.0));
                assert!((at(rho).slope - from.slope).abs() < 1e-6);
            }
        }
        assert!((at(0.16).slope - at(0.15).slope).abs() > 1e-6);
        assert!((at(1.84).slope - at(1.85).slope).abs() > 1e-6);
    }
}

/// What the tick goes along from one look at the series to the next: the setpoint is as good 2 mrad and 0.002 track radii
/// away as where they were looked at.
#[test]
fn tangents_hold_until_the_next_look() {
    let exact = exact(&all().pivots);
    let mut worst = 0.0_f64;
    for row in &all().rows {
        let pose = rounded(&row.pose);
        let from = corrected_inverse(&pose, &BUILT).expect("inside the track");
        let near = Corrections {
            lines: BUILT.lines,
            curves: [0, 1, 2].map(|i| {
                let ring = from.encoders[i] - BUILT.lines[i].encoder_zero;
                Tangents::of_ring(&BUILT.curves[i], ring)
                    .with_guide(&BUILT.curves[i], from.guides[i].rho())
            }),
        };
        for way in [0.0, 2e-3, -2e-3] {
            let theta = pose.theta + angle(way);
            let there = Pose { theta, ..pose };
            let setpoints = corrected_inverse(&there, &near).expect("inside the track");
            let double = corrected_inverse(&exactly(&there), &exact).expect("inside the track");
            for i in 0..3 {
                let error = setpoints.encoders[i].radians() - double.encoders[i];
                worst = worst.max(error.abs());
            }
        }
    }
    println!("{worst:e} rad");
    assert!(worst <= GOAL_RAD, "{worst:e} rad");
}

/// The reference gives each encoder the turn that it is in: the tangents are those of the same place on the ring, whichever turn they
/// were looked up in.
#[test]
fn tangents_hold_in_any_turn() {
    for row in &all().rows {
        let pose = rounded(&row.pose);
        let from = corrected_inverse(&pose, &BUILT).expect("inside the track");
        let setpoints = |turns: i64| {
            let near = Corrections {
                lines: BUILT.lines,
                curves: [0, 1, 2].map(|i| {
                    let ring = from.encoders[i] - BUILT.lines[i].encoder_zero;
                    let ring = ring + Angle::from_units(turns << 32);
                    Tangents::of_ring(&BUILT.curves[i], ring)
                        .with_guide(&BUILT.curves[i], from.guides[i].rho())
                }),
            };
            corrected_inverse(&pose, &near)
                .expect("inside the track")
                .encoders
        };
        for turns in [-3, -1, 1, 1_000] {
            assert_eq!(setpoints(turns), setpoints(0), "{turns} turns");
        }
    }
}

#[test]
fn one_curve_of_three_is_not_none() {
    let is_zero = |pivot| Curves::<Fixed>::are_zero(&Series::<f32>::new(&pivot));
    let ideal = PivotCoefficients::IDEAL;
    let (mut encoder, mut runout, mut straightness) = (ideal, ideal, ideal);
    encoder.encoder_rad[11][1] = 1e-6;
    runout.runout[0][0] = 1e-6;
    straightness.straightness[7] = 1e-6;
    assert!(is_zero(ideal));
    assert!(!is_zero(encoder) && !is_zero(runout) && !is_zero(straightness));
}

proptest! {
    #![proptest_config(settings(2_000))]

    #[test]
    fn an_ideal_machine_keeps_its_bits(
        pose in poses(0.99), speed in prop::array::uniform3(-2.0_f32..2.0), push in prop::array::uniform3(-40.0_f32..40.0),
    ) {
        let pose = rounded(&pose);
        let ideal = inverse(&pose).expect("inside the track");
        let built = corrected_inverse(&pose, &IDEAL).expect("inside the track");
        prop_assert_eq!(built.encoders, ideal.pivots);
        let guides = ideal.guides.map(|guide: Guide<Fixed>| guide.map(Fixed::to_f32));
        prop_assert_eq!(built.guides, guides);
        let twist = Twist { x: speed[0], y: speed[1], theta: speed[2] };
        let push = Acceleration { x: push[0], y: push[1], theta: push[2] };
        let (seen, pushed) = in_platform_axes(&guides, &twist, &push);
        let motion = corrected_pivot_motion(&built, &IDEAL.lines, &seen, &pushed);
        prop_assert_eq!(motion, pivot_motion(&guides, &twist, &push));
        prop_assert_eq!(corrected_direct(&ideal.pivots, &IDEAL, 2), direct::<Fixed>(&ideal.pivots));
    }

    /// The setpoint of a measured pose is the reading, whatever the turn: nothing moves when the servo takes over.
    #[test]
    fn a_measured_pose_gives_its_readings(pose in poses(0.8), turns in -10_000_i64..10_000) {
        let pose = rounded(&pose);
        let turn = Angle::from_units(turns << 32);
        let near = corrected_inverse(&pose, &BUILT).expect("inside the track").encoders;
        let there = Pose { theta: pose.theta + turn, ..pose };
        let encoders = corrected_inverse(&there, &BUILT).expect("inside the track").encoders;
        prop_assert_eq!(encoders, near.map(|encoder| encoder + turn));
        let back = corrected_direct(&encoders, &BUILT, 2).expect("a pose");
        let setpoints = corrected_inverse(&back, &BUILT).expect("inside the track").encoders;
        for (setpoint, encoder) in setpoints.into_iter().zip(encoders) {
            let error_rad = (setpoint - encoder).radians();
            prop_assert!(error_rad.abs() < GOAL_RAD, "{error_rad}");
        }
    }

    /// Of the worst machines that are taken, anywhere: an answer or an error, and no panic.
    #[test]
    fn there_is_an_answer_everywhere(
        x in -4.0..4.0, y in -1.0..1.0, theta in -PI..PI, way in 0..2_usize,
    ) {
        let calibration = &WORST[way];
        let pose = rounded(&Pose { x, y, theta });
        if let Ok(solved) = corrected_inverse(&pose, calibration) {
            let _ = corrected_direct(&solved.encoders, calibration, 2);
        }
        let _ = corrected_direct(&[x, y, theta].map(angle), calibration, 2);
    }
}

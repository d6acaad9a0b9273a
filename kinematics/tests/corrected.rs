//! The kinematics of built machines by their own laws: there and back, zero corrections, the definition, rates against
//! differences.

mod common;

use std::f64::consts::TAU;

use common::*;
use kinematics::{
    Acceleration, CorrectedInverse, CorrectedScalar, Corrections, Curves, PivotCoefficients, Pose,
    Real, Series, Twist, corrected_direct, corrected_direct_rates, corrected_inverse,
    corrected_pivot_motion, direct, in_platform_axes, inverse, pivot_motion,
};
use proptest::prelude::*;

type Machine = Corrections<f64, Series<f64>>;

/// Of a pivot, by the sizes that a workshop keeps: some mrad, 0.2 mm, 400 urad of eccentricity and 5 um on a track of
/// 100 mm.
fn pivot() -> impl Strategy<Value = PivotCoefficients> {
    let unit = || -1.0..1.0_f64;
    let lines = prop::array::uniform6(unit());
    let encoder = prop::array::uniform12(prop::array::uniform2(unit()));
    let runout = prop::array::uniform5(prop::array::uniform2(unit()));
    (lines, encoder, runout, prop::array::uniform8(unit())).prop_map(
        |([z, radius, x, y, e, d], encoder, runout, straightness)| PivotCoefficients {
            encoder_zero_rad: 3e-3 * z,
            radius_error: 2e-3 * radius,
            ring_centre: [x, y].map(|a| 4e-4 * a),
            guide_error_rad: 4e-3 * e,
            guide_offset: 4e-3 * d,
            encoder_rad: std::array::from_fn(|k| {
                let size = if k == 0 { 4e-4 } else { 2e-5 / (k + 1) as f64 };
                encoder[k].map(|part| size * part)
            }),
            runout: runout.map(|pair| pair.map(|part| 1.5e-5 * part)),
            straightness: straightness.map(|part| 1.5e-5 * part),
        },
    )
}

fn pivots() -> impl Strategy<Value = [PivotCoefficients; 3]> {
    prop::array::uniform3(pivot())
}

fn machine(pivots: &[PivotCoefficients; 3]) -> Machine {
    Corrections::new(pivots, Series::new).expect("within the limits")
}

/// The same without some of its curves.
fn without(
    pivots: &[PivotCoefficients; 3],
    change: impl Fn(PivotCoefficients) -> PivotCoefficients,
) -> Machine {
    machine(&pivots.map(change))
}

fn solve_built(pose: &Pose<f64>, machine: &Machine) -> CorrectedInverse<f64> {
    corrected_inverse(pose, machine).expect("a pose inside the track")
}

fn twists() -> impl Strategy<Value = Twist<f64>> {
    (-2.0..2.0, -2.0..2.0, -6.0..6.0).prop_map(|(x, y, theta)| Twist { x, y, theta })
}

/// The pose a time `t_s` later at constant acceleration.
fn moved(pose: &Pose<f64>, v: &Twist<f64>, a: &Acceleration<f64>, t_s: f64) -> Pose<f64> {
    let place = |p: f64, v: f64, a: f64| p + t_s * (v + t_s * a / 2.0);
    Pose {
        x: place(pose.x, v.x, a.x),
        y: place(pose.y, v.y, a.y),
        theta: place(pose.theta, v.theta, a.theta),
    }
}

const NO_ACCELERATION: Acceleration<f64> = Acceleration {
    x: 0.0,
    y: 0.0,
    theta: 0.0,
};

proptest! {
    #![proptest_config(settings())]

    /// One step onto the curved guide is what limits it.
    #[test]
    fn pivots_lie_on_their_guides(pivots in pivots(), pose in poses(0.8, 3.0)) {
        let machine = machine(&pivots);
        let solved = solve_built(&pose, &machine);
        for (i, built) in pivots.iter().enumerate() {
            // The encoder's slope is under 1e-3: each step leaves so much of the last.
            let reading = solved.encoders[i] - built.encoder_zero_rad;
            let psi = (0..6).fold(reading, |psi, _| {
                reading - Curves::<f64>::ring_errors(&machine.curves[i], psi).encoder.value
            });
            let errors = Curves::<f64>::ring_errors(&machine.curves[i], psi);
            let radius = 1.0 + built.radius_error + errors.runout.value;
            let [x, y] = [
                built.ring_centre[0] + radius * psi.cos() - pose.x,
                built.ring_centre[1] + radius * psi.sin() - pose.y,
            ];
            let (sin, cos) = (guide_angle(pose.theta, i) + built.guide_error_rad).sin_cos();
            let (rho, side) = (x * cos + y * sin, y * cos - x * sin);
            let gap: f64 = side - built.guide_offset - Curves::<f64>::straightness(&machine.curves[i], rho).value;
            prop_assert!(gap.abs() < 4e-11, "{gap}");
            prop_assert!((solved.guides[i].rho() - rho).abs() < 4e-4);
        }
    }

    #[test]
    fn a_pose_of_a_built_machine_comes_back(pivots in pivots(), pose in poses(0.8, 0.5), turns in -10_000_i32..10_000) {
        let machine = machine(&pivots);
        let turn = f64::from(turns) * TAU;
        let pose = Pose { theta: pose.theta + turn, ..pose };
        let encoders = solve_built(&pose, &machine).encoders;
        let back = corrected_direct::<f64, _>(&encoders, &machine, 4).expect("a feasible pose");
        // An ulp of 10,000 turns is 7e-12 rad.
        let tolerance = 5e-14 + 8.0 * f64::EPSILON * turn.abs();
        prop_assert!((back.x - pose.x).abs() < tolerance, "{back:?}");
        prop_assert!((back.y - pose.y).abs() < tolerance, "{back:?}");
        prop_assert!((back.theta - pose.theta).abs() < tolerance, "{back:?}");
    }

    /// The first encoder tells the turn, as the first pivot does; the others need not know theirs.
    #[test]
    fn single_turn_readings_are_a_pose_too(pivots in pivots(), pose in poses(0.8, 0.5), turns in prop::array::uniform2(-3_i32..3)) {
        let machine = machine(&pivots);
        let [one, two, three] = solve_built(&pose, &machine).encoders;
        let [two, three] = [two + f64::from(turns[0]) * TAU, three + f64::from(turns[1]) * TAU];
        let back = corrected_direct::<f64, _>(&[one, two, three], &machine, 4).expect("a feasible pose");
        prop_assert!((back.x - pose.x).abs() < 1e-13, "{back:?}");
        prop_assert!((back.y - pose.y).abs() < 1e-13, "{back:?}");
        prop_assert!((back.theta - pose.theta).abs() < 1e-13, "{back:?}");
    }

    #[test]
    fn slopes_of_curves_are_their_derivatives(pivots in pivots(), psi in -9.0..9.0, rho in 0.16..1.84) {
        const H: f64 = 1e-5;
        let series = Series::<f64>::new(&pivots[0]);
        let ring = |psi: f64| Curves::<f64>::ring_errors(&series, psi);
        let guide = |rho: f64| Curves::<f64>::straightness(&series, rho);
        let (before, at, after) = (ring(psi - H), ring(psi), ring(psi + H));
        let slope = |before: f64, after: f64| (after - before) / (2.0 * H);
        prop_assert!((slope(before.encoder.value, after.encoder.value) - at.encoder.slope).abs() < 1e-9);
        prop_assert!((slope(before.runout.value, after.runout.value) - at.runout.slope).abs() < 1e-9);
        let numeric = slope(guide(rho - H).value, guide(rho + H).value);
        prop_assert!((numeric - guide(rho).slope).abs() < 1e-8);
    }

    /// With encoder errors, which are in the slopes, and without runout and straightness, which are not.
    #[test]
    fn rates_are_the_derivatives_of_readings(pivots in pivots(), pose in poses(0.8, 1.0), twist in twists()) {
        const H: f64 = 1e-5;
        let ideal = PivotCoefficients::IDEAL;
        let machine = without(&pivots, |built| PivotCoefficients {
            runout: ideal.runout,
            straightness: ideal.straightness,
            ..built
        });
        let at = solve_built(&pose, &machine);
        let [before, after] = [-H, H]
            .map(|t_s| solve_built(&moved(&pose, &twist, &NO_ACCELERATION, t_s), &machine).encoders);
        let rates = [0, 1, 2].map(|i| (after[i] - before[i]) / (2.0 * H));
        let back = corrected_direct_rates(&at, &machine.lines, &rates);
        for (got, want) in [(back.x, twist.x), (back.y, twist.y), (back.theta, twist.theta)] {
            prop_assert!((got - want).abs() < 1e-7, "{back:?}");
        }
        let motion = motion(&machine, &at, &twist, &NO_ACCELERATION);
        for (got, want) in motion.rates.into_iter().zip(rates) {
            prop_assert!((got - want).abs() < 1e-7, "{got} {want}");
        }
    }

    /// Without curves: the slope of an encoder's slope is not in.
    #[test]
    fn accelerations_are_second_derivatives_of_readings(pivots in pivots(), pose in poses(0.8, 1.0), twist in twists(), push in twists()) {
        const H: f64 = 1e-4;
        let ideal = PivotCoefficients::IDEAL;
        let machine = without(&pivots, |built| PivotCoefficients {
            encoder_rad: ideal.encoder_rad,
            runout: ideal.runout,
            straightness: ideal.straightness,
            ..built
        });
        let push = Acceleration { x: push.x, y: push.y, theta: push.theta };
        let [before, at, after] = [-H, 0.0, H]
            .map(|t_s| solve_built(&moved(&pose, &twist, &push, t_s), &machine));
        let motion = motion(&machine, &at, &twist, &push);
        for i in 0..3 {
            let second = (after.encoders[i] - 2.0 * at.encoders[i] + before.encoders[i]) / (H * H);
            let difference = (motion.accelerations[i] - second).abs();
            // The third derivatives of worst motions at the rim are some 1e4.
            prop_assert!(difference < 2e-3, "{difference}");
        }
    }

    #[test]
    fn zero_corrections_keep_the_bits_in_f64(pose in poses(0.99, 3.0), twist in twists(), push in twists()) {
        assert_same_bits::<f64>(&pose, &twist, &push, f64::to_bits);
    }

    #[test]
    fn zero_corrections_keep_the_bits_in_f32(pose in poses(0.99, 3.0), twist in twists(), push in twists()) {
        assert_same_bits::<f32>(&pose, &twist, &push, |value| u64::from(value.to_bits()));
    }
}

fn motion(
    machine: &Machine,
    at: &CorrectedInverse<f64>,
    twist: &Twist<f64>,
    acceleration: &Acceleration<f64>,
) -> kinematics::PivotMotion<f64> {
    let (twist, acceleration) = in_platform_axes(&at.guides, twist, acceleration);
    corrected_pivot_motion(at, &machine.lines, &twist, &acceleration)
}

/// Angles and poses bit for bit; guides and rates as numbers, whose zeros have no sign.
fn assert_same_bits<T>(pose: &Pose<f64>, twist: &Twist<f64>, push: &Twist<f64>, bits: fn(T) -> u64)
where
    T: Real + CorrectedScalar<Correction = T>,
{
    let t = T::from_f64;
    let pose = Pose {
        x: t(pose.x),
        y: t(pose.y),
        theta: t(pose.theta),
    };
    let zero = Corrections::new(&[PivotCoefficients::IDEAL; 3], Series::<T>::new).expect("zeros");
    assert!(zero.are_zero());
    let ideal = inverse(&pose).expect("inside the track");
    let built = corrected_inverse(&pose, &zero).expect("inside the track");
    for i in 0..3 {
        assert_eq!(bits(built.encoders[i]), bits(ideal.pivots[i]));
    }
    assert_eq!(built.guides, ideal.guides);
    assert_eq!(built.encoder_slopes, [T::ZERO; 3]);
    let twist = Twist {
        x: t(twist.x),
        y: t(twist.y),
        theta: t(twist.theta),
    };
    let push = Acceleration {
        x: t(push.x),
        y: t(push.y),
        theta: t(push.theta),
    };
    let (seen, pushed) = in_platform_axes(&built.guides, &twist, &push);
    let motion = corrected_pivot_motion(&built, &zero.lines, &seen, &pushed);
    assert_eq!(motion, pivot_motion(&ideal.guides, &twist, &push));
    let back = corrected_direct::<T, _>(&ideal.pivots, &zero, 2).expect("a feasible pose");
    let plain = direct::<T>(&ideal.pivots).expect("a feasible pose");
    for (got, want) in [
        (back.x, plain.x),
        (back.y, plain.y),
        (back.theta, plain.theta),
    ] {
        assert_eq!(bits(got), bits(want));
    }
}

//! The centre of rotation in the tick: where the platform's centre is when another point of the platform is moved.

mod motion_bench;

use firmware::motion::{MAX_CENTRE_OFFSET, RotationCentre, Setpoint, SetpointScale, Stale};
use kinematics::{Acceleration, Twist};
use motion_bench::*;
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

/// Points of the platform, out to the furthest.
fn points() -> impl Strategy<Value = [f64; 2]> {
    (0.0..=0.999_999 * MAX_CENTRE_OFFSET, -PI..PI).prop_map(|(r, d)| [r * d.cos(), r * d.sin()])
}

fn centre(point: [f64; 2]) -> RotationCentre {
    RotationCentre::new(point).expect("near enough")
}

/// R(theta) p.
fn arm(point: [f64; 2], theta: f64) -> [f64; 2] {
    let (sin, cos) = theta.sin_cos();
    [
        point[0] * cos - point[1] * sin,
        point[0] * sin + point[1] * cos,
    ]
}

/// Radians of an angle in 2^-32 turns, whole turns dropped.
fn radians(units: i64) -> f64 {
    f64::from(units as i32) / UNIT * TAU
}

proptest! {
    #![proptest_config(settings(2_000))]

    #[test]
    fn another_point_does_not_move_the_platform(start in positions(1e4), chosen in proptest::collection::vec(points(), 1..6)) {
        let mut motion = follower();
        motion.rest_at(start);
        for point in chosen {
            prop_assert_eq!(motion.set_centre(centre(point)), Ok(()));
            prop_assert_eq!(motion.centre().to_platform(&motion.position()), start);
            prop_assert_eq!(motion.centre().from_platform(&start), motion.position());
        }
        prop_assert_eq!(motion.set_centre(RotationCentre::PLATFORM), Ok(()));
        prop_assert_eq!(motion.position(), start);
    }

    #[test]
    fn the_platform_is_where_the_point_asks_for_it(at in positions(1e4), point in points()) {
        let centre = centre(point);
        let arm = arm(centre.point(), radians(at[2]));
        let platform = centre.to_platform(&at);
        for i in 0..2 {
            let exact = at[i] as f64 - arm[i] * UNIT;
            // Two products with a sine and a cosine good to 1.7e-9, which is 7.3 units.
            prop_assert!((platform[i] as f64 - exact).abs() < 7.8, "{} units", platform[i] as f64 - exact);
        }
        prop_assert_eq!(platform[2], at[2]);
    }

    #[test]
    fn rates_of_the_platform_are_the_derivatives(
        at in positions(3.0), point in points(),
        v in [-3.0..3.0_f32, -3.0..3.0, -7.0..7.0], a in [-40.0..40.0_f32, -40.0..40.0, -130.0..130.0],
    ) {
        let setpoint = Setpoint {
            position: at,
            twist: Twist { x: v[0], y: v[1], theta: v[2] },
            acceleration: Acceleration { x: a[0], y: a[1], theta: a[2] },
        };
        let platform = centre(point).platform_setpoint(&setpoint);
        prop_assert_eq!(platform.position, centre(point).to_platform(&at));
        // The platform's centre as a function of time, differentiated numerically.
        let [v, a] = [v, a].map(|rates| rates.map(f64::from));
        let where_at = |t: f64| {
            let moved = |i: usize| v[i] * t + a[i] * t * t / 2.0;
            let arm = arm(point, radians(at[2]) + moved(2));
            [moved(0) - arm[0], moved(1) - arm[1]]
        };
        let h = 1e-4;
        let [before, now, after] = [where_at(-h), where_at(0.0), where_at(h)];
        let given = [(platform.twist.x, platform.acceleration.x), (platform.twist.y, platform.acceleration.y)];
        for i in 0..2 {
            let rate = (after[i] - before[i]) / (2.0 * h);
            let acceleration = (after[i] - 2.0 * now[i] + before[i]) / (h * h);
            prop_assert!((f64::from(given[i].0) - rate).abs() < 4.7e-6, "{} {rate}", given[i].0);
            prop_assert!((f64::from(given[i].1) - acceleration).abs() < 5.1e-5, "{} {acceleration}", given[i].1);
        }
        prop_assert_eq!(platform.twist.theta.to_bits(), setpoint.twist.theta.to_bits());
        prop_assert_eq!(platform.acceleration.theta.to_bits(), setpoint.acceleration.theta.to_bits());
    }
}

#[test]
fn the_platforms_own_centre_changes_nothing() {
    let setpoint = Setpoint {
        position: at(3.0, -4.0, 7.3),
        twist: Twist {
            x: 0.1,
            y: 0.2,
            theta: 0.3,
        },
        acceleration: Acceleration {
            x: 1.0,
            y: 2.0,
            theta: 3.0,
        },
    };
    assert_eq!(
        RotationCentre::PLATFORM.platform_setpoint(&setpoint),
        setpoint
    );
}

#[test]
fn a_point_out_of_reach_is_none() {
    assert!(RotationCentre::new([0.8, 0.7]).is_none());
    assert!(RotationCentre::new([f64::NAN, 0.0]).is_none());
    assert!(RotationCentre::new([0.8, 0.5]).is_some());
}

#[test]
fn in_motion_the_point_stays() {
    let (from, to) = (at(0.0, 0.0, 0.0), at(10.0, 5.0, 0.2));
    let mut motion = follower();
    motion.rest_at(from);
    motion.accept(&line(from, to)).expect("at rest");
    for _ in 0..10 {
        motion.advance();
    }
    let before = motion.setpoint(&SetpointScale::new(LIMITS.rate_hz));
    assert_eq!(motion.set_centre(centre([0.5, 0.0])), Err(Stale));
    assert_eq!(motion.setpoint(&SetpointScale::new(LIMITS.rate_hz)), before);
    assert_eq!(motion.centre(), RotationCentre::PLATFORM);
}

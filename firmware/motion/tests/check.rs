//! One plan of one piece for each thing that can be broken, and its twin that keeps it.

use core::f64::consts::TAU;
use kinematics::Geometry;
use motion::check::{BUDGET, PlanCheck, Violation};
use motion::plan::axis_state::AXIS_UNITS;
use motion::{AxisState, Constraints, Limits, Piece, Plan, PlanStart};

const CONSTRAINTS: Constraints = Constraints::new(Limits::REFERENCE, Geometry::REFERENCE);
const HZ: f64 = CONSTRAINTS.limits.rate_hz;

/// An axis at track radii or turns, with a rate and its derivative per second.
fn axis(at: f64, velocity: f64, acceleration: f64) -> AxisState {
    let units = f64::from(AXIS_UNITS);
    AxisState {
        position: (at * units) as i128,
        velocity: (velocity / HZ * units) as i64,
        acceleration: (acceleration / HZ / HZ * units) as i64 / 6 * 6,
    }
}

const STILL: AxisState = AxisState::at_rest(0);

/// A plan of one piece, with a jerk per second cubed.
fn plan(ticks: u64, jerk: [f64; 3]) -> Plan {
    let jerk = jerk.map(|jerk| (jerk / HZ.powi(3) * f64::from(AXIS_UNITS)) as i64 / 6 * 6);
    let mut plan = Plan {
        start: PlanStart::Rest([0; 3]),
        ..Plan::default()
    };
    plan.pieces.push(Piece { ticks, jerk }).unwrap();
    plan
}

fn check(plan: &Plan, start: &[AxisState; 3], constraints: &Constraints) -> Result<(), Violation> {
    PlanCheck::new(constraints, start).check(&plan.pieces, start, &mut { BUDGET })
}

#[test]
fn speed_is_limited_along_the_path() {
    // 1.2 and 1.5 track radii a second are 1.92, at 4 a second squared 1.99 in 17.5 ms and 2.04 in
    // 30 ms: 2 is the limit.
    let start = [axis(-0.2, 1.2, 2.4), axis(0.0, 1.5, 3.2), STILL];
    assert_eq!(check(&plan(350, [0.0; 3]), &start, &CONSTRAINTS), Ok(()));
    let broken = check(&plan(600, [0.0; 3]), &start, &CONSTRAINTS);
    assert_eq!(broken, Err(Violation::Speed));
}

#[test]
fn acceleration_and_jerk_are_limited() {
    // 40 track radii a second squared after 10 ms at the limit of jerk, 4,000.
    let start = [STILL; 3];
    assert_eq!(
        check(&plan(200, [4e3, 0.0, 0.0]), &start, &CONSTRAINTS),
        Ok(())
    );
    for (ticks, jerk) in [(220, [4e3, 0.0, 0.0]), (100, [0.0, 6e3, 0.0])] {
        let broken = check(&plan(ticks, jerk), &start, &CONSTRAINTS);
        assert!(
            matches!(broken, Err(Violation::Acceleration | Violation::Jerk)),
            "{broken:?}"
        );
    }
}

/// A start over a limit can only be left: what it has is the limit then.
#[test]
fn a_start_over_a_limit_may_go_on_but_not_further() {
    let start = [axis(0.0, 2.2, 0.0), STILL, STILL];
    assert_eq!(check(&plan(200, [0.0; 3]), &start, &CONSTRAINTS), Ok(()));
    let faster = [axis(0.0, 2.2, 4.0), STILL, STILL];
    assert!(matches!(
        check(&plan(400, [0.0; 3]), &faster, &CONSTRAINTS),
        Err(Violation::Speed)
    ));
}

/// Turning at 300 deg/s 70 mm out takes a pivot to (1 + 0.7) 5.236 = 8.90 rad/s, somewhere in a turn.
#[test]
fn the_pivots_rate_is_met_where_it_is_met() {
    let start = [axis(0.7, 0.0, 0.0), STILL, axis(0.0, 300.0 / 360.0, 0.0)];
    let turn = plan(24_000, [0.0; 3]);
    let with = |rate: f64| {
        let mut constraints = CONSTRAINTS;
        constraints.limits.pivot_rate_rad_s = rate;
        check(&turn, &start, &constraints)
    };
    assert_eq!(with(8.92), Ok(()));
    assert_eq!(with(8.7), Err(Violation::Pivots));
    // Sampled as thirty pieces of 14 deg, it is by so much.
    let pieces = [Piece {
        ticks: 800,
        jerk: [0; 3],
    }; 30];
    let [rate, _] = PlanCheck::new(&CONSTRAINTS, &start).pivot_parts(&pieces, &start);
    assert!((0.885..0.8902).contains(&rate), "{rate}");
    // A part of the turn that is far from there.
    let mut constraints = CONSTRAINTS;
    constraints.limits.pivot_rate_rad_s = 8.7;
    let some: Vec<u64> = (0..6).map(|sixth| sixth * 4_000).collect();
    let kept = some.iter().filter(|&&from| {
        let mut now = start;
        turn.pieces[0].advance(&mut now, from, &[0; 3]);
        check(&plan(1_000, [0.0; 3]), &now, &constraints).is_ok()
    });
    assert!(kept.count() >= 3);
}

/// Half a track radius out a steady turn alone takes theta'^2 d / c of acceleration, d up to 0.5.
#[test]
fn the_pivots_acceleration_is_met_too() {
    let start = [axis(0.5, 0.0, 0.0), STILL, axis(0.0, 5.0 / TAU, 0.0)];
    let turn = plan(25_000, [0.0; 3]);
    let with = |acceleration: f64| {
        let mut constraints = CONSTRAINTS;
        constraints.limits.pivot_acceleration_rad_s2 = acceleration;
        check(&turn, &start, &constraints)
    };
    let kept = (5..30).find(|&most| with(f64::from(most)).is_ok()).unwrap();
    let broken = with(f64::from(kept) * 0.9);
    assert_eq!(broken, Err(Violation::Pivots));
    assert!((5..25).contains(&kept), "{kept}");
}

#[test]
fn the_disk_is_kept_by_the_way() {
    let out = |x: f64| [axis(x, 1.0, 0.0), STILL, STILL];
    // 10 mm on.
    let way = plan(200, [0.0; 3]);
    assert_eq!(check(&way, &out(0.785), &CONSTRAINTS), Ok(()));
    let broken = check(&way, &out(0.795), &CONSTRAINTS);
    assert!(matches!(broken, Err(Violation::Disk)));
}

/// A stop has an acceleration and a jerk of its own, and a smooth one the ordinary limit of speed.
#[test]
fn a_stop_keeps_to_what_is_granted_it() {
    let start = [axis(0.0, 1.9, 60.0), STILL, STILL];
    let way = plan(100, [-8e3, 0.0, 0.0]);
    let stop = |urgent: bool| {
        PlanCheck::for_stop(&CONSTRAINTS, &start, urgent)
            .check(&way.pieces, &start, &mut { BUDGET })
    };
    assert_eq!(check(&way, &start, &CONSTRAINTS), Err(Violation::Jerk));
    assert_eq!(stop(false), Err(Violation::Speed));
    assert_eq!(stop(true), Ok(()));
}

#[test]
fn about_another_point_the_platforms_centre_counts() {
    let constraints = Constraints {
        rotation_centre: [0.5, 0.0],
        ..CONSTRAINTS
    };
    let turn = plan(20_000, [0.0; 3]);
    let turning = |x: f64| [axis(x, 0.0, 0.0), STILL, axis(0.0, 0.5, 0.0)];
    // Half a turn later it is as far from the point on the other side.
    assert_eq!(check(&turn, &turning(0.2), &constraints), Ok(()));
    let broken = check(&turn, &turning(0.35), &constraints);
    assert!(matches!(broken, Err(Violation::Disk)));
}

#[test]
fn bounds_are_kept_by_the_way() {
    let turns = |turns: f64| (turns * 4_294_967_296.0) as i64;
    let mut constraints = CONSTRAINTS;
    constraints.bounds[2] = [turns(-0.1), turns(0.1)];
    let turning = |theta: f64| [STILL, STILL, axis(theta, 0.5, 0.0)];
    let way = plan(400, [0.0; 3]);
    assert_eq!(check(&way, &turning(0.0), &constraints), Ok(()));
    assert_eq!(check(&way, &turning(0.085), &constraints), Ok(()));
    assert_eq!(
        check(&way, &turning(0.095), &constraints),
        Err(Violation::Bounds(2))
    );
}

/// What takes more looks than there are is not said to be kept.
#[test]
fn without_looks_left_it_fails() {
    let start = [axis(0.7, 0.0, 0.0), STILL, axis(0.0, 300.0 / 360.0, 0.0)];
    let mut constraints = CONSTRAINTS;
    constraints.limits.pivot_rate_rad_s = 8.7;
    let turn = plan(24_000, [0.0; 3]);
    let mut undecided = 0;
    for part in 0..12 {
        let mut now = start;
        turn.pieces[0].advance(&mut now, part * 2_000, &[0; 3]);
        let plan_check = PlanCheck::new(&constraints, &now);
        let part = [Piece {
            ticks: 2_000,
            jerk: [0; 3],
        }];
        let with = |mut budget: usize| plan_check.check(&part, &now, &mut budget).is_ok();
        assert!(with(60) || !with(1));
        undecided += usize::from(with(60) && !with(1));
    }
    assert!(undecided > 2, "{undecided}");
}

//! Jogging: constant velocities from any state, smooth stops before the edge, theta without end.

mod motion_bench;

use firmware::motion::{AxisState, PlanStart, Refusal, RetargetError, plan_jog};
use motion_bench::constraints::{Velocity, any_constraints, rest, velocities};
use motion_bench::exact::{Worst, ends_at_rest};
use motion_bench::random::Random;
use motion_bench::*;
use proptest::prelude::*;

/// Ticks of a velocity held that are looked at.
const SECOND: u64 = 20_000;

fn start(axes: &[AxisState; 3]) -> PlanStart {
    PlanStart::Rest(axes.map(|axis| axis.rounded()))
}

/// The velocity of a state in mm/s and deg/s.
fn speeds(axes: &[AxisState; 3]) -> Velocity {
    let [x, y, turns] = velocity(axes);
    [x * 100.0, y * 100.0, turns * 360.0]
}

fn is_near(a: &Velocity, b: &Velocity) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-4)
}

proptest! {
    #![proptest_config(settings(150))]

    #[test]
    fn from_rest_everything_is_kept_to_the_end(
        platform in positions(0.1), constraints in any_constraints(), velocity in velocities(),
    ) {
        let axes = rest(platform, &constraints);
        prop_assume!(axes.is_some());
        let axes = axes.unwrap();
        match plan_jog(3, start(&axes), &axes, &velocity, &constraints) {
            Ok(plan) => {
                let mut worst = Worst::default();
                let end = worst.walk_ends(&plan, &axes, &constraints, SECOND);
                prop_assert!(worst.is_kept(), "{worst:?}");
                prop_assert!(ends_at_rest(&plan, &end), "{end:?} {:?}", plan.end);
            }
            Err(RetargetError::Refused(Refusal::NoRoom)) => {}
            Err(RetargetError::Refused(Refusal::PivotRate { radius_mm })) => {
                let at = (platform[0] as f64).hypot(platform[1] as f64) / UNIT * 100.0;
                prop_assert!(at > radius_mm - 1e-3, "{at} {radius_mm}");
            }
            Err(other) => prop_assert!(false, "{other:?}"),
        }
    }

    #[test]
    fn from_a_jog_to_another_everything_is_kept(
        platform in positions(0.1), constraints in any_constraints(), one in velocities(), other in velocities(), part in 0.0..1.0_f64,
    ) {
        let axes = rest(platform, &constraints);
        prop_assume!(axes.is_some());
        let axes = axes.unwrap();
        let first = plan_jog(3, start(&axes), &axes, &one, &constraints);
        prop_assume!(first.is_ok());
        let first = first.unwrap();
        let tick = (part * first.ticks().min(6_000) as f64) as u64;
        let state = first.state_after(&axes, tick);
        let splice = PlanStart::Splice { plan: 3, tick };
        if let Ok(plan) = plan_jog(4, splice, &state, &other, &constraints) {
            let mut worst = Worst::default();
            let end = worst.walk_ends(&plan, &state, &constraints, SECOND);
            prop_assert!(worst.is_kept(), "{worst:?}");
            prop_assert!(ends_at_rest(&plan, &end), "{end:?} {:?}", plan.end);
        }
    }
}

/// Out of a line, or of another jog, at any tick.
#[test]
fn another_velocity_is_taken_in_motion() {
    let mut random = Random::new(20_260_405);
    let half = [
        LIMITS.speed_mm_s,
        LIMITS.speed_mm_s,
        LIMITS.turn_speed_deg_s,
    ];
    let velocity = |random: &mut Random| {
        half.map(|most| {
            let none = random.unit() < 1.0 / 3.0;
            let some = (random.unit() - 0.5) * most;
            if none { 0.0 } else { some }
        })
    };
    for (what, most) in [("a line", 0.02), ("a jog", 0.06)] {
        let (mut made, mut stops) = (0, 0);
        for _ in 0..3_000 {
            let [from, to] = [0; 2].map(|_| random.place(&CONSTRAINTS));
            let axes = at_rest(from);
            let plan = if what == "a line" {
                line(from, to)
            } else {
                match plan_jog(7, start(&axes), &axes, &velocity(&mut random), &CONSTRAINTS) {
                    Ok(plan) if plan.ticks() > 0 => plan,
                    _ => continue,
                }
            };
            let tick = (random.unit() * plan.ticks().min(6_000) as f64) as u64;
            let splice = PlanStart::Splice { plan: 7, tick };
            let state = plan.state_after(&axes, tick);
            match plan_jog(8, splice, &state, &velocity(&mut random), &CONSTRAINTS) {
                Ok(_) => made += 1,
                Err(RetargetError::NeedsStop) => stops += 1,
                Err(refused) => panic!("{refused:?}"),
            }
        }
        let part = f64::from(stops) / f64::from(made + stops);
        println!(
            "out of {what}: {made} and {stops} after a stop, {:.1} %",
            100.0 * part
        );
        assert!(made > 1_000 && part < most);
    }
}

#[test]
fn the_velocity_is_reached_and_kept() {
    let axes = at_rest(at(-20.0, 10.0, 0.3));
    for velocity in [[100.0, 0.0, 0.0], [30.0, -40.0, 90.0], [0.0, 0.0, -360.0]] {
        let plan = plan_jog(1, start(&axes), &axes, &velocity, &CONSTRAINTS).expect("room");
        let state = plan.state_after(&axes, 3_000);
        assert!(is_near(&speeds(&state), &velocity), "{:?}", speeds(&state));
        assert!(state.iter().all(|axis| axis.acceleration == 0));
    }
}

#[test]
fn all_axes_stop_just_before_the_edge() {
    let axes = at_rest(at(-20.0, 10.0, 0.3));
    let velocity = [150.0, 0.0, 45.0];
    let plan = plan_jog(1, start(&axes), &axes, &velocity, &CONSTRAINTS).expect("room");
    let mut worst = Worst::default();
    let end = worst.walk_ends(&plan, &axes, &CONSTRAINTS, SECOND);
    assert!(worst.is_kept() && ends_at_rest(&plan, &end), "{worst:?}");
    let [x, y] = [0, 1].map(|i| plan.end[i] as f64 / UNIT * 100.0);
    // A tick's way at most is given away, and what single precision costs.
    let edge = 80.0 - x.hypot(y);
    assert!((0.0..0.01).contains(&edge), "{edge} mm");
    assert!((y - 10.0).abs() < 1.03e-8);
    // What the point has gone, theta has turned.
    let turned = (plan.end[2] as f64 / UNIT - 0.3) * 360.0;
    assert!(
        (turned - (x + 20.0) / 150.0 * 45.0).abs() < 1e-5,
        "{turned}"
    );
}

#[test]
fn theta_turns_without_end_and_without_a_step() {
    const MOST: i64 = 1_000_000_000 << 32;
    for (from, turning) in [
        (0, 360.0),
        (0, -0.01),
        (MOST - (1 << 36), -360.0),
        (-MOST + (1 << 36), 1.0),
    ] {
        let axes = at_rest([0, 0, from]);
        let plan =
            plan_jog(1, start(&axes), &axes, &[0.0, 0.0, turning], &CONSTRAINTS).expect("room");
        // Thirty years.
        let lifetime = 30 * 365 * 86_400 * 20_000;
        assert!(plan.ticks() > lifetime, "{} ticks", plan.ticks());
        // The tick's own steps, beginning wherever: the same as the plan's, and all of one size.
        let mut motion = follower();
        motion.rest_at([0, 0, from]);
        motion.accept(&plan).expect("at rest");
        for _ in 0..4_000 {
            motion.advance();
        }
        let mut last = motion.position()[2];
        let step = turning / 360.0 / 20_000.0 * UNIT;
        for tick in 4_001..=8_000 {
            motion.advance();
            let now = motion.position()[2];
            assert!(((now - last) as f64 - step).abs() < 1.0 + step.abs() * 1e-6);
            assert_eq!(now, plan.state_after(&axes, tick)[2].rounded());
            last = now;
        }
        let late = plan.state_after(&axes, lifetime);
        assert_eq!(late[2].acceleration, 0);
        assert_eq!(late[2].velocity, plan.state_after(&axes, 8_000)[2].velocity);
    }
}

#[test]
fn at_the_largest_count_theta_stops_smoothly() {
    const MOST: i64 = 1_000_000_000 << 32;
    for sign in [1, -1] {
        let axes = at_rest([0, 0, sign * (MOST - (3 << 32))]);
        let velocity = [0.0, 0.0, sign as f64 * 360.0];
        let plan = plan_jog(1, start(&axes), &axes, &velocity, &CONSTRAINTS).expect("room");
        let mut worst = Worst::default();
        let end = worst.walk_ends(&plan, &axes, &CONSTRAINTS, SECOND);
        assert!(worst.is_kept(), "{worst:?}");
        let left = MOST - plan.end[2] * sign;
        assert!((0..1 << 24).contains(&left), "{left}");
        assert!(ends_at_rest(&plan, &end));
    }
}

#[test]
fn near_the_edge_a_lower_velocity_is_taken_and_at_it_none() {
    let axes = at_rest(at(79.0, 0.0, 0.0));
    let plan = plan_jog(1, start(&axes), &axes, &[200.0, 0.0, 0.0], &CONSTRAINTS).expect("1 mm");
    let end = plan.end[0] as f64 / UNIT * 100.0;
    assert!((79.7..80.0).contains(&end), "{end}");
    let axes = at_rest(at(80.0, 0.0, 0.0));
    let jog = |velocity: Velocity| plan_jog(1, start(&axes), &axes, &velocity, &CONSTRAINTS);
    assert_eq!(
        jog([200.0, 0.0, 0.0]).err(),
        Some(RetargetError::Refused(Refusal::NoRoom))
    );
    assert!(
        jog([-200.0, 0.0, 0.0]).is_ok(),
        "inwards there is all the way"
    );
    let turning = jog([200.0, 0.0, 90.0]).expect("theta can");
    assert_eq!(turning.state_after(&axes, 100_000)[0], axes[0]);
}

#[test]
fn no_velocity_at_rest_is_no_motion() {
    let axes = at_rest(at(79.0, 0.0, 0.0));
    let plan = plan_jog(1, start(&axes), &axes, &[0.0; 3], &CONSTRAINTS).expect("nothing to do");
    assert_eq!(
        (plan.ticks(), plan.state_after(&axes, 5)),
        (plan.ticks(), axes)
    );
    assert_eq!(plan.end, axes.map(|axis| axis.rounded()));
}

#[test]
fn velocities_that_can_not_be_are_refused() {
    let axes = at_rest(at(70.0, 0.0, 0.0));
    let refusal =
        |velocity: Velocity| plan_jog(1, start(&axes), &axes, &velocity, &CONSTRAINTS).err();
    let velocity = Some(RetargetError::Refused(Refusal::Velocity));
    assert_eq!(refusal([200.1, 0.0, 0.0]), velocity);
    assert_eq!(refusal([150.0, 150.0, 0.0]), velocity);
    assert_eq!(refusal([0.0, 0.0, -361.0]), velocity);
    assert_eq!(refusal([0.0, f64::NAN, 0.0]), velocity);
    // At 70 mm a turn a second takes a pivot to 2 pi (1 + 0.7) = 10.7 rad/s.
    let Some(RetargetError::Refused(Refusal::PivotRate { radius_mm })) = refusal([0.0, 0.0, 360.0])
    else {
        panic!("the pivots can not");
    };
    assert!((radius_mm - 59.15).abs() < 5.4e-3, "{radius_mm}");
    assert!(refusal([0.0, 0.0, 300.0]).is_none());
}

//! Following a plan tick by tick: exact arrival, continuity, what is accepted and what is stale.

mod motion_bench;

use firmware::motion::{LoneFollower, Plan, PlanStart, SetpointScale, Stale, Stop, plan_stop};
use motion_bench::*;
use proptest::prelude::*;

fn started(plan: &Plan) -> LoneFollower<'static> {
    let PlanStart::Rest(from) = plan.start else {
        panic!("a line starts at rest");
    };
    let mut motion = follower();
    motion.rest_at(from);
    assert_eq!(motion.accept(plan), Ok(()));
    motion
}

proptest! {
    #![proptest_config(settings(60))]

    #[test]
    fn every_tick_is_the_plan_to_the_bit((from, to) in moves()) {
        let plan = line(from, to);
        let scale = SetpointScale::new(LIMITS.rate_hz);
        let mut motion = started(&plan);
        for tick in 1..=plan.ticks() {
            motion.advance();
            let state = plan.state_after(&at_rest(from), tick);
            prop_assert_eq!(motion.position(), state.map(|axis| axis.rounded()), "tick {}", tick);
            let setpoint = motion.setpoint(&scale);
            let [x, y, turns] = velocity(&state);
            let twist = setpoint.twist;
            // Rates are cut to 2^-40 a tick (1.8e-8 track radii a second) and held in an f32.
            for (exact, given) in [(x, twist.x), (y, twist.y), (turns, twist.theta / std::f32::consts::TAU)] {
                prop_assert!((exact - f64::from(given)).abs() < 2e-8 + 3e-7 * exact.abs());
            }
            prop_assert_eq!(motion.is_moving(), tick < plan.ticks());
            prop_assert_eq!(motion.progress(), (plan.id, tick));
        }
        prop_assert_eq!(motion.position(), to);
        let end = motion.setpoint(&scale);
        prop_assert_eq!((end.twist, end.acceleration), Default::default());
        motion.advance();
        prop_assert_eq!(motion.position(), to);
    }

    #[test]
    fn steps_agree_with_the_rates_given_to_the_servo((from, to) in moves()) {
        let plan = line(from, to);
        let scale = SetpointScale::new(LIMITS.rate_hz);
        let mut motion = started(&plan);
        let mut before = motion.setpoint(&scale);
        while motion.is_moving() {
            motion.advance();
            let now = motion.setpoint(&scale);
            let step = [0, 1, 2].map(|i| (now.position[i] - before.position[i]) as f64);
            let rate = |a: f32, b: f32| f64::from(a + b) / 2.0 / LIMITS.rate_hz * UNIT;
            let rates = [
                rate(before.twist.x, now.twist.x),
                rate(before.twist.y, now.twist.y),
                rate(before.twist.theta, now.twist.theta) / std::f64::consts::TAU,
            ];
            for (step, rate) in step.iter().zip(rates) {
                // Rounding to units at both ends; the jerk's part of a step is under one at the highest jerk.
                prop_assert!((step - rate).abs() < 1.29, "{step} units in a tick, {rate} by the rates");
            }
            before = now;
        }
    }

    #[test]
    fn a_stop_takes_over_without_a_seam((from, to) in moves(), fraction in 0.0..1.0_f64, ahead in 0..200_u64) {
        let plan = line(from, to);
        let at = (fraction * plan.ticks() as f64) as u64;
        let stop = plan_stop(8, &plan, &at_rest(from), at, &CONSTRAINTS, Stop::Urgent);
        prop_assume!(stop.is_some());
        let stop = stop.unwrap();
        let mut motion = started(&plan);
        for _ in 0..at.saturating_sub(ahead) {
            motion.advance();
        }
        prop_assert_eq!(motion.accept(&stop), Ok(()));
        let seam = plan.state_after(&at_rest(from), at);
        for tick in at.saturating_sub(ahead) + 1..=at + stop.ticks() {
            motion.advance();
            let expected = if tick <= at {
                plan.state_after(&at_rest(from), tick)
            } else {
                stop.state_after(&seam, tick - at)
            };
            prop_assert_eq!(motion.position(), expected.map(|axis| axis.rounded()), "tick {}", tick);
        }
        prop_assert!(!motion.is_moving());
        prop_assert_eq!(motion.position(), stop.end);
    }
}

#[test]
fn plans_that_do_not_start_where_the_motion_is_are_stale() {
    let (from, to) = (at(0.0, 0.0, 0.0), at(10.0, 5.0, 0.2));
    let plan = line(from, to);
    let splice = |tick| plan_stop(8, &plan, &at_rest(from), tick, &CONSTRAINTS, Stop::Smooth);
    let splice = |tick| splice(tick).expect("far from the end");
    let mut motion = follower();
    motion.rest_at(to);
    assert_eq!(motion.accept(&plan), Err(Stale), "starts elsewhere");
    assert_eq!(motion.accept(&splice(100)), Err(Stale), "nothing to leave");
    assert!(!motion.is_moving() && motion.position() == to);

    let mut motion = started(&plan);
    for _ in 0..100 {
        motion.advance();
    }
    let other = Plan {
        start: PlanStart::Splice {
            plan: 99,
            tick: 200,
        },
        ..splice(200)
    };
    assert_eq!(motion.accept(&other), Err(Stale), "leaves another plan");
    assert_eq!(motion.accept(&splice(99)), Err(Stale), "its tick is past");
    assert_eq!(
        motion.accept(&line(motion.position(), from)),
        Err(Stale),
        "not at rest"
    );
    // Refused plans have changed nothing.
    for tick in 101..=plan.ticks() {
        motion.advance();
        assert_eq!(
            motion.position(),
            plan.state_after(&at_rest(from), tick)
                .map(|axis| axis.rounded())
        );
    }
    assert_eq!(motion.position(), to);
}

#[test]
fn the_tick_of_a_splice_may_be_this_one() {
    let from = at(0.0, 0.0, 0.0);
    let plan = line(from, at(10.0, 5.0, 0.2));
    let stop = plan_stop(8, &plan, &at_rest(from), 100, &CONSTRAINTS, Stop::Smooth).unwrap();
    let mut motion = started(&plan);
    for _ in 0..100 {
        motion.advance();
    }
    assert_eq!(motion.accept(&stop), Ok(()));
    for _ in 0..stop.ticks() {
        assert!(motion.is_moving());
        motion.advance();
    }
    assert_eq!((motion.is_moving(), motion.position()), (false, stop.end));
    assert_eq!(motion.progress(), (8, stop.ticks()));
}

#[test]
fn a_later_stop_replaces_an_accepted_one() {
    let from = at(0.0, 0.0, 0.0);
    let plan = line(from, at(60.0, 5.0, 0.2));
    let stop = |at, how| plan_stop(8, &plan, &at_rest(from), at, &CONSTRAINTS, how).unwrap();
    let mut motion = started(&plan);
    assert_eq!(motion.accept(&stop(5_000, Stop::Smooth)), Ok(()));
    let urgent = stop(3_000, Stop::Urgent);
    assert_eq!(motion.accept(&urgent), Ok(()));
    for _ in 0..3_000 + urgent.ticks() {
        motion.advance();
    }
    assert_eq!((motion.is_moving(), motion.position()), (false, urgent.end));
}

#[test]
fn a_plan_without_a_way_is_over_at_once() {
    let here = at(3.0, 4.0, 0.5);
    let mut motion = started(&line(here, here));
    motion.advance();
    assert_eq!((motion.is_moving(), motion.position()), (false, here));
    // And the next is taken as usual.
    let next = line(here, at(0.0, 0.0, 0.0));
    assert_eq!(motion.accept(&next), Ok(()));
    for _ in 0..next.ticks() {
        motion.advance();
    }
    assert_eq!((motion.is_moving(), motion.position()), (false, next.end));
}

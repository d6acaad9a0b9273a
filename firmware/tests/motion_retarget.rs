//! Retargets in motion: random tours of targets, each left at any tick.

mod motion_bench;

use firmware::motion::plan::axis_state::TickIncrement;
use firmware::motion::{
    AxisState, Constraints, Effort, Plan, Position, RetargetError, Stop, plan_retarget, plan_stop,
};
use motion_bench::exact::{Worst, ends_at_rest};
use motion_bench::*;
use proptest::prelude::*;
use proptest::strategy::ValueTree;

fn retarget(
    of: &Plan,
    from: &[AxisState; 3],
    at: u64,
    to: Position,
) -> Result<Plan, RetargetError> {
    plan_retarget(of.id + 1, of, from, at, to, &CONSTRAINTS, Effort::ALL)
}

/// A line and further targets, each with the part of the motion before after which it comes.
fn tours() -> impl Strategy<Value = ((Position, Position), Vec<(Position, f64)>)> {
    (
        (positions(2.0), positions(2.0)),
        prop::collection::vec((positions(2.0), 0.0..1.0_f64), 1..4),
    )
}

/// Everything a plan that is followed from `start` has to keep, tick by tick.
fn keeps_the_law(plan: &Plan, start: [AxisState; 3]) -> Result<(), TestCaseError> {
    let mut worst = Worst::default();
    let end = worst.walk(plan, &start, &CONSTRAINTS);
    prop_assert!(
        worst.is_kept_but_for_a_thousandth(),
        "{worst:?} {start:?} {plan:?}"
    );
    prop_assert!(ends_at_rest(plan, &end), "{end:?} {plan:?}");
    Ok(())
}

proptest! {
    #![proptest_config(settings(150))]

    #[test]
    fn tours_keep_the_law(((from, to), targets) in tours()) {
        let mut plan = line(from, to);
        let mut start = at_rest(from);
        for (to, part) in targets {
            let at = (part * plan.ticks() as f64) as u64;
            match retarget(&plan, &start, at, to) {
                Ok(next) => {
                    start = plan.state_after(&start, at);
                    keeps_the_law(&next, start)?;
                    prop_assert_eq!(next.end, to);
                    plan = next;
                }
                Err(RetargetError::NeedsStop) => {}
                Err(refused) => prop_assert!(false, "{:?}", refused),
            }
        }
    }
}

proptest! {
    #![proptest_config(settings(100))]

    /// Along the rim, a little inwards or outwards: curves that bulge.
    #[test]
    fn along_the_rim_the_disk_is_kept(angles in prop::array::uniform3(0.2..1.2_f64), radii in prop::array::uniform3(76.0..80.0_f64), part in 0.0..1.0_f64) {
        let mut angle = 0.0;
        let [from, to, other] = [0, 1, 2].map(|i| {
            angle += angles[i];
            at(radii[i] * angle.cos(), radii[i] * angle.sin(), 0.0)
        });
        let (plan, start) = (line(from, to), at_rest(from));
        let leave = (part * plan.ticks() as f64) as u64;
        if let Ok(next) = retarget(&plan, &start, leave, other) {
            keeps_the_law(&next, plan.state_after(&start, leave))?;
        }
    }
}

/// The setpoint of a tour in the very code of the tick: no position, velocity or acceleration is ever off what the
/// integers of one plan after the other give.
#[test]
fn the_tick_follows_a_tour_without_a_step() {
    let from = at(-50.0, 10.0, 0.2);
    let mut plan = line(from, at(60.0, 20.0, 1.0));
    let mut start = at_rest(from);
    let mut motion = follower();
    motion.rest_at(from);
    motion.accept(&plan).unwrap();
    let scale = firmware::motion::SetpointScale::new(LIMITS.rate_hz);
    let mut random = 1_u64;
    for round in 0..40 {
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(round);
        let part = (random >> 40) as f64 / (1 << 24) as f64;
        let angle = part * 60.0;
        let to = at(40.0 * angle.cos(), 40.0 * angle.sin(), part * 4.0 - 2.0);
        let leave = 1 + (part * 0.8 * plan.ticks() as f64) as u64;
        let next = match retarget(&plan, &start, leave, to) {
            Ok(next) => next,
            Err(_) => match plan_stop(
                plan.id + 1,
                &plan,
                &start,
                leave,
                &CONSTRAINTS,
                Stop::Smooth,
            ) {
                Some(stop) => stop,
                None => continue,
            },
        };
        for tick in 1..=leave {
            motion.advance();
            if tick == 1 {
                motion.accept(&next).unwrap();
            }
            let expected = plan.state_after(&start, tick).map(|axis| axis.rounded());
            assert_eq!(motion.setpoint(&scale).position, expected);
        }
        start = plan.state_after(&start, leave);
        // The first tick of the new plan goes on from the last state of the old one, to the bit.
        let jerk = next.pieces[0].jerk;
        let mut one = start;
        for i in 0..3 {
            one[i].advance(&TickIncrement::new(jerk[i], next.nudge[i]));
        }
        assert_eq!(next.state_after(&start, 1), one);
        plan = next;
    }
    for _ in 0..plan.ticks() {
        motion.advance();
    }
    assert!(!motion.is_moving());
    assert_eq!(motion.position(), plan.end);
}

/// How good transitions are: where one is planned it is faster than stopping first, but for what an estimate of the
/// line is off. Most of those that are not planned would not be.
#[test]
fn a_transition_is_the_rule_and_saves_time() {
    for (turns, most_refused) in [(2.0, 200), (0.02, 230)] {
        let (ratios, refused) = durations_with_a_stop_for_one(turns);
        let at = |part: f64| ratios[((ratios.len() - 1) as f64 * part) as usize];
        println!(
            "within {turns} turns: {} transitions, {refused} stops first; of the duration with a stop: least {:.3}, 5 % {:.3}, median {:.3}, 95 % {:.3}, most {:.3}",
            ratios.len(),
            at(0.0),
            at(0.05),
            at(0.5),
            at(0.95),
            at(1.0),
        );
        assert!(refused < most_refused, "{refused}");
        assert!(at(1.0) < 1.15, "{}", at(1.0));
        assert!(at(0.5) < 0.99, "{}", at(0.5));
    }
}

/// Durations of transitions over those of a stop and a line, sorted, and how many needed a stop.
fn durations_with_a_stop_for_one(turns: f64) -> (Vec<f64>, usize) {
    let mut runner = proptest::test_runner::TestRunner::new(settings(1));
    let three = prop::array::uniform3(positions(turns));
    let (mut ratios, mut refused) = (Vec::new(), 0);
    for _ in 0..1_000 {
        let [from, to, other] = three.new_tree(&mut runner).unwrap().current();
        let leave = (0.0..1.0_f64).new_tree(&mut runner).unwrap().current();
        let (plan, start) = (line(from, to), at_rest(from));
        let leave = (leave * plan.ticks() as f64) as u64;
        let Ok(next) = retarget(&plan, &start, leave, other) else {
            refused += 1;
            continue;
        };
        let (rest, ticks) = match plan_stop(8, &plan, &start, leave, &CONSTRAINTS, Stop::Smooth) {
            Some(stop) => (stop.end, stop.ticks()),
            None => (plan.end, plan.ticks() - leave),
        };
        ratios.push(next.ticks() as f64 / (ticks + line(rest, other).ticks()) as f64);
    }
    ratios.sort_by(f64::total_cmp);
    (ratios, refused)
}

#[test]
fn a_target_outside_is_refused_with_the_reason() {
    let from = at(-50.0, 0.0, 0.0);
    let plan = line(from, at(50.0, 0.0, 0.0));
    let result = retarget(&plan, &at_rest(from), 3_000, at(70.0, 70.0, 0.0));
    assert!(
        matches!(
            result,
            Err(RetargetError::Refused(
                firmware::motion::Refusal::OutsideDisk
            ))
        ),
        "{result:?}"
    );
}

/// At full speed towards the rim, a target aside would be reached by a curve beyond it.
#[test]
fn near_the_rim_and_the_bounds_it_needs_a_stop() {
    let from = at(-70.0, 0.0, 0.0);
    let plan = line(from, at(80.0, 0.0, 0.0));
    let late = plan.ticks() - 1_000;
    let result = retarget(&plan, &at_rest(from), late, at(70.0, 30.0, 0.0));
    assert_eq!(result, Err(RetargetError::NeedsStop));
    let x = |mm: f64| (mm / GEOMETRY.radius_mm * UNIT) as i64;
    let plan_within = |highest: f64| {
        let bounds = [
            [x(-80.0), x(highest)],
            [x(-80.0), x(80.0)],
            [i64::MIN, i64::MAX],
        ];
        let middle = plan.ticks() / 2;
        let back = at(-20.0, 30.0, 0.0);
        plan_retarget(
            8,
            &plan,
            &at_rest(from),
            middle,
            back,
            &Constraints {
                bounds,
                ..CONSTRAINTS
            },
            Effort::ALL,
        )
    };
    assert!(plan_within(30.0).is_ok());
    assert_eq!(plan_within(6.0), Err(RetargetError::NeedsStop));
}

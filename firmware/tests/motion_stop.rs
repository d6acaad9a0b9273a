//! Stops at any tick of a line: at rest, on the line, within the limits.

mod motion_bench;

use firmware::motion::{Plan, PlanStart, Position, Stop, plan_jog, plan_line, plan_stop};
use motion_bench::constraints::{any_constraints, rest, velocities};
use motion_bench::exact::{Worst, ends_at_rest};
use motion_bench::*;
use proptest::prelude::*;

fn stop(of: &Plan, from: Position, at: u64, how: Stop) -> Option<Plan> {
    plan_stop(8, of, &at_rest(from), at, &CONSTRAINTS, how)
}

/// A move, and a tick of it: at which it can be stopped, unless the plan comes to rest as soon.
fn moves_under_way() -> impl Strategy<Value = (Position, Position, Plan, u64)> {
    (moves(), 0.0..1.0_f64).prop_map(|((from, to), fraction)| {
        let plan = line(from, to);
        let at = (fraction * plan.ticks() as f64) as u64;
        (from, to, plan, at)
    })
}

proptest! {
    #![proptest_config(settings(600))]

    #[test]
    fn ends_at_rest_on_the_line_and_not_beyond_its_end((from, to, plan, at) in moves_under_way()) {
        let seam = plan.state_after(&at_rest(from), at);
        for how in [Stop::Smooth, Stop::Urgent] {
            let Some(stop) = stop(&plan, from, at, how) else { continue };
            let all = corners(&stop, seam);
            for axes in &all {
                prop_assert!(off_line(axes, &from, &to) < 0.064, "{}", off_line(axes, &from, &to));
            }
            let last = all.last().unwrap();
            for i in 0..3 {
                // What is dropped at the end: the fraction of a unit, and a speed under 4e-6 units a tick.
                prop_assert_eq!(last[i].rounded(), stop.end[i]);
                prop_assert!(last[i].velocity.unsigned_abs() < 1 << 22, "{} {}", i, last[i].velocity);
                prop_assert!(last[i].acceleration.unsigned_abs() < 1_360);
                let (least, most) = (from[i].min(to[i]), from[i].max(to[i]));
                prop_assert!((least - 1..=most + 1).contains(&stop.end[i]), "beyond by {}", (stop.end[i] - most).max(least - stop.end[i]));
            }
        }
    }

    #[test]
    fn smooth_keeps_the_limits_and_the_pivots((from, _, plan, at) in moves_under_way()) {
        let Some(stop) = stop(&plan, from, at, Stop::Smooth) else { return Ok(()) };
        let worst = Worst::of_corners(&stop, plan.state_after(&at_rest(from), at));
        prop_assert!(worst.is_kept(), "{worst:?}");
    }

    #[test]
    fn urgent_is_as_hard_as_the_pivots_can_follow_and_not_longer((from, _, plan, at) in moves_under_way()) {
        let Some(urgent) = stop(&plan, from, at, Stop::Urgent) else { return Ok(()) };
        let mut worst = Worst::default();
        worst.walk(&urgent, &plan.state_after(&at_rest(from), at), &CONSTRAINTS);
        prop_assert!(worst.jerk <= LIMITS.stop_factor.powi(2) * SLACK, "{worst:?}");
        prop_assert!(worst.outside <= 1e-6 && worst.pivot_rate <= 1.001 && worst.pivot_acceleration <= 1.001, "{worst:?}");
        // Without a smooth stop the plan itself is as soon.
        let smooth = stop(&plan, from, at, Stop::Smooth).map_or(plan.ticks() - at, |stop| stop.ticks());
        prop_assert!(urgent.ticks() <= smooth);
    }

    #[test]
    fn comes_sooner_than_the_end_or_there_is_none((from, _, plan, at) in moves_under_way()) {
        // Until its jerk turns against the motion, a line is on its way to higher speed.
        let first = plan.pieces.first().map_or([0; 3], |piece| piece.jerk);
        let against = |jerk: &[i64; 3]| (0..3).any(|i| jerk[i] != 0 && jerk[i].signum() == -first[i].signum());
        let speeding_up: u64 = plan.pieces.iter().take_while(|piece| !against(&piece.jerk)).map(|piece| piece.ticks).sum();
        let left = plan.ticks() - at;
        for how in [Stop::Smooth, Stop::Urgent] {
            match stop(&plan, from, at, how) {
                Some(stop) => prop_assert!(stop.ticks() < left),
                None => prop_assert!(at + 3 >= speeding_up, "none at {at}, {how:?}"),
            }
        }
    }

    #[test]
    fn there_is_none_at_the_end((from, to) in moves(), late in 0..1_000_u64) {
        let plan = line(from, to);
        for at in [plan.ticks(), plan.ticks() + late] {
            prop_assert_eq!(stop(&plan, from, at, Stop::Urgent), None);
        }
    }

    /// There and back: in the instant between, at rest, a stop is one all the same.
    #[test]
    fn in_an_instant_of_rest_the_stage_stays_there((from, to) in moves()) {
        let (there, back) = (line(from, to), line(to, from));
        prop_assume!(there.pieces.len() + back.pieces.len() <= 32 && there.ticks() > 0);
        let mut plan = there.clone();
        plan.pieces.extend(back.pieces.iter().copied());
        plan.end = back.end;
        for how in [Stop::Smooth, Stop::Urgent] {
            let stop = stop(&plan, from, there.ticks(), how).expect("a stop");
            prop_assert!(stop.ticks() <= 3);
            for (end, to) in stop.end.iter().zip(to) {
                prop_assert!(end.abs_diff(to) <= 1, "{end} {to}");
            }
        }
    }
}

proptest! {
    #![proptest_config(settings(12_000))]

    /// Out of lines and of jogs that end at an edge or a bound, with strong and weak drives, about any point.
    #[test]
    fn under_any_constraints_pivots_and_workspace_are_kept(
        platform in positions(0.3), target in positions(0.3), constraints in any_constraints(), velocity in velocities(), [jogs, late] in any::<[bool; 2]>(), part in 0.0..1.0_f64,
    ) {
        let [from, to] = [platform, target].map(|platform| rest(platform, &constraints));
        let (Some(from), Some(to)) = (from, to) else { return Ok(()) };
        let to = to.map(|axis| axis.rounded());
        let at_start = from.map(|axis| axis.rounded());
        let plan = if jogs {
            plan_jog(7, PlanStart::Rest(at_start), &from, &velocity, &constraints).ok()
        } else {
            plan_line(7, at_start, to, &constraints).ok()
        };
        let Some(plan) = plan else { return Ok(()) };
        // Anywhere, or in the last 40 ms: there an axis may brake to an edge while theta goes on.
        let ticks = plan.ticks();
        let at = if late && ticks < 1 << 24 {
            ticks.saturating_sub((part * 800.0) as u64)
        } else {
            (part * ticks.min(60_000) as f64) as u64
        };
        let seam = plan.state_after(&from, at);
        for how in [Stop::Smooth, Stop::Urgent] {
            let Some(stop) = plan_stop(8, &plan, &from, at, &constraints, how) else { continue };
            let mut worst = Worst::default();
            let end = worst.walk(&stop, &seam, &constraints);
            let kept = worst.pivot_rate.max(worst.pivot_acceleration) <= 1.001 && worst.is_inside();
            prop_assert!(kept && ends_at_rest(&stop, &end), "{how:?} {worst:?} {stop:?} {constraints:?}");
        }
    }
}

#[test]
fn from_full_speed_a_stop_takes_what_the_limits_ask() {
    let (from, to) = (at(-70.0, 0.0, 0.0), at(70.0, 0.0, 0.0));
    let plan = line(from, to);
    let way = |how| {
        let stop = stop(&plan, from, plan.ticks() / 2, how).unwrap();
        let start = plan.state_after(&at_rest(from), plan.ticks() / 2)[0].rounded();
        (
            stop.ticks(),
            (stop.end[0] - start) as f64 / UNIT * GEOMETRY.radius_mm,
        )
    };
    // 200 mm/s at 4 m/s^2 and 400 m/s^3: 50 ms and 10 ms, 6 mm. Urgent: the pivots allow 28 m/s^2 here, more than
    // the 17.9 m/s^2 that 1,600 m/s^3 lead to; 2 sqrt(v / j) = 22.4 ms, 2.24 mm.
    let (ticks, mm) = way(Stop::Smooth);
    assert!(ticks == 1_200 && (mm - 6.0).abs() < 6.2e-9, "{ticks} {mm}");
    let (ticks, mm) = way(Stop::Urgent);
    assert!(ticks == 448 && (mm - 2.24).abs() < 1.5e-8, "{ticks} {mm}");
}

//! Stops at any tick of a line: at rest, on the line, within the limits.

mod motion_bench;

use firmware::motion::{Plan, Position, Stop, plan_stop};
use motion_bench::*;
use proptest::prelude::*;

fn stop(of: &Plan, from: Position, at: u64, how: Stop) -> Option<Plan> {
    plan_stop(8, of, &at_rest(from), at, &LIMITS, &GEOMETRY, how)
}

/// A move, and a tick of it at which it can be stopped.
fn moves_under_way() -> impl Strategy<Value = (Position, Position, Plan, u64)> {
    (moves(), 0.0..1.0_f64).prop_filter_map("no tick to stop at", |((from, to), fraction)| {
        let plan = line(from, to);
        let stoppable = plan.ticks() - plan.pieces.last()?.ticks;
        (stoppable > 1).then(|| {
            (
                from,
                to,
                plan,
                1 + (fraction * (stoppable - 1) as f64) as u64,
            )
        })
    })
}

proptest! {
    #![proptest_config(settings(600))]

    #[test]
    fn ends_at_rest_on_the_line_and_not_beyond_its_end((from, to, plan, at) in moves_under_way()) {
        let seam = plan.state_after(&at_rest(from), at);
        for how in [Stop::Smooth, Stop::Urgent] {
            let stop = stop(&plan, from, at, how).expect("a tick to stop at");
            let all = corners(&stop, seam);
            for axes in &all {
                prop_assert!(off_line(axes, &from, &to) < 1.0, "{}", off_line(axes, &from, &to));
            }
            let last = all.last().unwrap();
            for i in 0..3 {
                // What is dropped at the end: the fraction of a unit, and a speed under 1e-6 units a tick.
                prop_assert_eq!(last[i].rounded(), stop.end[i]);
                prop_assert!(last[i].velocity.unsigned_abs() < 1 << 20, "{} {}", i, last[i].velocity);
                prop_assert!(last[i].acceleration.unsigned_abs() < 1 << 20);
                let (least, most) = (from[i].min(to[i]), from[i].max(to[i]));
                prop_assert!((least - 1..=most + 1).contains(&stop.end[i]), "beyond by {}", (stop.end[i] - most).max(least - stop.end[i]));
            }
        }
    }

    #[test]
    fn smooth_keeps_the_limits((from, _, plan, at) in moves_under_way()) {
        let stop = stop(&plan, from, at, Stop::Smooth).expect("a tick to stop at");
        let worst = worst_shares(&stop, plan.state_after(&at_rest(from), at));
        prop_assert!(worst.iter().all(|&share| share <= SLACK), "{worst:?}");
    }

    #[test]
    fn urgent_keeps_its_own_and_is_not_longer((from, _, plan, at) in moves_under_way()) {
        let urgent = stop(&plan, from, at, Stop::Urgent).expect("a tick to stop at");
        let smooth = stop(&plan, from, at, Stop::Smooth).expect("a tick to stop at");
        let factor = LIMITS.stop_factor;
        let worst = worst_shares(&urgent, plan.state_after(&at_rest(from), at));
        prop_assert!(worst[0] <= SLACK && worst[1] <= factor * SLACK && worst[2] <= factor * factor * SLACK, "{worst:?}");
        prop_assert!(urgent.ticks() <= smooth.ticks());
    }

    #[test]
    fn pivots_keep_their_rate((from, _, plan, at) in moves_under_way()) {
        let seam = plan.state_after(&at_rest(from), at);
        let stop = stop(&plan, from, at, Stop::Smooth).expect("a tick to stop at");
        for axes in corners(&stop, seam) {
            prop_assert!(pivot_rate(&axes) <= LIMITS.pivot_rate_rad_s * SLACK);
        }
    }

    #[test]
    fn none_only_in_the_last_segment((from, to) in moves(), fraction in 0.0..1.0_f64) {
        let plan = line(from, to);
        prop_assume!(!plan.pieces.is_empty());
        let at = (fraction * plan.ticks() as f64) as u64;
        let stoppable = plan.ticks() - plan.pieces.last().unwrap().ticks;
        prop_assert_eq!(stop(&plan, from, at, Stop::Smooth).is_some(), (1..stoppable).contains(&at), "tick {} of {:?}", at, plan);
        prop_assert_eq!(stop(&plan, from, plan.ticks() + at, Stop::Urgent), None);
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
    // 200 mm/s at 4 m/s^2 and 400 m/s^3: 50 ms and 10 ms, 6 mm; urgent 25 ms and 5 ms, 3 mm.
    let (ticks, mm) = way(Stop::Smooth);
    assert!(
        ticks.abs_diff(1_200) <= 2 && (mm - 6.0).abs() < 0.02,
        "{ticks} {mm}"
    );
    let (ticks, mm) = way(Stop::Urgent);
    assert!(
        ticks.abs_diff(600) <= 2 && (mm - 3.0).abs() < 0.02,
        "{ticks} {mm}"
    );
}

//! Lines: arrival, limits, straightness, duration.

mod motion_bench;

use firmware::motion::{
    AxisState, Constraints, Limits, PathLimits, Position, Refusal, RestToRestProfile, check_target,
    plan_line,
};
use motion_bench::exact::Worst;
use motion_bench::*;
use proptest::prelude::*;

proptest! {
    #![proptest_config(settings(400))]

    #[test]
    fn the_integers_arrive_by_themselves((from, to) in moves()) {
        let plan = line(from, to);
        let last = *corners(&plan, at_rest(from)).last().unwrap();
        for i in 0..3 {
            // What is dropped at the end: a speed of 1e-5 units a tick (6 pm/s), of acceleration far less, and under a
            // millionth of a unit (1.5 femtoradians).
            prop_assert!(last[i].velocity.unsigned_abs() < 1 << 24, "{}", last[i].velocity);
            prop_assert!(last[i].acceleration.unsigned_abs() < 660, "{}", last[i].acceleration);
            let rest = last[i].position - (i128::from(to[i]) << 40);
            prop_assert!(rest.unsigned_abs() < 1 << 17, "axis {} misses by {:e} units", i, rest as f64 / 2f64.powi(40));
        }
        prop_assert_eq!(plan.state_after(&at_rest(from), plan.ticks()), at_rest(to));
    }

    #[test]
    fn limits_hold((from, to) in moves()) {
        let worst = Worst::of_corners(&line(from, to), at_rest(from));
        prop_assert!(worst.is_kept(), "{worst:?}");
    }

    #[test]
    fn one_limit_is_used_up_in_a_long_move((from, to) in (positions(2.0), positions(2.0))) {
        let plan = line(from, to);
        let start = at_rest(from);
        let worst = Worst::of_corners(&plan, start);
        let pivots = (0..=400).map(|k| pivot_rate(&plan.state_after(&start, plan.ticks() * k / 400)));
        let pivots = pivots.fold(0.0, f64::max);
        // What is left to the corners of a motion that the pivots shape, in forty seeds.
        prop_assert!(worst.jerk > 0.85 || pivots > 0.97, "{worst:?} {pivots}");
    }

    #[test]
    fn pivots_keep_their_rate((from, to) in moves()) {
        let plan = line(from, to);
        let ticks = plan.ticks();
        for k in 0..=200 {
            let state = plan.state_after(&at_rest(from), ticks * k / 200);
            let rate = pivot_rate(&state);
            prop_assert!(rate <= SLACK, "{rate} of the limit");
        }
    }

    #[test]
    fn where_the_pivots_follow_the_duration_is_the_optimum_and_four_ticks((from, to) in moves()) {
        prop_assume!(from != to);
        let constraints = Constraints::new(Limits { pivot_rate_rad_s: 1e3, pivot_acceleration_rad_s2: 1e5, ..LIMITS }, GEOMETRY);
        let optimum = optimum_of_line(&from, &to);
        let ticks = plan_line(7, from, to, &constraints).unwrap().ticks() as f64;
        // Lengths and limits are f32 on the way: a millionth.
        prop_assert!(ticks >= optimum * (1.0 - 2e-6), "{ticks} < {optimum}");
        prop_assert!(ticks < optimum * (1.0 + 2e-6) + 4.0, "{ticks} > {optimum}");
        prop_assert!(line(from, to).ticks() as f64 >= ticks);
    }

    #[test]
    fn outside_the_disk_is_refused(from in positions(2.0), beyond in 80.0001..500.0_f64, direction in -3.2..3.2_f64) {
        let to = at(beyond * direction.cos(), beyond * direction.sin(), 0.5);
        prop_assert_eq!(plan_line(1, from, to, &CONSTRAINTS).err(), Some(Refusal::OutsideDisk));
    }

    #[test]
    fn the_rim_itself_is_inside(direction in -3.2..3.2_f64) {
        prop_assert_eq!(check_target(&at(80.0 * direction.cos(), 80.0 * direction.sin(), 0.0), &CONSTRAINTS), Ok(()));
    }
}

/// Part of its limit that a pivot's rate reaches.
fn pivot_rate(axes: &[AxisState; 3]) -> f64 {
    Worst::of(axes, &CONSTRAINTS).pivot_rate
}

/// Optimum of a line without the pivots' limits, ticks.
fn optimum_of_line(from: &Position, to: &Position) -> f64 {
    let way = [0, 1, 2].map(|i| (to[i] - from[i]) as f64 / UNIT);
    let (mm, deg) = (
        way[0].hypot(way[1]) * GEOMETRY.radius_mm,
        way[2].abs() * 360.0,
    );
    let least = |along: f64, turning: f64| (along / mm).min(turning / deg);
    let hz = LIMITS.rate_hz;
    optimum_ticks(
        least(LIMITS.speed_mm_s, LIMITS.turn_speed_deg_s) / hz,
        least(LIMITS.acceleration_mm_s2, LIMITS.turn_acceleration_deg_s2) / hz.powi(2),
        least(LIMITS.jerk_mm_s3, LIMITS.turn_jerk_deg_s3) / hz.powi(3),
    )
}

proptest! {
    // Tick by tick through whole moves.
    #![proptest_config(settings(60))]

    #[test]
    fn every_tick_is_on_the_line_and_steps_by_its_velocity((from, to) in moves()) {
        let plan = line(from, to);
        let all = states(&plan, at_rest(from));
        for pair in all.windows(2) {
            let off = off_line(&pair[1], &from, &to);
            prop_assert!(off < 0.0055, "{off}");
            for (i, (a, b)) in pair[0].iter().zip(&pair[1]).enumerate() {
                let step = (b.position - a.position) as f64;
                let mean = (a.velocity as f64 + b.velocity as f64) / 2.0;
                // A cubic's step is its mean velocity, jerk / 12 aside; and the nudge.
                let jerk = (b.acceleration - a.acceleration) as f64;
                prop_assert!((step - mean + jerk / 12.0).abs() <= plan.nudge[i].abs() as f64 + 2.0 + 1e-9 * mean.abs());
                prop_assert!((b.velocity - a.velocity - a.acceleration).abs() <= (jerk as i64).abs() / 2 + 1);
            }
        }
    }

    #[test]
    fn the_closed_form_is_the_tick_to_the_bit((from, to) in moves(), fraction in 0.0..1.0_f64) {
        let plan = line(from, to);
        let all = states(&plan, at_rest(from));
        let tick = (fraction * plan.ticks() as f64) as u64;
        for tick in [0, 1, tick, plan.ticks().saturating_sub(1)] {
            if tick < plan.ticks() {
                prop_assert_eq!(plan.state_after(&at_rest(from), tick), all[tick as usize]);
            }
        }
    }
}

#[test]
fn ten_thousand_turns_arrive_exactly() {
    for (from, to) in [
        (at(0.0, 0.0, -10_000.0), at(0.0, 0.0, 10_000.0)),
        (at(-76.0, 3.0, 10_000.0), at(10.0, -79.0, -9_999.123)),
        (at(0.0, 0.0, 0.0), at(1e-6, 0.0, 10_000.0)),
    ] {
        let plan = line(from, to);
        let last = *corners(&plan, at_rest(from)).last().unwrap();
        for i in 0..3 {
            assert_eq!((last[i].velocity, last[i].acceleration), (0, 0));
            let rest = last[i].position - (i128::from(to[i]) << 40);
            assert!(
                rest.unsigned_abs() < 445_000_000,
                "misses by {:e} units",
                rest as f64 / 2f64.powi(40)
            );
        }
        for axes in corners(&plan, at_rest(from)) {
            assert!(off_line(&axes, &from, &to) < 1.21e-3);
        }
        let worst = Worst::of_corners(&plan, at_rest(from));
        assert!(worst.is_kept(), "{worst:?}");
        assert_eq!(plan.state_after(&at_rest(from), plan.ticks()), at_rest(to));
    }
}

#[test]
fn no_way_is_no_pieces_and_one_unit_is_exact() {
    let here = at(12.0, -3.0, 0.3);
    let plan = line(here, here);
    assert_eq!((plan.ticks(), plan.end), (0, here));
    for i in 0..3 {
        for step in [1, -1] {
            let mut to = here;
            to[i] += step;
            let plan = line(here, to);
            assert!((1..=6).contains(&plan.ticks()), "{} ticks", plan.ticks());
            assert_eq!(plan.state_after(&at_rest(here), plan.ticks()), at_rest(to));
        }
    }
}

#[test]
fn a_diagonal_is_no_faster_than_a_straight() {
    let straight = line(at(-50.0, 0.0, 0.0), at(50.0, 0.0, 0.0)).ticks();
    let side = 50.0 / 2f64.sqrt();
    let diagonal = line(at(-side, -side, 0.0), at(side, side, 0.0)).ticks();
    assert!(straight.abs_diff(diagonal) <= 1, "{straight} {diagonal}");
    // 100 mm at 200 mm/s, 4 m/s^2, 400 m/s^3: 0.5 s + 50 ms + 10 ms, all whole ticks.
    assert_eq!(straight, 11_200);
}

#[test]
fn the_pivots_bound_slows_a_turn_at_the_rim_only() {
    let turn = |r_mm: f64| line(at(r_mm, 0.0, 0.0), at(r_mm, 0.0, 1.0)).ticks();
    // 360 deg/s needs (1 + r) 2 pi <= 10 rad/s: r <= 0.59.
    assert_eq!(turn(0.0), turn(59.0));
    assert!(turn(80.0) > turn(60.0) && turn(60.0) > turn(59.0));
    // A whole turn meets the worst orientation: the bound is reached, not just kept.
    let plan = line(at(80.0, 0.0, 0.0), at(80.0, 0.0, 1.0));
    let start = at_rest(at(80.0, 0.0, 0.0));
    let worst = (0..=1000).map(|k| pivot_rate(&plan.state_after(&start, plan.ticks() * k / 1000)));
    let worst = worst.fold(0.0, f64::max);
    assert!((0.98..=SLACK).contains(&worst), "{worst} of the limit");
}

#[test]
fn limits_that_allow_no_motion_are_refused() {
    let with: [fn(f64) -> Limits; 10] = [
        |rate_hz| Limits { rate_hz, ..LIMITS },
        |speed_mm_s| Limits {
            speed_mm_s,
            ..LIMITS
        },
        |acceleration_mm_s2| Limits {
            acceleration_mm_s2,
            ..LIMITS
        },
        |jerk_mm_s3| Limits {
            jerk_mm_s3,
            ..LIMITS
        },
        |turn_speed_deg_s| Limits {
            turn_speed_deg_s,
            ..LIMITS
        },
        |turn_acceleration_deg_s2| Limits {
            turn_acceleration_deg_s2,
            ..LIMITS
        },
        |turn_jerk_deg_s3| Limits {
            turn_jerk_deg_s3,
            ..LIMITS
        },
        |pivot_rate_rad_s| Limits {
            pivot_rate_rad_s,
            ..LIMITS
        },
        |pivot_acceleration_rad_s2| Limits {
            pivot_acceleration_rad_s2,
            ..LIMITS
        },
        |stop_factor| Limits {
            stop_factor,
            ..LIMITS
        },
    ];
    let (from, to) = (at(0.0, 0.0, 0.0), at(1.0, 0.0, 1.0));
    for (i, with) in with.iter().enumerate() {
        for bad in [0.0, -1.0, f64::NAN] {
            let refusal = plan_line(1, from, to, &Constraints::new(with(bad), GEOMETRY));
            assert_eq!(refusal, Err(Refusal::InvalidLimits), "limit {i}: {bad}");
        }
        assert!(
            plan_line(1, from, to, &Constraints::new(with(20_000.0), GEOMETRY)).is_ok(),
            "limit {i}"
        );
    }
    let slow = Limits {
        speed_mm_s: 1e-300,
        ..LIMITS
    };
    assert_eq!(
        plan_line(1, from, to, &Constraints::new(slow, GEOMETRY)),
        Err(Refusal::InvalidLimits)
    );
    let far = [0, 0, (1_000_000_000 << 32) + 1];
    assert_eq!(
        plan_line(1, from, far, &CONSTRAINTS),
        Err(Refusal::TooManyTurns)
    );
}

proptest! {
    #![proptest_config(settings(60))]

    #[test]
    fn a_profile_needs_positive_limits(good in 1e-9..1.0_f32, which in 0..3_usize, bad in prop_oneof![Just(0.0), Just(-0.1), Just(f32::NAN)]) {
        let mut limits = [good; 3];
        limits[which] = bad;
        let [rate, acceleration, jerk] = limits;
        prop_assert_eq!(RestToRestProfile::new(&PathLimits { rate, acceleration, jerk }, 20_000.0), None);
    }
}

//! What a motion must not depend on: its direction, when it is planned, whole turns, and where on the mechanism it is.

mod motion_bench;

use firmware::motion::{
    AxisState, Constraints, Effort, LoneFollower, Plan, PlanStart, Position, RetargetError,
    RotationCentre, Stop, plan_jog, plan_line, plan_retarget, plan_stop,
};
use motion_bench::constraints::{any_constraints, rest, velocities};
use motion_bench::*;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use std::cell::Cell;
use std::f64::consts::{PI, TAU};

/// A line of any size on any constraints, if it can be moved along.
fn lines() -> impl Strategy<Value = (Position, Position, Constraints)> {
    (moves(), any_constraints()).prop_filter_map("no line", |((a, b), constraints)| {
        let ends = [rest(a, &constraints)?, rest(b, &constraints)?];
        let [from, to] = ends.map(|axes| axes.map(|axis| axis.rounded()));
        plan_line(7, from, to, &constraints).ok()?;
        Some((from, to, constraints))
    })
}

proptest! {
    #![proptest_config(settings(300))]

    /// To a tick, to a unit of position, and to what rounding the jerks makes of velocity.
    #[test]
    fn backwards_is_forwards_backwards((from, to, constraints) in lines()) {
        let there = plan_line(7, from, to, &constraints).unwrap();
        let back = plan_line(7, to, from, &constraints);
        prop_assert!(back.is_ok(), "{back:?}");
        let back = back.unwrap();
        let ticks = there.ticks();
        prop_assert_eq!(back.ticks(), ticks);
        for k in 0..=40 {
            let k = ticks * k / 40;
            let one = there.state_after(&at_rest(from), k);
            let other = back.state_after(&at_rest(to), ticks - k);
            for i in 0..3 {
                prop_assert!((one[i].rounded() - other[i].rounded()).abs() <= 1);
                prop_assert!((one[i].velocity + other[i].velocity).abs() <= 12 * ticks as i64 + (1 << 24));
            }
        }
    }

    /// A plan that began earlier and is in the same state now leads to the very same one.
    #[test]
    fn it_is_the_same_whenever_it_is_planned((from, to, constraints) in lines(), other in positions(0.3), velocity in velocities(), [early, late] in prop::array::uniform2(0.0..1.0_f64)) {
        let plan = plan_line(7, from, to, &constraints).unwrap();
        let at = (late * plan.ticks() as f64) as u64;
        let since = (early * at as f64) as u64;
        let (rest_of, start) = begun_at(&plan, &at_rest(from), since);
        let state = plan.state_after(&at_rest(from), at);
        prop_assert_eq!(rest_of.state_after(&start, at - since), state);
        let other = RotationCentre::new(constraints.rotation_centre).unwrap().from_platform(&other);
        let both = [(&plan, at_rest(from), at), (&rest_of, start, at - since)];
        let [one, shifted] = both.map(|(plan, start, at)| plan_retarget(8, plan, &start, at, other, &constraints, Effort::ALL).map(unshifted));
        prop_assert_eq!(one, shifted);
        for how in [Stop::Smooth, Stop::Urgent] {
            let [one, shifted] = both.map(|(plan, start, at)| plan_stop(8, plan, &start, at, &constraints, how).map(unshifted));
            prop_assert_eq!(one, shifted);
        }
        let [one, shifted] = both.map(|(_, _, tick)| {
            plan_jog(8, PlanStart::Splice { plan: 7, tick }, &state, &velocity, &constraints).map(unshifted)
        });
        prop_assert_eq!(one, shifted);
    }

    /// The same tick by tick, whenever the tick takes it.
    #[test]
    fn the_tick_plays_it_the_same_whenever_it_begins((from, to) in moves(), late in 0..5_000) {
        let plan = line(from, to);
        let mut motions = [0, late].map(|wait| {
            let mut motion = follower();
            motion.rest_at(from);
            for _ in 0..wait {
                motion.advance();
            }
            motion.accept(&plan).expect("at rest");
            motion
        });
        for _ in 0..plan.ticks() {
            motions.iter_mut().for_each(LoneFollower::advance);
            let [one, shifted] = motions.each_ref().map(|motion| motion.position());
            prop_assert_eq!(one, shifted);
        }
    }

    /// Whole turns change nothing, up to ten thousand of them.
    #[test]
    fn whole_turns_change_nothing((from, to, mut constraints) in lines(), other in positions(0.3), part in 0.0..1.0_f64, turns in -10_000..10_000_i64) {
        constraints.bounds = CONSTRAINTS.bounds;
        let other = RotationCentre::new(constraints.rotation_centre).unwrap().from_platform(&other);
        let [one, turned] = [0, turns].map(|turns| {
            let on = |[x, y, theta]: Position| [x, y, theta + (turns << 32)];
            let plan = plan_line(7, on(from), on(to), &constraints).expect("without bounds");
            let at = (part * plan.ticks() as f64) as u64;
            let next = plan_retarget(8, &plan, &at_rest(on(from)), at, on(other), &constraints, Effort::ALL);
            (plan.pieces, next.map(|next| (next.pieces, next.nudge)))
        });
        prop_assert_eq!(one, turned);
    }
}

/// The same motion from tick `since` on, as a plan of its own, and where that starts.
fn begun_at(plan: &Plan, start: &[AxisState; 3], since: u64) -> (Plan, [AxisState; 3]) {
    let mut rest_of = plan.clone();
    let mut past = since;
    for piece in &mut rest_of.pieces {
        let gone = past.min(piece.ticks);
        piece.ticks -= gone;
        past -= gone;
    }
    (rest_of, plan.state_after(start, since))
}

/// A plan but for the tick at which it begins.
fn unshifted(mut plan: Plan) -> Plan {
    plan.start = PlanStart::Rest([0; 3]);
    plan
}

/// A symmetry of the mechanism: the whole turned about the track's centre by an angle, mirrored in x or not, and the
/// guides taken for one another.
#[derive(Clone, Copy, Debug)]
struct Symmetry {
    angle: f64,
    mirrored: bool,
    guides: i64,
}

impl Symmetry {
    fn point(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let x = if self.mirrored { -x } else { x };
        turned([x, y], self.angle)
    }

    /// Where a point fixed in the platform lies after it: a third of a turn of theta turns it the other way.
    fn centre(&self, [p, q]: [f64; 2]) -> [f64; 2] {
        let p = if self.mirrored { -p } else { p };
        turned([p, q], -TAU / 3.0 * self.guides as f64)
    }

    /// Of a place or a velocity of the moved point, theta in turns.
    fn pose(&self, [x, y, theta]: [f64; 3], moved: bool) -> [f64; 3] {
        let [x, y] = self.point([x, y]);
        let theta = if self.mirrored { -theta } else { theta };
        let shift = if moved {
            self.angle / TAU + self.guides as f64 / 3.0
        } else {
            0.0
        };
        [x, y, theta + shift]
    }

    fn position(&self, position: Position) -> Position {
        self.pose(position.map(|value| value as f64 / UNIT), true)
            .map(|value| (value * UNIT).round() as i64)
    }
}

fn turned([x, y]: [f64; 2], angle: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    [x * cos - y * sin, x * sin + y * cos]
}

/// What comes of it: a line, and a new target in it at a tick.
struct Plans {
    line: Plan,
    at: u64,
    next: Result<Plan, RetargetError>,
}

impl Plans {
    fn new([from, to, other]: [Position; 3], constraints: &Constraints, part: f64) -> Option<Self> {
        let line = plan_line(7, from, to, constraints).ok()?;
        let at = (part * line.ticks() as f64) as u64;
        let next = plan_retarget(
            8,
            &line,
            &at_rest(from),
            at,
            other,
            constraints,
            Effort::ALL,
        );
        Some(Self { line, at, next })
    }
}

/// How far apart two plans from rest are that should be images of each other: durations, as a part; and places, track
/// radii or turns.
fn apart(one: &Plan, image: &Plan, starts: [&[AxisState; 3]; 2], symmetry: &Symmetry) -> [f64; 2] {
    let (ticks, ticks_image) = (one.ticks(), image.ticks());
    let mut furthest = 0_u64;
    for k in 0..=40 {
        let place = one.state_after(starts[0], ticks * k / 40);
        let there = image.state_after(starts[1], ticks_image * k / 40);
        let expected = symmetry.position(place.map(|axis| axis.rounded()));
        for (axis, expected) in there.iter().zip(expected) {
            furthest = furthest.max(axis.rounded().abs_diff(expected));
        }
    }
    let part = ticks.abs_diff(ticks_image) as f64 / ticks.max(1) as f64;
    [part, furthest as f64 / UNIT]
}

/// Lines and new targets take as long, and are at the same places, on the turned and mirrored mechanism. Not to the
/// bit: single precision rounds differently, and a planner that decides gets the other answer where what it looks at is
/// at a limit to the last bits. Of 45,040 new targets 96 were apart by a tick or by 1e-6. Traced to the first decision
/// that differed: in 9 a delay that is just kept, or just not, moved its search to the other half (up to 0.5 % of the
/// duration and 1.6 mm on the way); in 2 the check took or refused a speed at its slack (8 %, 2.8 mm); in the other 85
/// the decisions were the same, or samples of the pivots and numbers of intervals were not (0.09 %, 0.03 mm).
#[test]
fn the_mechanism_is_the_same_all_round() {
    let all = (
        prop::array::uniform3(positions(0.3)),
        any_constraints(),
        (-PI..PI, any::<bool>(), 0..3_i64),
        0.0..1.0_f64,
    );
    let differences = Cell::new([Vec::new(), Vec::new()]);
    let only_one = Cell::new(0);
    let result =
        TestRunner::new(settings(1_500)).run(&all, |(places, mut constraints, symmetry, part)| {
            constraints.bounds = CONSTRAINTS.bounds;
            let (angle, mirrored, guides) = symmetry;
            let symmetry = Symmetry {
                angle,
                mirrored,
                guides,
            };
            let image = Constraints {
                rotation_centre: symmetry.centre(constraints.rotation_centre),
                ..constraints
            };
            let centre = RotationCentre::new(constraints.rotation_centre).unwrap();
            let places = places.map(|platform| centre.from_platform(&platform));
            let images = places.map(|place| symmetry.position(place));
            let both = [
                Plans::new(places, &constraints, part),
                Plans::new(images, &image, part),
            ];
            let [Some(plans), Some(images_plans)] = &both else {
                prop_assert!(both.iter().all(Option::is_none), "one refused");
                return Ok(());
            };
            let starts = [places[0], images[0]].map(at_rest);
            let mut all = differences.take();
            let off = apart(
                &plans.line,
                &images_plans.line,
                starts.each_ref(),
                &symmetry,
            );
            all[0].push(off);
            match (&plans.next, &images_plans.next) {
                (Ok(next), Ok(next_image)) if off[0] == 0.0 => {
                    let from = plans.line.state_after(&starts[0], plans.at);
                    let from_image = images_plans.line.state_after(&starts[1], images_plans.at);
                    all[1].push(apart(next, next_image, [&from, &from_image], &symmetry));
                }
                (Ok(_), Err(_)) | (Err(_), Ok(_)) => only_one.set(only_one.get() + 1),
                _ => {}
            }
            differences.set(all);
            Ok(())
        });
    result.unwrap();
    // Of a hundred lines one may round to another motion, to one that is not much different.
    let [lines, targets] = differences.take();
    let ([ticks, places], [ticks_new, places_new]) =
        (spread("lines", &lines), spread("new targets", &targets));
    println!(
        "new targets that need a stop on one side only: {}",
        only_one.get()
    );
    assert!(lines.len() > 1_400 && targets.len() > 1_000);
    assert!(ticks[0] == 0.0 && ticks[1] < 2e-3 && places[0] < 1e-6 && places[1] < 1e-3);
    assert!(ticks_new[0] == 0.0 && places_new[0] < 1e-6);
    // What samples and intervals make of it; and a decision at a limit, one new target in four thousand.
    let decided = |off: &&[f64; 2]| off[0] > 9.4e-4 || off[1] > 3.2e-4;
    assert!(targets.iter().filter(decided).count() <= 3);
    assert!(only_one.get() <= 16);
}

/// 99 % and the worst of the differences of duration and of place.
fn spread(what: &str, all: &[[f64; 2]]) -> [[f64; 2]; 2] {
    [0, 1].map(|k| {
        let mut all: Vec<f64> = all.iter().map(|both| both[k]).collect();
        all.sort_by(f64::total_cmp);
        let at = |part: f64| all[((all.len() - 1) as f64 * part) as usize];
        println!(
            "{} {what}, difference of {}: median {:.1e}, 99 % {:.1e}, worst {:.1e}",
            all.len(),
            ["duration, as a part", "place, track radii or turns"][k],
            at(0.5),
            at(0.99),
            at(1.0)
        );
        [at(0.99), at(1.0)]
    })
}

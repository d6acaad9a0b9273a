//! What the chip computes, in single precision and integers and as the tick plays it, beside rsruckig in doubles:
//! durations of three axes from motion to rest.
//!
//! `STATES=20000 cargo test --release -p firmware --test motion_reference -- --nocapture` takes more states, `SEED`
//! others.

mod motion_bench;

use firmware::motion::{AxisState, Effort, Plan, plan_line, plan_retarget};
use motion_bench::exact::ends_at_rest;
use motion_bench::random::Random;
use motion_bench::reference::{Reference, per_axis};
use motion_bench::setting::setting;
use motion_bench::*;

/// Ticks in which the tick itself plays a plan, which has to end at rest.
fn played(plan: &Plan, start: &[AxisState; 3]) -> f64 {
    let all = states(plan, *start);
    assert!(
        ends_at_rest(plan, all.last().unwrap()),
        "{start:?} {plan:?}"
    );
    (all.len() - 1) as f64
}

/// Median, 99 % and worst, printed.
fn spread(what: &str, mut ratios: Vec<f64>) -> [f64; 3] {
    ratios.sort_by(f64::total_cmp);
    let at = |part: f64| ratios[((ratios.len() - 1) as f64 * part) as usize];
    let all @ [median, most, worst] = [at(0.5), at(0.99), at(1.0)];
    println!(
        "{what}, {} states: least {:.4}, median {median:.4}, 99 % {most:.4}, worst {worst:.4}",
        ratios.len(),
        at(0.0)
    );
    all
}

/// New targets in motion. The reference knows no limits along a path: with the axes' in a square around the circle of
/// the path's it is a bound from below, with a square within the circle what it could be used for here. The pivots'
/// limits, which it does not know either, are out of the way first.
#[test]
fn new_targets_in_motion_beside_the_reference() {
    let (seed, cases) = (setting("SEED", 20_260_402), setting("STATES", 4_000));
    println!("seed {seed}");
    let mut free = CONSTRAINTS;
    free.limits.pivot_rate_rad_s = 1e3;
    free.limits.pivot_acceleration_rad_s2 = 1e5;
    for (what, constraints, most_stops) in [
        ("without pivots", free, 10),
        ("with pivots", CONSTRAINTS, 4),
    ] {
        let mut random = Random::new(seed);
        let mut ratios = [Vec::new(), Vec::new()];
        let mut stops = 0;
        for _ in 0..cases {
            let [from, to, other] = [0; 3].map(|_| random.place(&constraints));
            let line = plan_line(1, from, to, &constraints).expect("a line");
            let at = (random.unit() * line.ticks() as f64) as u64;
            let start = line.state_after(&at_rest(from), at);
            let Ok(next) = plan_retarget(
                2,
                &line,
                &at_rest(from),
                at,
                other,
                &constraints,
                Effort::ALL,
            ) else {
                stops += 1;
                continue;
            };
            let ticks = played(&next, &start);
            for (ratios, part) in ratios.iter_mut().zip([0.5_f64.sqrt(), 1.0]) {
                let limits = per_axis(&constraints.limits, part);
                if let Some(theirs) = Reference::new(&start, &other, &limits) {
                    ratios.push(ticks / theirs.ticks());
                }
            }
        }
        println!("{what}: {stops} of {cases} after a stop");
        let [within, around] = ratios;
        let within = spread("duration over the reference's in the square within", within);
        let around = spread("in the square around", around);
        assert!(stops * most_stops < cases);
        assert!(within[0] < 0.95 && within[1] < 1.2 && within[2] < 1.4);
        assert!(around[0] < 1.1 && around[1] < 1.45 && around[2] < 1.7);
    }
}

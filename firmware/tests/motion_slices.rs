//! A new target planned in slices: the head that is handed over first, and what goes on from it.

mod motion_bench;

use firmware::motion::{
    Ahead, AxisState, Leave, Plan, Position, RetargetError, Tries, plan_retarget, try_retarget,
};
use motion_bench::exact::{Worst, ends_at_rest};
use motion_bench::random::Random;
use motion_bench::setting::setting;
use motion_bench::*;

/// Ticks at which the second slice can take over.
const TAKEN_OVER: [u64; 4] = [1, 40, 99, 200];

/// A line that is left for another target at a random tick.
struct Left {
    line: Plan,
    from: [AxisState; 3],
    at: u64,
    to: Position,
}

impl Left {
    fn new(random: &mut Random) -> Self {
        let [from, to, other] = [0; 3].map(|_| random.place(&CONSTRAINTS));
        let line = line(from, to);
        Self {
            at: (random.unit() * line.ticks() as f64) as u64,
            line,
            from: at_rest(from),
            to: other,
        }
    }

    /// The first slice: a plan, and what lies ahead of it.
    fn first(&self, tries: &mut Tries) -> (Result<Plan, RetargetError>, Option<Ahead>) {
        let mut ahead = None;
        let mut plan = Plan::default();
        let leave = Leave {
            of: &self.line,
            from: &self.from,
            at: self.at,
        };
        let tried = try_retarget(
            &mut plan,
            2,
            leave,
            self.to,
            &CONSTRAINTS,
            tries,
            &mut ahead,
        );
        (tried.map(|()| plan), ahead)
    }
}

/// All of it keeps the law: the head, which comes to rest by itself, and what takes over from it at any of its ticks,
/// which is the very motion that is planned when there is all the time in the world.
#[test]
fn a_head_ends_inside_and_its_rest_is_the_same_motion() {
    let seed = setting("SEED", 20_261_121);
    println!("seed {seed}");
    let mut random = Random::new(seed);
    let (mut heads, mut rests) = (0, 0);
    for _ in 0..setting("STATES", 4_000) {
        let left = Left::new(&mut random);
        let mut tries = Tries::NONE;
        let (Ok(head), Some(ahead)) = left.first(&mut tries) else {
            continue;
        };
        heads += 1;
        let start = left.line.state_after(&left.from, left.at);
        let mut worst = Worst::default();
        let end = worst.walk(&head, &start, &CONSTRAINTS);
        assert!(ends_at_rest(&head, &end), "{end:?} {head:?}");
        // As of any stop: while it releases an acceleration the speed goes on to rise.
        let pivots = worst.pivot_rate.max(worst.pivot_acceleration);
        assert!(pivots <= 1.001 && worst.is_inside(), "{worst:?} {head:?}");
        let whole = plan_retarget(2, &left.line, &left.from, left.at, left.to, &CONSTRAINTS);
        for at in TAKEN_OVER {
            if !ahead.follows(2, at) {
                continue;
            }
            let Ok(rest) = ahead.go_on(3, at, &CONSTRAINTS, &mut { tries }) else {
                continue;
            };
            rests += 1;
            let whole = whole.as_ref().expect("looked at like its slices");
            let from = head.state_after(&start, at);
            assert_eq!(rest.end, left.to);
            for tick in [0, 1, rest.ticks() / 3, rest.ticks() - 1] {
                assert_eq!(
                    rest.state_after(&from, tick),
                    whole.state_after(&start, at + tick),
                    "{at} {tick}"
                );
            }
        }
    }
    println!("{heads} heads, {rests} times gone on from");
    assert!(heads > 1_000 && rests > 2 * heads);
}

/// Another plan, or a tick at which the stop has begun, is not what it follows.
#[test]
fn what_lies_ahead_follows_its_own_head_only() {
    let mut random = Random::new(20_261_122);
    let ahead = (0..100).find_map(|_| Left::new(&mut random).first(&mut { Tries::NONE }).1);
    let ahead = ahead.expect("one in a hundred is long");
    assert!(ahead.follows(2, 0) && !ahead.follows(1, 0) && !ahead.follows(3, 0));
    assert!(!ahead.follows(2, 201));
}

/// A try that was too fast makes the next one slower, and there is an end to it.
#[test]
fn tries_are_no_more_than_three() {
    let mut random = Random::new(20_261_123);
    let (mut again, mut found) = (0, 0);
    for _ in 0..600 {
        let left = Left::new(&mut random);
        let mut tries = Tries::NONE;
        for count in 1.. {
            assert!(count <= 3);
            let (plan, ahead) = left.first(&mut tries);
            let looked = match &ahead {
                Some(ahead) => ahead.go_on(3, 0, &CONSTRAINTS, &mut tries).map(drop),
                None => plan.map(drop),
            };
            if looked != Err(RetargetError::TooFast) {
                found += usize::from(count > 1 && looked.is_ok());
                break;
            }
            again += 1;
        }
    }
    println!("{again} times too fast, {found} found slower");
    assert!(again > 20 && found > 10);
}

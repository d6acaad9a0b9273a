//! What the kinematics cost on this machine, beside the same with nalgebra as it comes: `cargo bench -p kinematics`.
//!
//! On a desktop nalgebra takes sine and arcsine from the C library, which rounds as it likes and may be quicker; this crate takes
//! them from the crate `libm`, the same everywhere.
//!
//! Alone: each call waits for the result of the one before. In a batch: 1,024 in a row, as a map or a path check has them. The
//! two are timed in turn, and the fastest of many rounds counts, since what disturbs a timing only ever adds to it.

mod plain_direct;
mod plain_inverse;

use std::array::from_fn;
use std::f64::consts::TAU;
use std::hint::black_box;
use std::time::Instant;

use kinematics::{Acceleration, Pose, Real, Scalar, Twist, direct, inverse, pivot_motion};
use nalgebra::{RealField, Vector3};

/// States in a batch.
const BATCH: usize = 1024;
/// Batches in a round.
const REPEATS: u32 = 20;
const ROUNDS: u32 = 60;

/// A state of the stage in a number type, as either side takes it.
#[derive(Clone, Copy)]
struct State<T: Real> {
    pose: Pose<T>,
    twist: Twist<T>,
    acceleration: Acceleration<T>,
    pivots: [T; 3],
    vectors: [Vector3<T>; 4],
}

impl<T: Real + RealField> State<T> {
    fn new(index: usize) -> Self {
        // Low discrepancy: the multiples of three irrational numbers cover the disk and the turn evenly.
        let part = |step: f64| (index as f64 * step).fract();
        let (r, direction) = (0.8 * part(0.618_033_988).sqrt(), TAU * part(0.414_213_562));
        let t = <T as Real>::from_f64;
        let pose = Pose {
            x: t(r * direction.cos()),
            y: t(r * direction.sin()),
            theta: t(6.0 * part(0.732_050_807) - 3.0),
        };
        let [twist, acceleration] = [3.0, 40.0].map(|most| {
            from_fn::<T, 3, _>(|axis| t(most * (part(0.236_067_977 + 0.1 * axis as f64) - 0.5)))
        });
        let pivots = inverse(&pose).expect("inside the track").pivots;
        let vector = |[x, y, z]: [T; 3]| Vector3::new(x, y, z);
        Self {
            pose,
            twist: Twist {
                x: twist[0],
                y: twist[1],
                theta: twist[2],
            },
            acceleration: Acceleration {
                x: acceleration[0],
                y: acceleration[1],
                theta: acceleration[2],
            },
            pivots,
            vectors: [
                vector([pose.x, pose.y, pose.theta]),
                vector(twist),
                vector(acceleration),
                vector(pivots),
            ],
        }
    }

    /// The same, as much later as the number says; it is nothing, which only the processor finds out.
    fn after(&self, nothing: T) -> Self {
        let mut state = *self;
        state.pose.x += nothing;
        state.pivots[0] += nothing;
        state.vectors[0].x += nothing;
        state.vectors[3].x += nothing;
        state
    }
}

fn own_inverse<T: Real + RealField>(state: &State<T>) -> T {
    let Ok(solved) = inverse(&state.pose) else {
        return <T as Real>::from_f64(f64::NAN);
    };
    let motion = pivot_motion(&solved.guides, &state.twist, &state.acceleration);
    black_box((&solved.pivots, &motion));
    motion.accelerations[2]
}

fn beside_inverse<T: Real + RealField>(state: &State<T>) -> T {
    let [pose, twist, acceleration, _] = &state.vectors;
    let solved = plain_inverse::inverse(pose, twist, acceleration);
    black_box(&solved);
    solved[2].z
}

fn own_direct<T: Real + RealField>(state: &State<T>) -> T {
    let Ok(pose) = direct::<T>(&state.pivots) else {
        return <T as Real>::from_f64(f64::NAN);
    };
    black_box(&pose);
    pose.theta
}

fn beside_direct<T: Real + RealField>(state: &State<T>) -> T {
    let pose = plain_direct::direct(&state.vectors[3]);
    black_box(&pose);
    pose.z
}

fn main() {
    println!(
        "{:<52}{:>8}{:>10}{:>8}",
        "ns a call", "ours", "beside", "ratio"
    );
    for_type::<f64>("f64");
    for_type::<f32>("f32");
}

fn for_type<T: Real + RealField>(type_name: &str) {
    let states: Vec<State<T>> = (0..BATCH).map(State::new).collect();
    let name = format!("inverse with rates and accelerations {type_name}");
    compare(&name, &states, own_inverse, beside_inverse);
    compare(
        &format!("direct {type_name}"),
        &states,
        own_direct,
        beside_direct,
    );
}

fn compare<T: Real + RealField>(
    name: &str,
    states: &[State<T>],
    own: impl Fn(&State<T>) -> T,
    beside: impl Fn(&State<T>) -> T,
) {
    let rows = [
        (
            "alone",
            nanoseconds(|| alone(states, &own), || alone(states, &beside)),
        ),
        (
            "batch",
            nanoseconds(|| batch(states, &own), || batch(states, &beside)),
        ),
    ];
    for (how, [ours, others]) in rows {
        let what = format!("{name}, {how}");
        println!("{what:<52}{ours:>8.1}{others:>10.1}{:>8.2}", others / ours);
    }
}

fn alone<T: Real + RealField>(states: &[State<T>], part: impl Fn(&State<T>) -> T) -> T {
    let zero = <T as Real>::from_f64(0.0);
    (black_box(states).iter()).fold(zero, |nothing, state| part(&state.after(nothing)) * zero)
}

fn batch<T: Real + RealField>(states: &[State<T>], part: impl Fn(&State<T>) -> T) -> T {
    let zero = <T as Real>::from_f64(0.0);
    (black_box(states).iter()).fold(zero, |sum, state| sum + part(state))
}

/// The fastest round of each of two, ns a call.
fn nanoseconds<T: Real>(one: impl Fn() -> T, other: impl Fn() -> T) -> [f64; 2] {
    let round = |work: &dyn Fn() -> T| {
        let start = Instant::now();
        for _ in 0..REPEATS {
            let result = work();
            assert!(
                Scalar::is_finite(result),
                "a pose of the disk has its pivots"
            );
        }
        start.elapsed().as_secs_f64() * 1e9 / (f64::from(REPEATS) * BATCH as f64)
    };
    let mut fastest = [f64::INFINITY; 2];
    for _ in 0..ROUNDS {
        fastest = [fastest[0].min(round(&one)), fastest[1].min(round(&other))];
    }
    fastest
}

//! Axis profiles against rsruckig: random states and limits, extremes included.
//!
//! `cargo test` draws 20,000; the full run is
//! `PROFILE_CASES=200000 cargo test --release -p firmware --test profile_reference -- --nocapture`, and another seed
//! `PROFILE_SEED`.

#[path = "motion_bench/setting.rs"]
mod setting;

use firmware::motion::{AxisLimits, AxisProfile, Task, Unusable, stop_distance};
use rsruckig::prelude::*;
use setting::setting;

/// SplitMix64 (Steele, Lea and Flood, 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn share(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// One in so many.
    fn once_in(&mut self, n: u64) -> bool {
        self.next().is_multiple_of(n)
    }

    /// Between two powers of ten, every power as likely.
    fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        10_f64.powf(self.within(low, high))
    }
}

/// Limits and a state, in any relation to each other: idle, at the limits, far over them, far or near or nowhere to go.
fn draw(random: &mut Random) -> (Task, AxisLimits<f64>) {
    let jerk = if random.once_in(10) {
        random.magnitude(-3.0, 6.0)
    } else {
        random.magnitude(0.0, 2.0)
    };
    let limits = AxisLimits {
        velocity: random.magnitude(-1.0, 1.0),
        acceleration: random.magnitude(-1.0, 1.0),
        jerk,
    };
    let over = if random.once_in(4) { 3.0 } else { 1.0 };
    let mut state = |limit: f64| match random.next() % 8 {
        0 => 0.0,
        1 => limit,
        2 => -limit,
        _ => random.within(-over, over) * limit,
    };
    let (velocity, acceleration) = (state(limits.velocity), state(limits.acceleration));
    let size =
        limits.velocity * (limits.velocity / limits.acceleration + limits.acceleration / jerk);
    let distance = match random.next() % 8 {
        0 => 0.0,
        1 => stop_distance(
            &Task {
                distance: 0.0,
                velocity,
                acceleration,
            },
            &limits,
        ),
        2 => random.within(-1.0, 1.0) * size * 1e-6,
        3 => random.within(-100.0, 100.0) * size,
        _ => random.within(-3.0, 3.0) * size,
    };
    let task = Task {
        distance,
        velocity,
        acceleration,
    };
    match random.next() % 40 {
        0 => (
            Task {
                distance: 0.0,
                velocity: 0.0,
                acceleration: 0.0,
            },
            limits,
        ),
        _ => (task, limits),
    }
}

/// Follows a profile: the law that its end is exact and its limits hold, but for a start over them.
fn follow(task: &Task, limits: &AxisLimits<f64>, profile: &AxisProfile<f64>) {
    let (mut p, mut v, mut a) = (0.0_f64, task.velocity, task.acceleration);
    let mut travelled = task.distance.abs();
    let slack = 1.0 + 1e-6;
    // Over its limit, speed and acceleration may stay up to what can not be avoided.
    let released =
        task.velocity + task.acceleration * task.acceleration.abs() / (2.0 * limits.jerk);
    let fastest = limits.velocity.max(task.velocity.abs()).max(released.abs()) * slack;
    let hardest = limits.acceleration.max(task.acceleration.abs()) * slack;
    for (i, (&t, &j)) in profile.durations.iter().zip(&profile.jerks).enumerate() {
        assert!(t >= 0.0 && t.is_finite(), "{profile:?}");
        assert!(j.abs() <= limits.jerk);
        let step = t * (v + t * (a / 2.0 + j * t / 6.0));
        // Terms that cancel count for the accuracy that can be asked for.
        travelled += t * (v.abs() + t * (a.abs() / 2.0 + j.abs() * t / 6.0));
        let before = v.abs();
        p += step;
        v += t * (a + j * t / 2.0);
        a += j * t;
        // After the first segment a speed over its limit only goes down.
        let (hardest, allowed) = match i {
            0 => (hardest, fastest),
            _ => (
                limits.acceleration * slack,
                before.max(limits.velocity) * slack,
            ),
        };
        assert!(
            a.abs() <= hardest,
            "segment {i}: {a} {task:?} {limits:?} {profile:?}"
        );
        assert!(
            v.abs() <= allowed + 1e-9 * fastest,
            "segment {i}: {v} {task:?} {limits:?} {profile:?}"
        );
    }
    // The rounding of this very sum: an acceleration known to 1e-15, through a cruise that may last for hours.
    let drift =
        1e-15 * limits.acceleration.max(task.acceleration.abs()) * profile.duration().powi(2);
    let speed = limits.velocity.max(task.velocity.abs());
    assert!(
        (p - task.distance).abs() <= 1e-9 * travelled + drift,
        "{} of {travelled}: {task:?} {limits:?} {profile:?}",
        p - task.distance
    );
    assert!(
        v.abs()
            <= 1e-9 * speed.max(released.abs()) + 1e-15 * limits.acceleration * profile.duration(),
        "{v} {task:?} {limits:?} {profile:?}"
    );
    assert!(
        a.abs() <= 1e-9 * limits.acceleration.max(task.acceleration.abs()),
        "{a} {task:?} {limits:?} {profile:?}"
    );
}

fn least_duration(distance: f64, limits: &AxisLimits<f64>) -> f64 {
    let task = Task {
        distance,
        velocity: 0.0,
        acceleration: 0.0,
    };
    AxisProfile::fastest(&task, limits).map_or(0.0, |profile| profile.duration())
}

#[test]
fn as_fast_as_the_reference_within_the_limits_to_an_exact_end() {
    let cases = setting("PROFILE_CASES", 20_000);
    let seed = setting("PROFILE_SEED", 20_260_214);
    println!("seed {seed}, {cases} states of three axes");
    let mut random = Random(seed);
    let mut ruckig = Ruckig::<3, ThrowErrorHandler>::new(None, 0.001);
    let mut input = InputParameter::new(None);
    let (mut compared, mut failed, mut worst, mut shorter, mut in_time, mut early) =
        (0, 0, 0.0_f64, 0, 0_u64, 0_u64);
    for _ in 0..cases {
        let axes: [(Task, AxisLimits<f64>); 3] = std::array::from_fn(|_| draw(&mut random));
        let fastest = axes.map(|(task, limits)| {
            let profile = AxisProfile::fastest(&task, &limits)
                .unwrap_or_else(|error| panic!("{error:?} {task:?} {limits:?}"));
            follow(&task, &limits, &profile);
            profile
        });
        let duration = fastest
            .iter()
            .map(AxisProfile::duration)
            .fold(0.0, f64::max);
        for ((task, limits), fastest) in axes.iter().zip(&fastest) {
            let profile = AxisProfile::lasting(task, limits, duration).unwrap();
            follow(task, limits, &profile);
            assert!(
                profile.duration() <= duration * (1.0 + 1e-9),
                "{task:?} {limits:?}"
            );
            assert!(
                profile.duration() >= fastest.duration() * (1.0 - 1e-6),
                "{task:?} {limits:?} {profile:?} {fastest:?}"
            );
            if profile.duration() >= duration * (1.0 - 1e-3) {
                in_time += 1
            } else {
                early += 1
            }
        }
        for (i, (task, limits)) in axes.iter().enumerate() {
            input.current_position[i] = 0.0;
            input.current_velocity[i] = task.velocity;
            input.current_acceleration[i] = task.acceleration;
            input.target_position[i] = task.distance;
            input.max_velocity[i] = limits.velocity;
            input.max_acceleration[i] = limits.acceleration;
            input.max_jerk[i] = limits.jerk;
        }
        let mut trajectory = Trajectory::new(None);
        if ruckig.calculate(&input, &mut trajectory).is_err() {
            failed += 1;
            continue;
        }
        compared += 1;
        // The reference takes a position within 1e-8 for the same: what the way between two such takes.
        let blur = axes
            .map(|(_, limits)| least_duration(2e-8, &limits))
            .into_iter()
            .fold(0.0, f64::max);
        let theirs = trajectory.get_duration();
        if theirs > 1e3 * blur {
            worst = worst.max(duration / theirs);
        }
        if duration < 0.999 * theirs {
            shorter += 1;
        }
        assert!(
            duration <= 1.001 * theirs + blur,
            "{duration} for {theirs}: {axes:?}"
        );
    }
    println!(
        "{compared} compared, {failed} that the reference gave up; longest {worst:.6} of its duration, {shorter} shorter by over 0.1 %; {in_time} axes in time, {early} early"
    );
    assert!(compared > cases / 2);
}

#[test]
fn what_can_not_be_used_is_refused() {
    let limits = AxisLimits {
        velocity: 1.0,
        acceleration: 1.0,
        jerk: 1.0,
    };
    let task = Task {
        distance: 1.0,
        velocity: 0.0,
        acceleration: 0.0,
    };
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for limits in [
            AxisLimits {
                velocity: bad,
                ..limits
            },
            AxisLimits {
                acceleration: bad,
                ..limits
            },
            AxisLimits {
                jerk: bad,
                ..limits
            },
        ] {
            assert_eq!(
                AxisProfile::fastest(&task, &limits),
                Err(Unusable::Limits),
                "{limits:?}"
            );
        }
    }
    for bad in [f64::NAN, f64::INFINITY, f64::MAX] {
        for task in [
            Task {
                distance: bad,
                ..task
            },
            Task {
                velocity: bad,
                ..task
            },
            Task {
                acceleration: bad,
                ..task
            },
        ] {
            let result = AxisProfile::fastest(&task, &limits);
            assert!(
                result == Err(Unusable::Task)
                    || bad == f64::MAX && result.is_ok_and(|p| p.duration().is_finite()),
                "{task:?} {result:?}"
            );
        }
    }
}

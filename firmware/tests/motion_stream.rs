//! Streams of targets and sampled paths: how near to the ideal path, what jitter and a foreign clock do, how they end.

mod motion_bench;

use firmware::motion::{Clock, Constraints, Position, PushError, Refusal, Stream, StreamEnd};
use motion_bench::streaming::{Run, Sender, run};
use motion_bench::*;
use std::f64::consts::{PI, TAU};

/// Ticks between targets at so many a second.
fn period(hz: f64) -> f64 {
    LIMITS.rate_hz / hz
}

/// A path: a pose in mm, mm and turns after so many seconds; it starts and ends at rest.
type Path = fn(f64) -> [f64; 3];

/// How far something has come that is brought to a rate of 1 in half a second, and to rest again before `end`.
fn gone(t: f64, end: f64) -> f64 {
    // The rate grows as u - sin(2 pi u) / (2 pi): no step in acceleration or jerk.
    let ramp = |t: f64| {
        let u = t.clamp(0.0, 0.5) / 0.5;
        0.5 * (u * u / 2.0 - (1.0 - (TAU * u).cos()) / (TAU * TAU))
    };
    let t = t.clamp(0.0, end);
    if t < 0.5 {
        ramp(t)
    } else if t < end - 0.5 {
        ramp(0.5) + (t - 0.5)
    } else {
        2.0 * ramp(0.5) + (end - 1.0) - ramp(end - t)
    }
}

const SECONDS: f64 = 3.0;

/// Circles of 20 mm, two a second: 250 mm/s would be over the limit, 188 mm/s is not; acceleration 1.8 m/s^2.
fn circle(t: f64) -> [f64; 3] {
    let angle = TAU * 1.5 * gone(t, SECONDS);
    [
        30.0 + 20.0 * angle.cos(),
        20.0 * angle.sin(),
        0.1 * gone(t, SECONDS),
    ]
}

/// A spiral from the middle to 25 mm, while the platform turns.
fn spiral(t: f64) -> [f64; 3] {
    let done = gone(t, SECONDS);
    let (radius, angle) = (8.0 * done, TAU * done);
    [radius * angle.cos(), radius * angle.sin(), 0.3 * done]
}

/// Lines of 20 mm at 100 mm/s, 1 mm apart, turned round in 0.1 s without a step in acceleration, which reaches 3.1
/// m/s^2.
fn raster(t: f64) -> [f64; 3] {
    const SPEED: f64 = 100.0;
    const LINE: f64 = 0.2;
    const TURN: f64 = 0.1;
    let t = gone(t, SECONDS);
    let number = (t / (LINE + TURN)).floor();
    let t = t - number * (LINE + TURN);
    let forth = number as i64 % 2 == 0;
    let (start, sign) = if forth { (-10.0, 1.0) } else { (10.0, -1.0) };
    if t <= LINE {
        return [start + sign * SPEED * t, number, 0.0];
    }
    let into = (t - LINE) / TURN;
    let x = -start + sign * SPEED * TURN / PI * (PI * into).sin();
    [x, number + into - (TAU * into).sin() / TAU, 0.0]
}

/// Targets that are made as the loop asks for them.
fn own(period: f64) -> Sender {
    Sender {
        clock: Clock::Own,
        ..Sender::steady(period)
    }
}

fn position(pose: [f64; 3]) -> Position {
    at(pose[0], pose[1], pose[2])
}

/// Targets along a path.
fn targets(path: Path, period: f64) -> impl Iterator<Item = Position> {
    let count = (SECONDS * LIMITS.rate_hz / period).ceil() as u64;
    (0..=count).map(move |k| position(path(k as f64 * period / LIMITS.rate_hz)))
}

/// Largest distance (um) and angle (urad) of the setpoint from the path, as late as the stream says it is.
fn errors(run: &Run, path: Path, period: f64) -> [f64; 2] {
    let mut worst = [0.0_f64; 2];
    let begin = run.started as usize;
    for (tick, at) in run.path[begin..].iter().enumerate() {
        // The curve starts three samples before the first target.
        let t = ((tick + 1) as f64 - 3.0 * period) / LIMITS.rate_hz;
        let [x, y, turns] = path(t.clamp(0.0, SECONDS));
        let away = (at[0] * 100.0 - x).hypot(at[1] * 100.0 - y) * 1e3;
        worst = [
            worst[0].max(away),
            worst[1].max((at[2] - turns).abs() * TAU * 1e6),
        ];
    }
    worst
}

#[test]
fn the_paths_are_what_they_claim() {
    for path in [circle, spiral, raster] as [Path; 3] {
        let h = 1e-5;
        let mut last: Option<[f64; 3]> = None;
        for k in 1..(SECONDS / h) as u64 {
            let t = k as f64 * h;
            let [a, b, c] = [path(t - h), path(t), path(t + h)];
            let force = [0, 1, 2].map(|i| (a[i] - 2.0 * b[i] + c[i]) / (h * h));
            if let Some(last) = last {
                // No step in acceleration: less than the jerk limit, 400 m/s^3, makes in that time.
                let step = (force[0] - last[0]).hypot(force[1] - last[1]);
                assert!(step < 1.17, "{t}: {step}");
            }
            last = Some(force);
        }
    }
}

#[test]
fn sampled_paths_are_followed() {
    let most_um: [(&str, Path, [f64; 4]); 3] = [
        ("circle", circle, [0.1, 2.5e-4, 5e-5, 5e-5]),
        ("spiral", spiral, [0.032, 1.5e-4, 5e-5, 5e-5]),
        ("raster", raster, [2.07, 0.0173, 2.2e-3, 3.8e-4]),
    ];
    println!("| path | targets a second | latency ms | error um | error urad |");
    println!("|---|---|---|---|---|");
    for (name, path, most) in most_um {
        for (hz, most) in [100.0, 500.0, 1_000.0, 2_000.0].into_iter().zip(most) {
            let period = period(hz);
            let run = run(
                position(path(0.0)),
                targets(path, period),
                &own(period),
                &CONSTRAINTS,
                false,
            );
            assert_eq!(run.end, Some(StreamEnd::Done), "{name} {hz}");
            assert_eq!(run.rest, position(path(SECONDS)), "{name} {hz}");
            let [um, urad] = errors(&run, path, period);
            let latency =
                Stream::new([0; 3], period, Clock::Own).unwrap().latency() as f64 / hz * 1e3;
            println!("| {name} | {hz} | {latency:.1} | {um:.5} | {urad:.3} |");
            assert!(um < most, "{name} {hz}: {um}");
            assert!(
                run.worst.is_kept_but_for_jerk(),
                "{name} {hz}: {:?}",
                run.worst
            );
        }
    }
}

/// Late by up to 1.8 periods, every target by its own part.
fn jitter(number: u64, period: f64) -> f64 {
    let random = number.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40;
    random as f64 / f64::from(1 << 24) * 1.8 * period
}

/// Largest distance from a circle about (30, 0) of 20 mm, um, from when it is under way.
fn off_circle(run: &Run) -> f64 {
    let about = |at: &[f64; 3]| (at[0] * 100.0 - 30.0).hypot(at[1] * 100.0) - 20.0;
    run.path
        .iter()
        .fold(0.0, |worst: f64, at| worst.max(about(at).abs() * 1e3))
}

/// Circles without an end, once round in 2/3 of a second.
fn circles(period: f64, seconds: f64) -> impl Iterator<Item = Position> {
    let count = (seconds * LIMITS.rate_hz / period) as u64;
    (0..=count).map(move |k| {
        let angle = TAU * 1.5 * gone(k as f64 * period / LIMITS.rate_hz, seconds);
        position([30.0 + 20.0 * angle.cos(), 20.0 * angle.sin(), 0.0])
    })
}

#[test]
fn jitter_and_a_foreign_clock_do_not_show() {
    // Without following the fastest would run dry, or over, in the time it has.
    for (hz, late, most_um, seconds) in [
        (100.0, (|k| jitter(k, 200.0)) as fn(u64) -> f64, 0.095, 5.0),
        (500.0, |k| jitter(k, 40.0), 2.5e-4, 5.0),
        (2_000.0, |k| jitter(k, 10.0), 5e-5, 20.0),
    ] {
        for ppm in [-500.0, 0.0, 500.0] {
            let period = period(hz);
            let sender = Sender {
                period,
                true_period: period * (1.0 + ppm * 1e-6),
                late,
                clock: Clock::Sender,
            };
            let start = position([50.0, 0.0, 0.0]);
            let run = run(
                start,
                circles(period, seconds),
                &sender,
                &CONSTRAINTS,
                false,
            );
            assert_eq!(run.end, Some(StreamEnd::Done), "{hz} {ppm}");
            let um = off_circle(&run);
            println!("{hz} Hz {ppm} ppm: {um:.5} um, waiting {:?}", run.waiting);
            assert!(um < most_um, "{hz} {ppm}: {um}");
            assert!(run.worst.is_kept_but_for_jerk(), "{:?}", run.worst);
            // Acceleration without a step: what the jerk makes in a tick.
            assert!(
                run.steps[1] < 4.0 * 400.0 / 0.1 / LIMITS.rate_hz,
                "{:?}",
                run.steps
            );
        }
    }
}

#[test]
fn a_stream_that_dries_up_stops_by_itself() {
    for hz in [100.0, 500.0, 1_000.0, 2_000.0] {
        let period = period(hz);
        let targets = targets(circle, period).take((1.3 * hz) as usize);
        let run = run(
            position(circle(0.0)),
            targets,
            &own(period),
            &CONSTRAINTS,
            true,
        );
        assert_eq!(run.end, Some(StreamEnd::Starved), "{hz}");
        assert!(run.worst.is_kept_but_for_jerk(), "{:?}", run.worst);
        // 188 mm/s take 4.4 mm of acceleration, and jerk.
        let last = circle(1.3 - 4.0 / hz);
        let [x, y] = [0, 1].map(|i| run.rest[i] as f64 / UNIT * 100.0);
        let way = (x - last[0]).hypot(y - last[1]);
        assert!((1.0..20.0).contains(&way), "{hz}: {way} mm");
    }
}

#[test]
fn a_target_that_comes_too_late_is_one_that_is_missing() {
    let sender = |late| Sender {
        late,
        ..Sender::steady(period(500.0))
    };
    let start = position([50.0, 0.0, 0.0]);
    let targets = || circles(period(500.0), 4.0);
    let late = |k| if k > 800 { 8.0 * 40.0 } else { 0.0 };
    assert_eq!(
        run(start, targets(), &sender(late), &CONSTRAINTS, false).end,
        Some(StreamEnd::Starved)
    );
    let late = |k| if k > 800 { 1.9 * 40.0 } else { 0.0 };
    assert_eq!(
        run(start, targets(), &sender(late), &CONSTRAINTS, false).end,
        Some(StreamEnd::Done)
    );
}

/// What ends a stream of poses, and that the stage is at rest inside then, all limits kept.
fn end_of(poses: impl Iterator<Item = [f64; 3]>, constraints: &Constraints) -> Option<StreamEnd> {
    let mut poses = poses.peekable();
    let start = position(*poses.peek().unwrap());
    let run = run(
        start,
        poses.map(position),
        &own(period(500.0)),
        constraints,
        false,
    );
    assert!(run.worst.is_kept_but_for_jerk(), "{:?}", run.worst);
    run.end
}

#[test]
fn targets_that_ask_for_too_much_end_the_stream() {
    let eased = |rate: f64| (0..1_500).map(move |k| rate * gone(k as f64 / 500.0, 3.0));
    let end = |poses: &mut dyn Iterator<Item = [f64; 3]>| end_of(poses, &CONSTRAINTS);
    // Along a line from (-60, 0): 190 mm/s are possible, 205 are not.
    let line = |mm_s: f64| {
        eased(mm_s)
            .map(|mm| [mm - 75.0, 0.0, 0.0])
            .take_while(|p| p[0] < 60.0)
    };
    assert_eq!(
        end(&mut line(205.0)),
        Some(StreamEnd::Refused(Refusal::Velocity))
    );
    // Stopping dead after 60 mm is not.
    let dead = end(&mut line(190.0));
    assert!(
        matches!(
            dead,
            Some(StreamEnd::Refused(
                Refusal::Acceleration | Refusal::Jerk | Refusal::Pivots
            ))
        ),
        "{dead:?}"
    );
    let outside = end(&mut line(90.0).chain([[80.1, 0.0, 0.0]]));
    let is_outside = |refusal| matches!(refusal, Refusal::OutsideDisk);
    assert!(
        matches!(outside, Some(StreamEnd::Refused(refusal)) if is_outside(refusal)),
        "{outside:?}"
    );
    // A jump of 0.1 mm at rest.
    let jump = [[0.0; 3]; 20].into_iter().chain([[0.1, 0.0, 0.0]; 20]);
    assert!(matches!(
        end(&mut jump.into_iter()),
        Some(StreamEnd::Refused(Refusal::Acceleration | Refusal::Jerk))
    ));
    // A turn a second at 70 mm is too fast for a pivot, at 40 mm it is not.
    let turn = |mm: f64| eased(0.99).map(move |turns| [mm, 0.0, turns]);
    assert_eq!(
        end(&mut turn(70.0)),
        Some(StreamEnd::Refused(Refusal::Pivots))
    );
    assert_eq!(end(&mut turn(40.0)), Some(StreamEnd::Done));
    // Round the rim: the stop from there would leave the disk. A millimetre inside it would not.
    let round = |mm: f64| {
        eased(0.25).map(move |turns| [mm * (TAU * turns).cos(), mm * (TAU * turns).sin(), 0.0])
    };
    assert_eq!(
        end(&mut round(79.99)),
        Some(StreamEnd::Refused(Refusal::NoRoomToStop))
    );
    assert_eq!(end(&mut round(79.0)), Some(StreamEnd::Done));
}

#[test]
fn bounds_and_a_centre_of_rotation_hold_for_streams() {
    let mut constraints = CONSTRAINTS;
    constraints.bounds[1] = [-(1 << 30), 1 << 30];
    let line =
        |mm: f64| (0..1_500).map(move |k| [0.0, mm * gone(k as f64 / 500.0, 3.0) / 2.5, 0.0]);
    assert_eq!(end_of(line(24.9), &constraints), Some(StreamEnd::Done));
    assert_eq!(
        end_of(line(25.1), &constraints),
        Some(StreamEnd::Refused(Refusal::OutOfBounds { axis: 1 }))
    );
    // About a point 60 mm from the platform's centre, at first in the middle: a third of a turn is too much.
    let mut constraints = CONSTRAINTS;
    constraints.rotation_centre = [0.6, 0.0];
    let turn = |turns: f64| {
        (0..1_500).map(move |k| [60.0, 0.0, turns * gone(k as f64 / 500.0, 3.0) / 2.5])
    };
    assert_eq!(end_of(turn(0.2), &constraints), Some(StreamEnd::Done));
    let end = end_of(turn(0.33), &constraints);
    assert!(
        matches!(
            end,
            Some(StreamEnd::Refused(
                Refusal::OutsideDisk | Refusal::NoRoomToStop
            ))
        ),
        "{end:?}"
    );
}

#[test]
fn what_a_stream_does_not_take() {
    assert!(Stream::new([0; 3], 9.9, Clock::Sender).is_none());
    assert!(Stream::new([0; 3], f64::NAN, Clock::Sender).is_none());
    let mut stream = Stream::new([0; 3], 20.0, Clock::Sender).expect("1 kHz");
    while stream.free_places() > 0 {
        assert_eq!(stream.push([0; 3], &CONSTRAINTS), Ok(()));
    }
    assert_eq!(stream.push([0; 3], &CONSTRAINTS), Err(PushError::Full));
    stream.finish();
    assert_eq!(stream.push([0; 3], &CONSTRAINTS), Err(PushError::Over));
    let mut stream = Stream::new([0; 3], 20.0, Clock::Sender).expect("1 kHz");
    let outside = stream.push(at(90.0, 0.0, 0.0), &CONSTRAINTS);
    assert!(matches!(
        outside,
        Err(PushError::Refused(Refusal::OutsideDisk))
    ));
    assert_eq!(stream.push([0; 3], &CONSTRAINTS), Err(PushError::Over));
}

//! The controlled stop, whatever is under way: a line, a turn about another centre, a stream, a waveform. It stays on the path that
//! the motion would have taken, within the limits of the motion, and in the workspace.

use firmware::mode::Mode;
use tests::Bench;

const TURN: f64 = 4_294_967_296.0;
const RADIUS_MM: f64 = 100.0;
/// Ticks of a controlled stop.
const STOP_TICKS: usize = 1_201;
/// How far the stop may be off the path, in track radii and rad: what it is, at most 0.4 nm or 4 nrad, and a tenth more.
const OFF: f64 = 4.1e-9;
/// The same for a stream: the command side's end of it is not taken any more, and the tick's own is a few um beside that.
const STREAM_OFF: f64 = 5.0e-5;
/// The same for a waveform, whose rest is not sent any more: 0.15 mm on a circle of 12 mm at 40 mm/s.
const WAVE_OFF: f64 = 1.68e-3;
/// Every stop is longer than this, in track radii and rad.
const WAY: f64 = 0.0106;

/// x and y in track radii, theta in rad.
type Place = [f64; 3];

fn place(bench: &Bench) -> Place {
    let [x, y, theta] = bench.sample().setpoint.position;
    let turns = theta as f64 / TURN;
    [
        x as f64 / TURN,
        y as f64 / TURN,
        turns * std::f64::consts::TAU,
    ]
}

fn minus(a: Place, b: Place) -> Place {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn size(a: Place) -> f64 {
    a.iter().map(|part| part * part).sum::<f64>().sqrt()
}

/// Distance from a path of many short pieces.
fn distance(path: &[Place], place: Place) -> f64 {
    path.windows(2)
        .map(|ends| {
            let along = minus(ends[1], ends[0]);
            let from = minus(place, ends[0]);
            let square = size(along).powi(2).max(f64::MIN_POSITIVE);
            let part = (0..3).map(|i| from[i] * along[i]).sum::<f64>() / square;
            let part = part.clamp(0.0, 1.0);
            size([0, 1, 2].map(|i| from[i] - part * along[i]))
        })
        .fold(f64::INFINITY, f64::min)
}

/// Stops a motion in the middle by a fault, beside a twin that goes on; `feed` sends what belongs to the motion at a tick.
fn assert_stop_on_path(
    what: &str,
    begin: &str,
    at: u32,
    most_off: f64,
    feed: impl Fn(&mut Bench, u32),
) {
    let start = || {
        let mut bench = Bench::ready();
        bench.say("CCL 1 ADVANCED\n");
        // A centre of rotation is taken where the platform's axes are the track's.
        for line in "MOV X 0 Y 0 W 0\nWAC ONT? W = 1"
            .lines()
            .chain(begin.lines())
        {
            assert_eq!(bench.error_after(line), "0", "{what}: {line}");
        }
        for tick in 0..at {
            feed(&mut bench, tick);
            bench.tick();
        }
        assert_eq!(bench.mode(), Mode::Moving, "{what}");
        bench
    };
    let mut twin = start();
    let mut path = vec![place(&twin)];
    for _ in 0..3 * STOP_TICKS {
        twin.tick();
        path.push(place(&twin));
    }
    assert_eq!(twin.fault(), None, "{what}");

    let mut bench = start();
    bench.forget_errors();
    bench.rig.front.late = true;
    bench.run_until("found", |bench| bench.mode() == Mode::Stopping);
    bench.rig.front.late = false;
    let first = place(&bench);
    let (mut ticks, mut off) = (0, 0.0_f64);
    let mut last = bench.sample().clone();
    while bench.mode() == Mode::Stopping {
        let now = place(&bench);
        off = off.max(distance(&path, now));
        assert!(now[0].hypot(now[1]) * RADIUS_MM < 80.01, "{what}: {now:?}");
        let sample = bench.sample().clone();
        assert!(
            sample.pivot_rates.iter().all(|rate| rate.abs() < 8.81),
            "{what}: {:?}",
            sample.pivot_rates
        );
        // What a limit of 4,000 mm/s^2 and of 7,200 deg/s^2 make of a tick, and the stop's own slowing.
        let jump = (f64::from(sample.setpoint.twist.x - last.setpoint.twist.x))
            .hypot(f64::from(sample.setpoint.twist.y - last.setpoint.twist.y));
        assert!(
            jump * 20_000.0 < 55.0,
            "{what}: {jump} track radii/s a tick"
        );
        last = sample;
        bench.tick();
        ticks += 1;
    }
    assert_eq!((bench.mode(), ticks), (Mode::Fault, STOP_TICKS), "{what}");
    let way = size(minus(place(&bench), first));
    println!("{what}: {off:.1e} off the path, {way:.4} on it");
    assert!(off < most_off, "{what}: {off:e}");
    assert!(way > WAY, "{what}: it hardly moved, {way:e}");
    assert!(
        bench.worst_error_counts() < 404,
        "{what}: {}",
        bench.worst_error_counts()
    );
    bench.run(2_000);
    let rates = bench.rig.front.stage.plant.pivot_rates_rad_s();
    assert!(rates.iter().all(|rate| rate.abs() < 1.51e-4), "{rates:?}");
}

#[test]
fn a_line_to_the_edge() {
    assert_stop_on_path("line", "MOV X 70 Y -38 W 100", 4_000, OFF, |_, _| {});
}

#[test]
fn a_turn_about_another_centre() {
    assert_stop_on_path("centre", "SPI R 25 S -10\nMVR W 170", 4_000, OFF, |_, _| {});
}

#[test]
fn a_constant_velocity() {
    assert_stop_on_path("velocity", "JOG X 20 Y -10 W 200", 4_000, OFF, |_, _| {});
}

/// A spiral, one target in 10 ms; the twin's stream dries up in the tick in which the other one is at fault.
#[test]
fn a_stream() {
    assert_stop_on_path(
        "stream",
        "SPA 1 0x19001900 1\nSCT T 10",
        6_000,
        STREAM_OFF,
        |bench, tick| {
            if tick % 200 == 0 {
                let turned = f64::from(tick) / 200.0 * 0.05;
                let (x, y) = (8.0 * (1.0 - turned.cos()), 8.0 * (turned - turned.sin()));
                bench.send(&format!("MOV X {x:.6} Y {y:.6}\n"));
            }
        },
    );
}

/// Its generator has sent a few milliseconds of it, which the stop follows; what comes then is the end of a stream that dries up.
#[test]
fn a_waveform() {
    assert_stop_on_path(
        "waveform",
        "WAV 1 X SIN_P 700 24 -12 700 0 350\nWAV 2 X SIN_P 700 24 -12 700 175 350\nWSL 1 1 2 2\nWGC 1 3 2 3\nWGO 1 1 2 1",
        9_000,
        WAVE_OFF,
        |_, _| {},
    );
}

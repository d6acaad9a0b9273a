//! The tool's point travels the straight line while the platform turns about it: on the simulated machine, by its own truth.

use firmware::mode::Mode;
use tests::Bench;

/// Where a point of the platform (mm, in its axes) is on the machine: x and y, mm.
fn point(bench: &Bench, [a, b]: [f64; 2]) -> [f64; 2] {
    let [x, y, theta] = bench.rig.front.stage.plant.pose();
    let (sin, cos) = theta.sin_cos();
    [x * 1e3 + cos * a - sin * b, y * 1e3 + sin * a + cos * b]
}

/// Largest distance (mm) of a platform's point from the line between two points while the motion lasts.
fn off_line(bench: &mut Bench, tool: [f64; 2], from: [f64; 2], to: [f64; 2]) -> f64 {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let length = dx.hypot(dy);
    let mut off = 0.0f64;
    while bench.mode() == Mode::Moving {
        bench.run(20);
        let [x, y] = point(bench, tool);
        let (x, y) = (x - from[0], y - from[1]);
        off = off.max(if length > 0.0 {
            ((x * dy - y * dx) / length).abs()
        } else {
            x.hypot(y)
        });
    }
    off
}

/// What the machine's own deviations leave of the following error, and a tenth more: of a tool's point on its line, of a centre of
/// rotation, and of a wave's circle, mm.
const TOOL_MM: f64 = 2.22e-3;
const CENTRE_MM: f64 = 1.46e-3;
const WAVE_MM: f64 = 3.93e-4;

#[test]
fn a_tools_point_travels_the_straight_line_while_the_platform_turns() {
    let mut bench = Bench::ready();
    for line in ["KST TIP X 25 Y -10", "KEN TIP"] {
        assert_eq!(bench.error_after(line), "0", "{line}");
    }
    let tool = [25.0, -10.0];
    let mut from = tool;
    for (line, to) in [
        ("MOV X 40 Y 15 W 120", [40.0, 15.0]),
        ("MOV X -10 Y 30 W -60", [-10.0, 30.0]),
        // On the spot.
        ("MOV W 300", [-10.0, 30.0]),
    ] {
        assert_eq!(bench.error_after(line), "0", "{line}");
        bench.run(10);
        let off = off_line(&mut bench, tool, from, to);
        println!("{line}: {off} mm off the line");
        assert!(off < TOOL_MM, "{line}: {off} mm");
        bench.settle();
        let [x, y] = point(&bench, tool);
        assert!((x - to[0]).hypot(y - to[1]) < 6.0e-6, "{line}: {x} {y}");
        from = to;
    }
    // The platform's centre has gone round.
    let [x, y] = point(&bench, [0.0, 0.0]);
    let away = (x - from[0]).hypot(y - from[1]);
    assert!((away - 725f64.sqrt()).abs() < 4.7e-6, "{away}");
}

#[test]
fn a_centre_of_rotation_stays_where_it_is() {
    let mut bench = Bench::ready();
    for line in [
        "MOV X 5 Y 5 W 0",
        "WAC ONT? W = 1",
        "SPI R 30 S 0",
        "MOV W 720",
    ] {
        assert_eq!(bench.error_after(line), "0", "{line}");
    }
    bench.run(10);
    let off = off_line(&mut bench, [30.0, 0.0], [35.0, 5.0], [35.0, 5.0]);
    println!("the centre of rotation strays {off} mm");
    assert!(off < CENTRE_MM, "{off} mm");
    bench.settle();
    assert!((bench.value("POS? X") - 5.0).abs() < 6.6e-6);
    let off_deg = (bench.value("POS? W") - 720.0).abs();
    assert!(off_deg < 5.4e-6, "{off_deg} deg");
}

#[test]
fn a_wave_is_drawn_by_the_machine() {
    let mut bench = Bench::ready();
    for line in [
        "WAV 1 X SIN_P 1000 20 -10 1000 0 500",
        "WAV 2 X SIN_P 1000 20 -10 1000 250 500",
        "WSL 1 1 2 2",
        "WGC 1 2 2 2",
        "MOV X -10 Y 0",
        "WAC ONT? W = 1",
        "WGO 1 1 2 1",
    ] {
        assert_eq!(bench.error_after(line), "0", "{line}");
    }
    bench.run_until("the wave begins", |bench| bench.mode() == Mode::Moving);
    let mut off = 0.0f64;
    while bench.mode() == Mode::Moving {
        bench.run(20);
        let [x, y] = point(&bench, [0.0, 0.0]);
        off = off.max((x.hypot(y) - 10.0).abs());
    }
    println!("{off} mm off the circle");
    assert!(off < WAVE_MM, "{off} mm off the circle");
    assert_eq!(bench.say("ERR?\n"), "0\n");
}

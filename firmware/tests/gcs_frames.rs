//! Frames and the centre of rotation by command: what queries answer, what is refused, and where the platform is.

mod gcs_bench;

use gcs_bench::Bench;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// mm and deg: what rounding to the tick's units makes of a place.
const PLACE: f64 = 3e-7;

/// A planar transform as a matrix: written down again, not the command side's own.
#[derive(Clone, Copy, Debug)]
struct Matrix([[f64; 3]; 2]);

impl Matrix {
    fn new(x: f64, y: f64, w_deg: f64) -> Self {
        let (sin, cos) = w_deg.to_radians().sin_cos();
        Self([[cos, -sin, x], [sin, cos, y]])
    }

    fn times(&self, other: &Self) -> Self {
        let (Self(a), Self(b)) = (self, other);
        let part = |i: usize, j: usize| {
            a[i][0] * b[0][j] + a[i][1] * b[1][j] + if j == 2 { a[i][2] } else { 0.0 }
        };
        Self([0, 1].map(|i| [0, 1, 2].map(|j| part(i, j))))
    }

    fn is_near(&self, other: &Self) -> bool {
        let (Self(a), Self(b)) = (self, other);
        a.iter()
            .flatten()
            .zip(b.iter().flatten())
            .all(|(a, b)| (a - b).abs() < 3e-6)
    }
}

/// Where the tick has the platform: x, y, mm, and theta, deg.
fn platform(bench: &Bench) -> [f64; 3] {
    let now = &bench.tick.now;
    let [x, y, theta] = now.centre.to_platform(&now.setpoint);
    let unit = 1.0 / 4_294_967_296.0;
    [
        x as f64 * unit * 100.0,
        y as f64 * unit * 100.0,
        theta as f64 * unit * 360.0,
    ]
}

fn matrix([x, y, w]: [f64; 3]) -> Matrix {
    Matrix::new(x, y, w)
}

/// The three values of a query of all axes.
fn place(bench: &mut Bench, query: &str) -> [f64; 3] {
    ["X", "Y", "W"].map(|axis| bench.value(&format!("{query} {axis}")))
}

fn assert_near(left: [f64; 3], right: [f64; 3]) {
    for (a, b) in left.iter().zip(right) {
        assert!((a - b).abs() < PLACE, "{left:?} {right:?}");
    }
}

fn say_all(bench: &mut Bench, lines: &[&str]) {
    for line in lines {
        assert_eq!(bench.error_after(line), "0", "{line}");
    }
}

#[test]
fn what_the_queries_answer() {
    let mut bench = Bench::ready();
    assert_eq!(
        bench.say("KEN?\nKET?\nKLN?\nKLT?\n"),
        "ZERO=KSD\nKSD=ZERO\nZERO=ZERO\nZERO X=0 \nZERO Y=0 \nZERO Z=0 \nZERO U=0 \nZERO V=0 \nZERO W=0\n"
    );
    assert_eq!(bench.say("SPI?\nSPI? S\n"), "R=0 \nS=0 \nT=0\nS=0\n");
    say_all(
        &mut bench,
        &[
            "KSW table X 10 Y -5 W 90",
            "KSW SAMPLE_2 X 1",
            "KST probe X 20",
            "KLN sample_2 Table",
            "KEN Sample_2",
        ],
    );
    assert_eq!(bench.say("KEN?\nKET?\n"), "SAMPLE_2=KSW\nKSW=SAMPLE_2\n");
    say_all(&mut bench, &["KEN PROBE"]);
    assert_eq!(
        bench.say("KEN?\nKET?\nKEN? TABLE\nKEN? PROBE\nKET? KST\nKET? ksf\n"),
        "SAMPLE_2=KSW \nPROBE=KST\nKST=PROBE \nKSW=SAMPLE_2\nTABLE=\nPROBE=KST\nKST=PROBE\nKSF=\n"
    );
    assert_eq!(
        bench.say("KLN?\n"),
        "ZERO=ZERO \nTABLE=ZERO \nSAMPLE_2=TABLE ZERO \nPROBE=ZERO\n"
    );
    assert_eq!(
        bench.say("KLS? TABLE\n"),
        "TABLE TYPE=KSW \nTABLE PARENT=ZERO \nTABLE ENABLED=0 \nTABLE POS X=10 \nTABLE POS Y=-5 \nTABLE POS Z=0 \n\
         TABLE POS U=0 \nTABLE POS V=0 \nTABLE POS W=90\n"
    );
    assert_eq!(
        bench.say("KLS? SAMPLE_2 PARENT\nKLS? TABLE pos w\nKLS? ZERO TYPE\n"),
        "SAMPLE_2 PARENT=TABLE\nTABLE POS W=90\nZERO TYPE=KSD\n"
    );
    // A quarter of a turn is exact: x of the sample is y of the table.
    assert_eq!(
        bench.say("KLT? SAMPLE_2\n"),
        "SAMPLE_2 X=10 \nSAMPLE_2 Y=-4 \nSAMPLE_2 Z=0 \nSAMPLE_2 U=0 \nSAMPLE_2 V=0 \nSAMPLE_2 W=90\n"
    );
    assert_eq!(
        bench.say("KLT? SAMPLE_2 TABLE\n"),
        "SAMPLE_2 X=1 \nSAMPLE_2 Y=0 \nSAMPLE_2 Z=0 \nSAMPLE_2 U=0 \nSAMPLE_2 V=0 \nSAMPLE_2 W=0\n"
    );
    say_all(&mut bench, &["KEN 0", "KRM PROBE", "KLN SAMPLE_2 ZERO"]);
    assert_eq!(
        bench.say("KEN?\nKLN?\n"),
        "ZERO=KSD\nZERO=ZERO \nTABLE=ZERO \nSAMPLE_2=ZERO\n"
    );
    // Nothing has moved.
    assert_near(place(&mut bench, "POS?"), [0.0; 3]);
    assert_eq!(bench.tick.log, ["centre", "centre"]);
}

#[test]
fn what_is_refused() {
    let mut bench = Bench::ready();
    say_all(
        &mut bench,
        &["KSW A X 1", "KST B X 2", "KSW C", "KLN C A", "KEN C"],
    );
    for (line, error) in [
        ("KSW", "24"),
        ("KSW 1A X 1", "17"),
        ("KSW A-B X 1", "17"),
        ("KSW ABCDEFGHIJKLMNOPQ X 1", "17"),
        ("KSW D X", "24"),
        ("KSW D X 1 X 2", "22"),
        ("KSW D Q 1", "15"),
        ("KSW D Z 1", "34"),
        ("KSW ZERO X 1", "34"),
        // C is enabled, and A is what it lies in.
        ("KSW C X 1", "34"),
        ("KSW A X 2", "34"),
        ("KRM A", "34"),
        ("KLN C ZERO", "34"),
        ("KLN A B", "34"),
        ("KLN B A", "34"),
        ("KLN B B", "17"),
        ("KLN B NONE", "17"),
        ("KLN NONE B", "17"),
        ("KLN B", "24"),
        ("KLN B A C", "24"),
        ("KRM NONE", "17"),
        ("KRM ZERO", "34"),
        ("KEN NONE", "17"),
        ("KEN", "24"),
        ("KEN? NONE", "17"),
        ("KET? KSX", "17"),
        ("KLS? A COLOUR", "17"),
        ("KLS? A POS Q", "15"),
        ("KLT? A C", "17"),
        ("SPI", "24"),
        ("SPI R", "24"),
        ("SPI X 1", "15"),
        ("SPI R 1 R 2", "22"),
        ("SPI T 1", "17"),
        ("SPI? Q", "15"),
        // A work frame is enabled.
        ("SPI R 1", "9"),
    ] {
        assert_eq!(bench.error_after(line), error, "{line}");
    }
    assert_eq!(
        bench.say("KLN?\n"),
        "ZERO=ZERO \nA=ZERO \nB=ZERO \nC=A ZERO\n"
    );
    say_all(&mut bench, &["KEN 0", "SPI R 99.9", "SPI R 0"]);
    for (line, error) in [("SPI R 100.1", "17"), ("SPI R 80 S 80", "17")] {
        assert_eq!(bench.error_after(line), error, "{line}");
    }
    say_all(&mut bench, &["KST FAR X 101", "KSW MOON X 3.8e11"]);
    assert_eq!(bench.error_after("KEN FAR"), "17");
    assert_eq!(bench.error_after("KEN MOON"), "17");
    assert_eq!(bench.say("KEN?\nSPI? R\n"), "ZERO=KSD\nR=0\n");
    // Sixteen and no more.
    for i in 0..11 {
        say_all(&mut bench, &[&format!("KSW N{i}")]);
    }
    assert_eq!(bench.error_after("KSW ONEMORE"), "17");
    assert_eq!(bench.error_after("KSW N5 X 3"), "0");
}

#[test]
fn a_chain_has_no_circle() {
    let mut bench = Bench::ready();
    say_all(
        &mut bench,
        &["KSW A", "KSW B", "KSW C", "KLN B A", "KLN C B"],
    );
    for line in ["KLN A C", "KLN A B", "KLN A A"] {
        assert_eq!(bench.error_after(line), "17", "{line}");
    }
    // A parent stays a parent, and of the same type.
    assert_eq!(bench.error_after("KRM A"), "34");
    assert_eq!(bench.error_after("KST A X 1"), "34");
    assert_eq!(bench.error_after("KSW A X 1"), "0");
}

#[test]
fn nothing_changes_in_motion() {
    let mut bench = Bench::ready();
    say_all(&mut bench, &["KSW A X 1", "MOV X 20"]);
    for line in ["KEN A", "KEN ZERO", "KSF HERE", "SPI R 1"] {
        assert_eq!(bench.error_after(line), "93", "{line}");
    }
    bench.run_to_rest();
    assert_eq!(bench.say("KEN?\n"), "ZERO=KSD\n");
    assert!((platform(&bench)[0] - 20.0).abs() < PLACE);
    say_all(&mut bench, &["KEN A"]);
    bench
        .tick
        .fail(firmware::fault::FaultKind::EmergencyStop, None);
    bench.run(1);
    bench.say("ERR?\n");
    assert_eq!(bench.error_after("KEN 0"), "1024");
    assert_eq!(bench.say("KEN?\n"), "A=KSW\n");
}

#[test]
fn targets_are_in_the_work_frame() {
    let mut bench = Bench::ready();
    say_all(&mut bench, &["MOV X 12.5 W 30", "KSW A X 10 Y 20 W 90"]);
    bench.run_to_rest();
    say_all(&mut bench, &["KEN A"]);
    // 2.5 to the right of the frame's origin and 20 below, seen from a frame that is turned to the left.
    assert_near(place(&mut bench, "MOV?"), [-20.0, -2.5, -60.0]);
    assert_near(place(&mut bench, "POS?"), [-20.0, -2.5, -60.0]);
    say_all(&mut bench, &["MOV X 3"]);
    bench.run_to_rest();
    assert_eq!(bench.say("MOV? X\n"), "X=3\n");
    assert_near(place(&mut bench, "POS?"), [3.0, -2.5, -60.0]);
    assert_near(platform(&bench), [12.5, 23.0, 30.0]);
    // Soft limits stay those of the base frame; the travel is seen from the work frame.
    assert_eq!(
        bench.say("NLM? X\nTMN? X Y\nTMX? W\n"),
        "X=-80\nX=-100 \nY=-70\nW=3599910\n"
    );
    say_all(&mut bench, &["PLM Y 30"]);
    assert_eq!(bench.error_after("MOV X 10.1"), "7");
    assert_eq!(
        bench.say("VMO? X 10.1\nVMO? X 10\nTRA? X 1\n"),
        "0\n1\nX=10\n"
    );
    assert_eq!(bench.error_after("MOV X 10"), "0");
}

#[test]
fn the_tool_is_what_moves() {
    let mut bench = Bench::ready();
    say_all(&mut bench, &["KST PROBE X 30", "KEN PROBE"]);
    assert_near(place(&mut bench, "POS?"), [30.0, 0.0, 0.0]);
    say_all(&mut bench, &["MOV W 90"]);
    // The tool's point stays where it is while the platform turns about it.
    for _ in 0..60 {
        bench.run(100);
        let [x, y, theta] = platform(&bench);
        let (sin, cos) = theta.to_radians().sin_cos();
        assert!((x + 30.0 * cos - 30.0).abs() < PLACE, "{x} {theta}");
        assert!((y + 30.0 * sin).abs() < PLACE, "{y} {theta}");
    }
    bench.run_to_rest();
    assert_near(place(&mut bench, "POS?"), [30.0, 0.0, 90.0]);
    assert_near(platform(&bench), [30.0, -30.0, 90.0]);
    // In the tool's axes: its x is the base frame's y now.
    say_all(&mut bench, &["MRT X 5"]);
    bench.run_to_rest();
    assert_near(place(&mut bench, "POS?"), [30.0, 5.0, 90.0]);
    say_all(&mut bench, &["MRW X 5 W 10"]);
    bench.run_to_rest();
    assert_near(place(&mut bench, "POS?"), [35.0, 5.0, 100.0]);
}

#[test]
fn the_centre_of_rotation() {
    let mut bench = Bench::ready();
    say_all(&mut bench, &["MOV X 5 Y -3 W 720"]);
    bench.run_to_rest();
    say_all(&mut bench, &["SPI R 20 S 10"]);
    // At whole turns nothing is changed by it.
    assert_near(place(&mut bench, "POS?"), [5.0, -3.0, 720.0]);
    assert_near(place(&mut bench, "MOV?"), [5.0, -3.0, 720.0]);
    assert_near(platform(&bench), [5.0, -3.0, 720.0]);
    assert_eq!(bench.say("SPI?\n"), "R=20 \nS=10 \nT=0\n");
    say_all(&mut bench, &["MOV W 810"]);
    bench.run_to_rest();
    assert_near(place(&mut bench, "POS?"), [5.0, -3.0, 810.0]);
    // R p = (-10, 20): the point stays at (25, 7).
    assert_near(platform(&bench), [35.0, -13.0, 810.0]);
    // It lies in the platform's own axes: at any orientation it can be set, and nothing moves. X and Y are those of another
    // point then, which lies at (25, -13).
    say_all(&mut bench, &["SPI R 0 T 0"]);
    assert_eq!(bench.say("SPI?\n"), "R=0 \nS=10 \nT=0\n");
    assert_near(platform(&bench), [35.0, -13.0, 810.0]);
    assert_near(place(&mut bench, "POS?"), [25.0, -23.0, 810.0]);
    assert_near(place(&mut bench, "MOV?"), [25.0, -23.0, 810.0]);
    say_all(&mut bench, &["MOV W 0"]);
    bench.run_to_rest();
    assert_near(place(&mut bench, "POS?"), [25.0, -23.0, 0.0]);
    assert_near(platform(&bench), [25.0, -23.0, 0.0]);
    say_all(&mut bench, &["SPI R 20 S 0"]);
    assert_eq!(bench.say("SPI?\n"), "R=20 \nS=0 \nT=0\n");
    assert_eq!(bench.error_after("SPI T 1"), "17");
    assert_near(place(&mut bench, "POS?"), [25.0, -23.0, 0.0]);
    // It counts beside a directed frame, not beside a tool.
    say_all(&mut bench, &["KSD D X 1", "KEN D", "KSW A", "KEN A"]);
    assert_eq!(bench.say("SPI? R\n"), "R=0\n");
    assert_near(place(&mut bench, "POS?"), [25.0, -23.0, 0.0]);
}

/// The platform stays where it is to the unit, wherever it stands and whatever point is chosen.
#[test]
fn another_centre_of_rotation_moves_nothing() {
    let mut bench = Bench::new();
    bench.tick.place(12.0, -7.0, 0.000_002);
    say_all(&mut bench, &["FRF"]);
    for target in ["MOV X 12 Y -7 W 0", "MOV W 33", "MOV X 5 Y 20 W -721.5"] {
        say_all(&mut bench, &[target]);
        bench.run_to_rest();
        let now = &bench.tick.now;
        let before = now.centre.to_platform(&now.setpoint);
        for line in ["SPI R 20 S 10", "SPI R -35", "SPI R 0 S 0"] {
            say_all(&mut bench, &[line]);
            let now = &bench.tick.now;
            assert_eq!(now.centre.to_platform(&now.setpoint), before, "{line}");
        }
    }
}

#[test]
fn soft_limits_do_not_mind_the_centre_of_rotation() {
    let mut bench = Bench::ready();
    say_all(&mut bench, &["NLM X -10", "PLM X 10", "SPI R 50"]);
    assert_eq!(bench.say("NLM? X\nPLM? X\n"), "X=-10\nX=10\n");
    assert_eq!(bench.error_after("MOV X 10.1"), "7");
    say_all(&mut bench, &["MOV X 10"]);
    bench.run_to_rest();
    assert_near(place(&mut bench, "POS?"), [10.0, 0.0, 0.0]);
    say_all(&mut bench, &["MOV X 0"]);
    bench.run_to_rest();
    // Where the platform is turned, X is that of another point, and may lie outside.
    say_all(&mut bench, &["MOV W 90"]);
    bench.run_to_rest();
    assert_eq!(bench.error_after("SPI R 0"), "27");
    assert_eq!(bench.say("SPI? R\n"), "R=50\n");
    // A tool's point is far outside them, in the base frame.
    say_all(&mut bench, &["KST T X 50"]);
    assert_eq!(bench.error_after("KEN T"), "27");
    assert_eq!(bench.say("KEN?\n"), "ZERO=KSD\n");
}

#[test]
fn a_frame_at_the_current_position() {
    let mut bench = Bench::new();
    assert_eq!(bench.error_after("KSF EARLY"), "5");
    let mut bench = Bench::ready();
    say_all(&mut bench, &["MOV X 20 Y 10 W 400"]);
    bench.run_to_rest();
    say_all(&mut bench, &["KSF HERE", "KEN HERE"]);
    assert_near(place(&mut bench, "POS?"), [0.0; 3]);
    say_all(&mut bench, &["MOV X 5 W -40"]);
    bench.run_to_rest();
    let (sin, cos) = 40f64.to_radians().sin_cos();
    assert_near(
        platform(&bench),
        [20.0 + 5.0 * cos, 10.0 + 5.0 * sin, 360.0],
    );
}

#[test]
fn frames_before_the_reference_hold_after_it() {
    let mut bench = Bench::new();
    bench.tick.place(12.0, -7.0, 33.0);
    say_all(&mut bench, &["KST T X 10", "KEN T", "FRF"]);
    bench.run_to_rest();
    let (sin, cos) = 33f64.to_radians().sin_cos();
    let there = [12.0 + 10.0 * cos, -7.0 + 10.0 * sin, 33.0];
    assert_near(place(&mut bench, "POS?"), there);
    assert_near(place(&mut bench, "MOV?"), there);
}

#[test]
fn which_way_round_is_a_parameter() {
    for (way, w) in [(0, 350.0), (1, -10.0), (2, 350.0), (3, -370.0)] {
        let mut bench = Bench::ready();
        say_all(
            &mut bench,
            &[&format!("SPA 1 0x54500110 {way}"), "MOV W 10"],
        );
        bench.run_to_rest();
        say_all(&mut bench, &["MOV W 350"]);
        assert_eq!(bench.value("MOV? W"), w, "{way}");
        // Relative moves are what they say, and other axes turn nothing.
        say_all(&mut bench, &["MVR W 400", "MOV X 1"]);
        assert_eq!(bench.value("MOV? W"), w + 400.0, "{way}");
        bench.run_to_rest();
    }
    let mut bench = Bench::ready();
    assert_eq!(bench.error_after("SPA 1 0x54500110 4"), "17");
    assert_eq!(bench.say("SPA? 1 0x54500110\n"), "1 0x54500110=0\n");
    // Where it is already, no turn is made.
    say_all(&mut bench, &["SPA 1 0x54500110 2", "MOV W 0"]);
    assert_eq!(bench.value("MOV? W"), 0.0);
    say_all(&mut bench, &["KSW A W 30", "KEN A", "MOV W 0"]);
    assert_eq!(bench.value("MOV? W"), 0.0);
    bench.run_to_rest();
    assert_near(platform(&bench), [0.0, 0.0, 30.0]);
}

fn frame() -> impl Strategy<Value = [f64; 3]> {
    (-40.0..40.0, -40.0..40.0, -400.0..400.0).prop_map(|(x, y, w)| [x, y, w])
}

fn values([x, y, w]: [f64; 3]) -> String {
    format!("X {x} Y {y} W {w}")
}

proptest! {
    // The same cases in every run.
    #![proptest_config(ProptestConfig {
        cases: 24,
        rng_seed: RngSeed::Fixed(20_260_214),
        ..ProptestConfig::default()
    })]

    /// Targets in chains of frames: what was commanded is what is measured, and the platform is where matrices put it.
    #[test]
    fn targets_in_chains(
        outer in frame(), inner in frame(), holder in frame(), tip in frame(), pose in (-20.0..20.0, -20.0..20.0, -500.0..500.0),
    ) {
        let (holder, tip) = (holder.map(|v| v / 2.0), tip.map(|v| v / 4.0));
        let mut bench = Bench::ready();
        for line in [
            format!("KSW OUTER {}", values(outer)),
            format!("KSW INNER {}", values(inner)),
            "KLN INNER OUTER".into(),
            format!("KST HOLDER {}", values(holder)),
            format!("KST TIP {}", values(tip)),
            "KLN TIP HOLDER".into(),
            "KEN INNER".into(),
            "KEN TIP".into(),
        ] {
            prop_assert_eq!(bench.error_after(&line), "0", "{}", line);
        }
        let work = matrix(outer).times(&matrix(inner));
        let tool = matrix(holder).times(&matrix(tip));
        // A target whose pose is a good one: the platform at `pose`.
        let good = matrix([pose.0, pose.1, pose.2]).times(&tool);
        let w_deg = pose.2 + holder[2] + tip[2] - outer[2] - inner[2];
        let Matrix([[cos, _, wx], [sin, _, wy]]) = work;
        let [dx, dy] = [good.0[0][2] - wx, good.0[1][2] - wy];
        let target = [cos * dx + sin * dy, cos * dy - sin * dx, w_deg];
        prop_assert_eq!(bench.error_after(&format!("MOV {}", values(target))), "0");
        bench.run_to_rest();
        let there = place(&mut bench, "POS?");
        for (there, target) in there.iter().zip(target) {
            prop_assert!((there - target).abs() < PLACE, "{} {}", there, target);
        }
        let at = matrix(platform(&bench));
        prop_assert!(at.times(&tool).is_near(&work.times(&matrix(target))));
        // Back in the base frame it is still there.
        prop_assert_eq!(bench.error_after("KEN 0"), "0");
        let there = place(&mut bench, "POS?");
        prop_assert!((there[2] - pose.2).abs() < 7.5e-8, "{:?} {:?}", there, pose);
        // Two roundings of sines to 2^-29, times the tool's length.
        prop_assert!((there[0] - pose.0).abs() < 4e-7 && (there[1] - pose.1).abs() < 4e-7);
    }

    /// What `VMO?` and `TRA?` answer is what `MOV` meets, with any frames: a target is taken exactly when `VMO?` says
    /// so, the end that `TRA?` tells can be moved to, and nothing further out.
    #[test]
    fn queries_are_what_a_move_meets(
        work in frame(), tool in frame(), first in (-1.0..1.0, -1.0..1.0, -180.0..180.0),
        target in (-100.0..100.0, -100.0..100.0, -180.0..180.0), way in (-1.0..1.0, -1.0..1.0, -3.0..3.0),
    ) {
        let mut bench = Bench::ready();
        let tool = [tool[0] / 2.0, tool[1] / 2.0, tool[2]];
        for line in [
            format!("KSW A {}", values(work)),
            format!("KST B {}", values(tool)),
            "KEN A".into(),
            "KEN B".into(),
            format!("MRT X {} Y {} W {}", 10.0 * first.0, 10.0 * first.1, first.2),
        ] {
            prop_assert_eq!(bench.error_after(&line), "0", "{}", line);
        }
        bench.run_to_rest();
        let [x, y, w] = place(&mut bench, "MOV?");
        let target = values([x + target.0, y + target.1, w + target.2]);
        let reachable = bench.say(&format!("VMO? {target}\n"));
        let error = bench.error_after(&format!("MOV {target}"));
        prop_assert_eq!(reachable == "1\n", error == "0", "{} {}", reachable, error);
        bench.run_to_rest();

        let from = place(&mut bench, "MOV?");
        let way = [way.0, way.1, way.2];
        let answer = bench.say(&format!("TRA? {}\n", values(way)));
        let end: Vec<f64> = answer
            .split_whitespace()
            .map(|part| part.split_once('=').unwrap().1.parse().unwrap())
            .collect();
        let further = [0, 1, 2].map(|i| end[i] + 1e-3 * way[i]);
        prop_assert_eq!(bench.say(&format!("VMO? {}\n", values(further))), "0\n", "{:?} {:?}", from, end);
        let end = [end[0], end[1], end[2]];
        prop_assert_eq!(bench.error_after(&format!("MOV {}", values(end))), "0", "{:?} {:?}", from, end);
        bench.run_to_rest();
        let there = place(&mut bench, "POS?");
        for (there, end) in there.iter().zip(end) {
            prop_assert!((there - end).abs() < PLACE, "{} {}", there, end);
        }
    }

    /// A directed frame is a work and a tool frame at the same place.
    #[test]
    fn a_directed_frame_is_a_pair(at in frame(), target in (-20.0..20.0, -20.0..20.0, -90.0..90.0)) {
        let mut places = Vec::new();
        for frames in [
            vec![format!("KSD D {}", values(at)), "KEN D".into()],
            vec![
                format!("KSW W {}", values(at)),
                format!("KST T {}", values(at)),
                "KEN W".into(),
                "KEN T".into(),
            ],
        ] {
            let mut bench = Bench::ready();
            for line in frames {
                prop_assert_eq!(bench.error_after(&line), "0", "{}", line);
            }
            let zero = place(&mut bench, "POS?");
            prop_assert!(zero.iter().all(|v| v.abs() < PLACE), "{:?}", zero);
            let line = format!("MOV {}", values([target.0 / 4.0, target.1 / 4.0, target.2 / 4.0]));
            let error = bench.error_after(&line);
            bench.run_to_rest();
            places.push((error, platform(&bench)));
        }
        prop_assert_eq!(&places[0].0, &places[1].0);
        for (a, b) in places[0].1.iter().zip(places[1].1) {
            prop_assert!((a - b).abs() < PLACE, "{:?}", places);
        }
    }
}

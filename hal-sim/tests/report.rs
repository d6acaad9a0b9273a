//! The report of a run made up here: what is written, what is printed, and that no run is too odd for it.

use std::fs;
use std::path::PathBuf;

use drawing::colour;
use firmware::parameters::Parameters;
use hal_sim::report::{Conditions, FILES, MotionSample, Move, Run, Sample, Trace};
use kinematics::{Geometry, Pose, inverse, margins};

/// Circling at 50 mm with two ticks of standstill at either end.
fn sample(tick: u32, ticks: u32) -> Sample {
    let angle = f64::from(tick) / f64::from(ticks) * 6.0;
    let pose = Pose {
        x: 0.5 * angle.cos(),
        y: 0.5 * angle.sin(),
        theta: 2.0 * angle,
    };
    let geometry = Geometry::REFERENCE;
    let pivots = inverse(&pose).expect("inside the track").pivots;
    let room_rad = margins(&geometry, &pose)
        .expect("inside the track")
        .separation_rad;
    let place = [100.0 * pose.x, 100.0 * pose.y, pose.theta.to_degrees()];
    Sample {
        time_s: f64::from(tick) * 50e-6,
        moving: (2..ticks - 2).contains(&tick),
        setpoint: place,
        setpoint_rate: [0.0; 3],
        pose: place,
        following_error: [0.06, -0.08, 1.0],
        true_error: [0.3, -0.4, 2.0],
        pivot_setpoint_deg: pivots.map(f64::to_degrees),
        pivot_rate_rad_s: [0.0; 3],
        motion: MotionSample {
            translation: [200.0, 4_000.0, 400_000.0],
            ..MotionSample::default()
        },
        pivot_error_lsb: [1.0; 3],
        duty: [0.25, -0.5, 0.125],
        integral_v: [0.5, -1.25, 0.0],
        model_current_a: [0.0, 0.75, -2.0],
        learnt_rate_v_s_rad: [0.0; 3],
        learnt_torque_v_n_m: [0.0; 3],
        learnt_friction_v: [0.0, 0.0, 0.125],
        separation_deg: (room_rad + geometry.separation_rad).to_degrees(),
    }
}

fn run(ticks: u32, every: u32) -> Run {
    let mut trace = Trace::new(every);
    (0..ticks).for_each(|tick| trace.record(&sample(tick, ticks)));
    let one = |number: u32| Move {
        start_s: f64::from(number),
        profile_end_s: f64::from(number) + 0.5,
        settled_s: (number != 1).then_some(f64::from(number) + 0.51),
        target: [1.0, -2.0, 720.0],
    };
    Run {
        name: "made up".to_owned(),
        geometry: Geometry::REFERENCE,
        limits: Parameters::REFERENCE.limits,
        trace,
        moves: (0..3).map(one).collect(),
        conditions: Conditions {
            program: "made up 1.2".to_owned(),
            machine: "none at all".to_owned(),
            seed: 3,
            mismatch_percent: 60.0,
            payload_kg: 2.5,
            without: vec!["backlash"],
            ..Conditions::default()
        },
        wall_s: 0.01,
    }
}

/// A fresh folder of this test's own.
fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("report-{name}"));
    let _ = fs::remove_dir_all(&folder);
    folder
}

#[test]
fn the_files_are_written_the_same_each_time() {
    let (first, second) = (folder("first"), folder("second").join("below"));
    for folder in [&first, &second] {
        run(1_001, 20)
            .write(folder)
            .expect("the folder can be written");
    }
    for file in FILES {
        let bytes = fs::read(first.join(file)).expect(file);
        assert!(!bytes.is_empty());
        assert!(
            bytes == fs::read(second.join(file)).expect(file),
            "{file} differs"
        );
    }
    let count = fs::read_dir(&first).expect("a folder").count();
    assert_eq!(count, FILES.len());
}

#[test]
fn the_tables_hold_what_was_recorded() {
    let folder = folder("tables");
    run(1_001, 20)
        .write(&folder)
        .expect("the folder can be written");
    let trace = fs::read_to_string(folder.join("trace.csv")).expect("the trace");
    let rows: Vec<Vec<&str>> = trace
        .lines()
        .map(|line| line.split(',').collect())
        .collect();
    assert_eq!(rows.len(), 1 + 51);
    let cell = |row: usize, name: &str| {
        let column = rows[0].iter().position(|heading| *heading == name);
        rows[row][column.expect(name)]
    };
    assert_eq!(cell(2, "time_s"), "0.001000");
    assert_eq!((cell(1, "moving"), cell(2, "moving")), ("0", "1"));
    assert_eq!(
        (cell(1, "x_mm"), cell(1, "y_setpoint_mm")),
        ("50.000000000", "0.000000000")
    );
    assert_eq!(cell(7, "theta_true_error_urad"), "2.000000");
    assert_eq!(cell(7, "duty_2"), "-0.5000000");
    assert_eq!(cell(7, "integral_2_v"), "-1.25000");
    assert_eq!(cell(7, "model_current_3_a"), "-2.00000");
    assert_eq!(cell(7, "learnt_friction_3_v"), "0.125000");
    assert_eq!(cell(7, "xy_true_error_um"), "0.500000");
    assert_eq!(cell(7, "xy_following_error_um"), "0.100000");
    let separation_deg = sample(120, 1_001).separation_deg;
    assert_eq!(cell(7, "separation_deg"), format!("{separation_deg:.6}"));
    let last_deg: f64 = cell(51, "pivot_2_setpoint_deg").parse().expect("a number");
    assert!((last_deg - sample(1_000, 1_001).pivot_setpoint_deg[1]).abs() < 1e-9);

    let moves = fs::read_to_string(folder.join("moves.csv")).expect("the moves");
    let lines: Vec<&str> = moves.lines().collect();
    assert_eq!(
        lines[0],
        "start_s,profile_end_s,settled_s,settle_s,x_mm,y_mm,theta_deg"
    );
    assert_eq!(
        lines[2],
        "1.000000,1.500000,,,1.000000000,-2.000000000,720.000000000"
    );
    assert!(lines[3].starts_with("2.000000,2.500000,2.510000,0.010000,"));
}

#[test]
fn the_summary_tells_what_happened() {
    let summary = run(1_001, 20).summary().to_string();
    for line in [
        "errors while moving (997 ticks)",
        "  following, centre                0.100       0.100  um",
        "  true pose, centre                0.500       0.500  um",
        "    1      0.000      1.000   -2.000     720.000      0.5000       10.00",
        "    2      1.000      1.000   -2.000     720.000      0.5000       never",
        "  never settled: 1",
        "peak duty                   50.0 %",
        "simulated time             0.050 s",
        "speed                        5.0 times real time",
    ] {
        assert!(
            summary.lines().any(|other| other == line),
            "{line}\n{summary}"
        );
    }
}

/// Whoever has any of it can tell what it was made under.
#[test]
fn pictures_document_and_summary_tell_the_conditions() {
    let run = run(1_001, 20);
    let line = "made up 1.2; none at all; seed 3; mismatch 60 %; payload 2.5 kg; imperfections of a kind machine but backlash; settings the machine's own";
    for text in [run.picture(), run.motion_picture(), run.document()] {
        assert!(text.contains(line));
    }
    let summary = run.summary().to_string();
    for line in [
        "  program             made up 1.2",
        "  mismatch            60 %",
        "  imperfections       of a kind machine but backlash",
    ] {
        assert!(
            summary.lines().any(|other| other == line),
            "{line}\n{summary}"
        );
    }
    let folder = folder("conditions");
    run.write(&folder).expect("the folder can be written");
    let text = fs::read_to_string(folder.join("conditions.json")).expect("written");
    let conditions: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(conditions["run"], "made up");
    assert_eq!(conditions["seed"], 3);
    assert_eq!(conditions["without"], serde_json::json!(["backlash"]));
    assert_eq!(conditions["settings"], serde_json::Value::Null);
}

/// The same quantity has one colour: what the document's plots take from its style sheet is what the pictures take from the table.
#[test]
fn a_quantity_has_one_colour() {
    let document = run(1_001, 20).document();
    let [first, second, third] = colour::PIVOTS;
    for (name, light) in [
        ("x", colour::X),
        ("y", colour::Y),
        ("centre", colour::CENTRE),
        ("theta", colour::THETA),
        ("pivot-1", first),
        ("pivot-2", second),
        ("pivot-3", third),
    ] {
        let rule = format!("--{name}: light-dark({light},");
        assert!(document.contains(&rule), "{rule}");
    }
    for (title, paints) in [
        ("Centre, mm", &["x", "y"][..]),
        ("Orientation \u{3b8}, \u{b0}", &["theta"]),
        ("Error of the centre, \u{b5}m", &["steel", "centre"]),
        ("Error of \u{3b8}, \u{b5}rad", &["steel", "theta"]),
        ("Speed of the moved point, mm/s", &["centre"]),
        ("Rate of \u{3b8}, \u{b0}/s", &["theta"]),
    ] {
        let plot = format!("{{ title: \"{title}\",");
        let line = (document.lines())
            .find(|line| line.trim_start().starts_with(&plot))
            .expect(title);
        let found: Vec<&str> = (line.split("paint: \"").skip(1))
            .filter_map(|rest| rest.split('"').next())
            .collect();
        assert_eq!(found, paints, "{title}");
    }
}

/// A move that the next one followed at once had no time to settle; one that was given a tenth of a second had.
#[test]
fn a_move_that_nobody_waited_for_is_no_failure() {
    let mut run = run(1_001, 20);
    let end_s = run.trace.statistics().end_s;
    let unsettled = |start_s: f64| Move {
        start_s,
        profile_end_s: start_s + 0.5,
        settled_s: None,
        target: [0.0; 3],
    };
    run.moves = [0.0, 0.5, 1.099, 1.7].map(unsettled).to_vec();
    assert_eq!(run.never_settled(), 1);
    let summary = run.summary().to_string();
    let ends_in = |word: &str| summary.lines().filter(|line| line.ends_with(word)).count();
    assert_eq!((ends_in("no time"), ends_in(" never")), (3, 1), "{summary}");
    assert!(summary.contains("never settled: 1\n"), "{summary}");
    // The end of the run counts as the next move does.
    run.moves = vec![unsettled(end_s - 0.5 - 0.099)];
    assert_eq!(run.never_settled(), 0);
    run.moves = vec![unsettled(end_s - 0.5 - 0.101)];
    assert_eq!(run.never_settled(), 1);
}

#[test]
fn a_long_run_lists_the_moves_slowest_to_settle() {
    let mut run = run(100, 1);
    run.moves = (0..100)
        .map(|number| Move {
            start_s: f64::from(number),
            profile_end_s: f64::from(number) + 0.5,
            settled_s: Some(f64::from(number) + 0.5 + 1e-3 * f64::from(number % 50)),
            target: [0.0; 3],
        })
        .collect();
    let summary = run.summary().to_string();
    assert!(summary.contains("moves (20 of 100, slowest to settle)"));
    let numbers: Vec<u32> = (summary.lines())
        .filter(|line| line.len() == 72)
        .filter_map(|line| line.split_whitespace().next()?.parse().ok())
        .collect();
    // In the order of time: numbers 41 to 50, then 91 to 100.
    assert!(
        numbers.is_sorted() && numbers.len() == 20,
        "{numbers:?}\n{summary}"
    );
    assert!(summary.contains("       49.00\n") && !summary.contains("       39.00\n"));
}

#[test]
fn a_run_that_never_began_still_has_a_report() {
    let mut empty = run(5, 1);
    empty.trace = Trace::new(1);
    empty.moves.clear();
    empty.name = "<a&b>\u{7}".to_owned();
    empty
        .write(&folder("empty"))
        .expect("the folder can be written");
    assert!(!empty.picture().contains("NaN"));
    let document = empty.document();
    assert!(document.contains("<title>Tripivot: &lt;a&amp;b&gt;"));
    assert!(!document.contains("<a&b>"));
    assert!(empty.summary().to_string().contains("no moves"));
}

#[test]
fn odd_numbers_do_not_break_the_picture() {
    let mut odd = run(50, 1);
    for value in [f64::NAN, f64::INFINITY, -1e300, 1e-300] {
        odd.trace.record(&Sample {
            pose: [value; 3],
            following_error: [value; 3],
            true_error: [value; 3],
            duty: [value; 3],
            ..sample(50, 50)
        });
    }
    odd.write(&folder("odd"))
        .expect("the folder can be written");
}

/// What stands alone asks for nothing: no address, no file, no script or style from elsewhere.
#[test]
fn the_document_stands_alone() {
    let document = run(1_001, 20).document();
    for outside in [
        "http:", "https:", "src=", "href=", "@import", "url(", "import {", "export ", "fetch(",
    ] {
        assert!(!document.contains(outside), "{outside}");
    }
    for part in [
        "<style>",
        "class Plot",
        "function drawMechanism",
        "\"ticks\":1001",
    ] {
        assert!(document.contains(part), "{part}");
    }
}

#[test]
fn a_minute_of_motion_stays_under_five_megabytes() {
    let ticks = 60 * 20_000;
    let mut long = run(5, 1);
    long.trace = Trace::new(u32::MAX);
    let some: Vec<Sample> = (0..1_000).map(|tick| sample(tick, 1_000)).collect();
    for tick in 0..ticks {
        long.trace.record(&Sample {
            time_s: f64::from(tick) * 50e-6,
            ..some[tick as usize % some.len()]
        });
    }
    let bytes = long.document().len();
    assert!(bytes > 500_000, "{bytes}: it has the data in it");
    assert!(bytes < 5_000_000, "{bytes}");
}

//! Scripts that are not run: what is wrong, and where.

use std::path::Path;

use hal_sim::rig::run::{RunOptions, run};
use hal_sim::rig::script::{Script, ScriptError};

/// Line, column and GCS error of a bad script.
fn place(text: &str) -> (usize, usize, u16) {
    match Script::parse("bad.gcs", text) {
        Err(ScriptError::Line {
            line, column, code, ..
        }) => (line, column, code.expect("a command").number()),
        other => panic!("{text:?}: {other:?}"),
    }
}

#[test]
fn a_bad_line_is_found_wherever_it_stands() {
    assert_eq!(place("MOVE X 1"), (1, 1, 2));
    assert_eq!(place("FRF\n# a comment\n\n\t MOV X 1 X 2"), (4, 11, 22));
    assert_eq!(place("FRF\nMOV X"), (2, 6, 24));
    assert_eq!(place("MOV Q 1"), (1, 5, 15));
    assert_eq!(place("MOV X 1e999"), (1, 7, 25));
    assert_eq!(place("DEL ten"), (1, 5, 25));
}

#[test]
fn every_line_of_a_good_script_is_kept_with_its_number() {
    let script = Script::parse(
        "good.gcs",
        "# head\nFRF\r\n\n  mov x 1 \n#5\nWAC ONT? X = 1\n",
    )
    .expect("good");
    let lines: Vec<_> = script
        .lines
        .iter()
        .map(|line| (line.number, line.text.as_str()))
        .collect();
    assert_eq!(
        lines,
        [(2, "FRF"), (4, "mov x 1"), (5, "#5"), (6, "WAC ONT? X = 1")]
    );
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let error = Script::read(Path::new("no/such/file.gcs")).expect_err("no such file");
    assert!(
        error
            .to_string()
            .starts_with("cannot read no/such/file.gcs: "),
        "{error}"
    );
}

/// Single bytes are written `#5`; what they answer and set belongs to their line.
#[test]
fn single_bytes_run_in_a_script() {
    let script =
        Script::parse("bytes", "FRF\nMOV X 2\n#7\n#5\n#24\nWAC ONT? X = 1\n#5\n").expect("good");
    let outcome = run(&script, &RunOptions::default());
    assert_eq!(outcome.fault, None);
    let answers: Vec<_> = outcome
        .answers
        .iter()
        .map(|(line, answer)| (line.as_str(), answer.as_str()))
        .collect();
    assert_eq!(answers[1..], [("#5", "1"), ("#5", "0")]);
    assert_eq!(answers[0].0, "#7");
    assert_eq!(place("#6"), (1, 1, 2));
}

/// A script that is refused on the way ends there, and says where.
#[test]
fn a_refused_line_ends_the_run() {
    let script = Script::parse("far.gcs", "FRF\nMOV X 81\nMOV X 1\n").expect("good");
    let outcome = run(&script, &RunOptions::default());
    let fault = outcome.fault.expect("refused");
    assert_eq!(fault, "far.gcs:2: MOV X 81: refused with GCS error 7");
    assert!(outcome.run.moves.is_empty());
}

/// A push and a shake move the platform by what a stage of this weight yields, and only while they last.
#[test]
fn a_script_pushes_and_shakes_the_stage() {
    let worst_nm = |disturbance: &str| {
        let text = format!("FRF\nDEL 500\n{disturbance}\nDEL 100\n");
        let script = Script::parse("push", &text).expect("good");
        let outcome = run(&script, &RunOptions::default());
        assert_eq!(outcome.fault, None, "{disturbance}");
        (outcome.run.trace.rows().iter())
            .filter(|row| row.time_s > 0.5)
            .map(|row| row.true_error[0].hypot(row.true_error[1]) * 1e6)
            .fold(0.0, f64::max)
    };
    let undisturbed = worst_nm("");
    // 10 N on some 8 kg for 5 ms, and a tenth of it as the floor's acceleration.
    let pushed = worst_nm("! PUSH X 10 N 5 MS");
    let shaken = worst_nm("! SHAKE X 1 M/S2 20 HZ 50 MS");
    println!("{undisturbed} {pushed} {shaken} nm");
    assert!(pushed > 20.0 * undisturbed && shaken > 20.0 * undisturbed);
}

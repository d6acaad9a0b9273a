//! `tripivot run` as a user meets it: exit codes, messages, and what it leaves behind.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder of this test's own, empty.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    // Not there at the first run.
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn tripivot(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_tripivot"))
        .args(arguments)
        .output()
        .unwrap()
}

/// Runs a script; gives the output and the folder asked for.
fn run(name: &str, script: &str, more: &[&str]) -> (Output, PathBuf) {
    let folder = folder(name);
    let file = folder.join("script.gcs");
    fs::write(&file, script).unwrap();
    let out = folder.join("out");
    let (file, to) = (file.to_str().unwrap(), out.to_str().unwrap());
    let output = tripivot(&[&["run", file, "--out", to][..], more].concat());
    (output, out)
}

fn error_line(output: &Output) -> String {
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(text.lines().count(), 1, "{text}");
    text
}

const SHORT: &str = "FRF\nWAC ONT? W = 1\nMOV X 1 W 5\nWAC ONT? W = 1\nMOV?\n";

#[test]
fn a_script_that_runs_leaves_trace_and_pictures_and_exit_code_0() {
    let (output, out) = run("good", SHORT, &[]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(text.starts_with("MOV?\nX=1 "), "{text}");
    assert!(text.contains("errors while moving"), "{text}");
    for file in ["trace.csv", "moves.csv", "picture.svg", "picture.png"] {
        assert!(out.join(file).metadata().unwrap().len() > 100, "{file}");
    }
}

#[test]
fn the_same_seed_gives_the_same_trace_and_another_does_not() {
    let trace = |name, seed| {
        let (_, out) = run(name, SHORT, &["--seed", seed, "--every", "1"]);
        fs::read(out.join("trace.csv")).unwrap()
    };
    let first = trace("seed_1", "1");
    assert_eq!(first, trace("seed_1_again", "1"));
    assert_ne!(first, trace("seed_2", "2"));
}

#[test]
fn a_bad_line_is_named_and_nothing_moves() {
    let (output, out) = run("bad", "FRF\nMOV X 1\n  MOV X one\n", &[]);
    assert_eq!(output.status.code(), Some(2));
    let line = error_line(&output);
    assert!(line.contains("script.gcs:3:9: expected "), "{line}");
    assert!(!out.exists());
}

#[test]
fn a_target_out_of_reach_ends_the_run_with_exit_code_1() {
    let (output, _) = run("out_of_reach", "FRF\nMOV X 70 Y 70\n", &[]);
    assert_eq!(output.status.code(), Some(1));
    let line = error_line(&output);
    assert!(
        line.contains(":2: MOV X 70 Y 70: refused with GCS error 7"),
        "{line}"
    );
}

#[test]
fn a_missing_script_and_a_folder_that_can_not_be_written_are_one_line_each() {
    let folder = folder("missing");
    let missing = folder.join("missing.gcs");
    let output = tripivot(&["run", missing.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(error_line(&output).contains("cannot read"));

    let file = folder.join("a_file");
    fs::write(&file, "").unwrap();
    let inside = file.join("out");
    let output = tripivot(&["--out", inside.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    assert!(error_line(&output).contains("cannot write"));
}

//! `tripivot faults`.

#[test]
fn the_command_prints_a_table_and_writes_all_runs() {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("campaign.csv");
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_tripivot"))
        .args(["faults", "--runs", "3", "--seed", "7", "--quiet", "--out"])
        .arg(&path)
        .output()
        .expect("it runs");
    let text = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{text}");
    assert!(text.contains("none (control)"), "{text}");
    let rows = std::fs::read_to_string(&path).expect("a file");
    assert_eq!(rows.lines().count(), 1 + 2 * 3, "{rows}");
}

/// A problem that is known and is no more is one: its seed has to leave the list.
#[test]
fn a_known_problem_that_has_gone_is_told() {
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_tripivot"))
        .args([
            "faults", "--runs", "1", "--seed", "7", "--quiet", "--known", "1,2",
        ])
        .output()
        .expect("it runs");
    assert_eq!(output.status.code(), Some(1));
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(told.contains("2 seeds"), "{told}");
}

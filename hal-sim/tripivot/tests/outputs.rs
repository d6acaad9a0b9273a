//! What `tripivot` leaves for other programs: JSON, completions, manual pages, and folders in the working directory.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

const SHORT: &str = "FRF\nWAC ONT? W = 1\nMOV X 1 W 5\nWAC ONT? W = 1\nMOV?\n";

/// All commands but `help`.
#[cfg(unix)]
const COMMANDS: &[&str] = &[
    "run",
    "serve",
    "view",
    "record",
    "settings",
    "board",
    "commission",
    "tune",
    "frf",
    "machine",
    "sensitivity",
    "faults",
    "calibrate",
    "inverse",
    "direct",
    "check",
    "map",
    "completions",
    "man",
];
#[cfg(not(unix))]
const COMMANDS: &[&str] = &[
    "run",
    "machine",
    "sensitivity",
    "faults",
    "calibrate",
    "inverse",
    "direct",
    "check",
    "map",
    "completions",
    "man",
];

/// A folder of this test's own, empty.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("outputs")
        .join(name);
    // Not there at the first run.
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// In this working directory.
fn tripivot(working: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_tripivot"))
        .args(arguments)
        .current_dir(working)
        .output()
        .unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// All of standard output is one document.
fn document(output: &Output) -> Value {
    let text = stdout(output);
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

fn error_line(output: &Output) -> String {
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(text.lines().count(), 1, "{text}");
    text
}

fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("no number: {value}"))
}

/// Whether the help of a command names all fields of its document.
fn assert_documented(command: &[&str], document: &Value) {
    let help = stdout(&tripivot(Path::new("."), &[command, &["--help"]].concat()));
    let words: Vec<&str> = help
        .split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_')
        .collect();
    let mut left = vec![document];
    while let Some(value) = left.pop() {
        match value {
            Value::Object(fields) => {
                for (name, value) in fields {
                    assert!(words.contains(&name.as_str()), "{name} is not in: {help}");
                    left.push(value);
                }
            }
            Value::Array(values) => left.extend(values),
            _ => {}
        }
    }
}

#[test]
fn check_as_a_document() {
    let working = folder("check");
    let output = tripivot(&working, &["check", "-10", "20", "-1000", "--json"]);
    assert_eq!(output.status.code(), Some(0));
    let reachable = document(&output);
    assert_eq!(reachable["reachable"], true);
    assert_eq!(reachable["reason"], Value::Null);
    assert_eq!(reachable["theta_deg"], -1000.0);
    let room_mm = 80.0 - 10.0_f64.hypot(20.0);
    assert!((number(&reachable["margins"]["disk_mm"]) - room_mm).abs() < 1e-9);
    assert_documented(&["check"], &reachable);

    let output = tripivot(&working, &["check", "--json", "0", "-120", "0"]);
    assert_eq!(output.status.code(), Some(1));
    let outside = document(&output);
    assert_eq!(outside["reachable"], false);
    assert_eq!(outside["reason"], "the centre lies on or outside the track");
    assert_eq!(outside["margins"], Value::Null);

    let output = tripivot(&working, &["check", "--json", "inf", "0", "0"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty());
}

#[test]
fn a_run_as_a_document_in_a_folder_that_says_what_it_is() {
    let working = folder("run");
    fs::write(working.join("tour.gcs"), SHORT).unwrap();
    let arguments = [
        "run",
        "tour.gcs",
        "--json",
        "--kind",
        "--seed",
        "7",
        "--mismatch",
        "-5",
        "--payload",
        "0.5",
        "--without",
        "backlash",
        "--settings",
        "kept.bin",
    ];
    let output = tripivot(&working, &arguments);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let run = document(&output);
    assert_eq!(run["folder"], "tripivot-tour");
    assert_eq!(run["fault"], Value::Null);
    assert_eq!(run["never_settled"], 0);
    assert_eq!(run["answers"][0]["line"], "MOV?");
    assert!(
        run["answers"][0]["answer"]
            .as_str()
            .unwrap()
            .starts_with("X=1 ")
    );
    assert_eq!(run["moves"].as_array().unwrap().len(), 1);
    assert!((number(&run["moves"][0]["x_mm"]) - 1.0).abs() < 1e-6);
    for error in ["following_error", "true_error"] {
        assert!(number(&run[error]["centre_um"]["rms"]) > 0.0);
    }
    let conditions = &run["conditions"];
    let version = stdout(&tripivot(&working, &["--version"]));
    assert_eq!(conditions["program"], version.trim());
    assert_eq!(conditions["seed"], 7);
    assert_eq!(conditions["mismatch_percent"], -5.0);
    assert_eq!(conditions["payload_kg"], 0.5);
    assert_eq!(conditions["without"], serde_json::json!(["backlash"]));
    assert_eq!(conditions["settings"], "kept.bin");
    assert_documented(&["run"], &run);

    // The same conditions stand beside the trace and in what people look at.
    let out = working.join("tripivot-tour");
    let beside: Value =
        serde_json::from_str(&fs::read_to_string(out.join("conditions.json")).unwrap()).unwrap();
    assert_eq!(beside["run"], "tour.gcs");
    for (name, value) in conditions.as_object().unwrap() {
        assert_eq!(&beside[name], value, "{name}");
    }
    let line = format!(
        "{}; simulated kind reference stage, controller on the host; seed 7; mismatch -5 %; payload 0.5 kg; imperfections of a kind machine but backlash; settings kept.bin",
        version.trim()
    );
    for file in ["picture.svg", "motion.svg", "report.html"] {
        let text = fs::read_to_string(out.join(file)).unwrap();
        assert!(text.contains(&line), "{file}");
    }
    // A trace is headings and numbers.
    let trace = fs::read_to_string(out.join("trace.csv")).unwrap();
    assert!(trace.starts_with("time_s,moving,"), "{}", &trace[..80]);
    let mut rows = trace.lines().skip(1);
    assert!(rows.all(|row| row.split(',').all(|cell| cell.parse::<f64>().is_ok())));
}

#[test]
fn a_run_that_ends_early_is_a_document_too() {
    let working = folder("refused");
    fs::write(working.join("far.gcs"), "FRF\nMOV X 70 Y 70\n").unwrap();
    let output = tripivot(&working, &["run", "far.gcs", "--json", "--quiet"]);
    assert_eq!(output.status.code(), Some(1));
    let run = document(&output);
    let fault = run["fault"].as_str().unwrap();
    assert!(fault.contains("refused with GCS error 7"), "{fault}");
    assert!(error_line(&output).contains(fault));
}

#[test]
fn the_demonstration_as_a_document() {
    let working = folder("demonstration");
    let output = tripivot(&working, &["--json", "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let run = document(&output);
    assert_eq!(run["run"], "demonstration");
    assert_eq!(run["folder"], "tripivot-demonstration");
    assert_eq!(run["moves"].as_array().unwrap().len(), 20);
    assert!(working.join("tripivot-demonstration/report.html").is_file());
    assert_documented(&[], &run);
}

#[test]
fn a_stage_that_does_not_settle_is_no_success() {
    let working = folder("restless");
    // Nothing that makes up for what friction holds back.
    let script = "CCL 1 ADVANCED\nSPA 1 0x54500302 0\nSPA 1 0x54500303 0\nFRF\nDEL 200\nMOV X 10\nDEL 1500\n";
    fs::write(working.join("restless.gcs"), script).unwrap();
    let output = tripivot(&working, &["run", "restless.gcs", "--quiet"]);
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let line = error_line(&output);
    assert!(line.contains("1 of 1 moves never settled"), "{line}");
    assert!(stdout(&output).contains("never settled: "));
}

#[test]
fn a_folder_of_ours_is_overwritten_and_another_is_not() {
    let working = folder("ours");
    fs::write(working.join("tour.gcs"), SHORT).unwrap();
    for seed in ["1", "2"] {
        let output = tripivot(&working, &["run", "tour.gcs", "--quiet", "--seed", seed]);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        let text = fs::read_to_string(working.join("tripivot-tour/conditions.json")).unwrap();
        assert!(text.contains(&format!("\"seed\": {seed}")), "{text}");
    }
    let before = fs::read(working.join("tripivot-tour/trace.csv")).unwrap();
    fs::write(working.join("tripivot-tour/notes.txt"), "mine").unwrap();
    let output = tripivot(&working, &["run", "tour.gcs", "--quiet"]);
    assert_eq!(output.status.code(), Some(2));
    let line = error_line(&output);
    assert!(line.contains("tripivot-tour holds notes.txt"), "{line}");
    assert_eq!(
        fs::read(working.join("tripivot-tour/trace.csv")).unwrap(),
        before
    );
    // One that is named is no other.
    let output = tripivot(&working, &["run", "tour.gcs", "--quiet", "--out", "."]);
    assert_eq!(output.status.code(), Some(2));
    error_line(&output);
    assert!(!working.join("trace.csv").exists());
}

#[test]
fn a_campaign_as_a_document() {
    let working = folder("faults");
    let arguments = ["faults", "--runs", "3", "--seed", "7", "--quiet", "--json"];
    let output = tripivot(&working, &arguments);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let campaign = document(&output);
    assert_eq!(
        (&campaign["runs"], &campaign["seed"]),
        (&3.into(), &7.into())
    );
    assert_eq!(
        (&campaign["missed"], &campaign["alarms"]),
        (&0.into(), &0.into())
    );
    let faults = campaign["faults"].as_array().unwrap();
    let runs = |total: &Value| total["runs"].as_u64().unwrap();
    let control = faults.last().unwrap();
    assert_eq!(
        (&control["fault"], runs(control)),
        (&"none (control)".into(), 3)
    );
    assert_eq!(faults.iter().map(runs).sum::<u64>(), 6);
    assert_documented(&["faults"], &campaign);

    let output = tripivot(&working, &["faults", "--only", "5", "--json"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let alone = document(&output);
    assert_eq!(alone["runs"], Value::Null);
    let told = alone["told"].as_array().unwrap();
    assert_eq!(told.len(), 2);
    assert!(
        told.iter()
            .all(|run| run["seed"] == 5 && run["problem"].is_null())
    );
    assert_documented(&["faults"], &alone);
}

#[test]
fn completions_name_every_command() {
    let working = folder("completions");
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let output = tripivot(&working, &["completions", shell]);
        assert_eq!(output.status.code(), Some(0), "{shell}");
        let text = stdout(&output);
        for word in COMMANDS.iter().chain(&["mismatch"]) {
            assert!(text.contains(word), "{shell}: {word}");
        }
    }
    let output = tripivot(&working, &["completions", "bsh"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(error_line(&output).contains("'bash'"));
}

#[test]
fn every_command_has_a_manual_page() {
    let working = folder("man");
    let output = tripivot(&working, &["man", "--out", "pages"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let page = |name: &str| fs::read_to_string(working.join("pages").join(name)).expect(name);
    let whole = page("tripivot.1");
    for command in COMMANDS {
        assert!(
            whole.contains(&format!("tripivot\\-{command}(1)")),
            "{command}: {whole}"
        );
        assert!(
            page(&format!("tripivot-{command}.1")).contains(".SH OPTIONS"),
            "{command}"
        );
    }
    assert!(page("tripivot-run.1").contains("mismatch"));
    // No command is missing above.
    let help = stdout(&tripivot(&working, &["--help"]));
    let (_, rest) = help.split_once("\nCommands:\n").unwrap();
    let (list, _) = rest.split_once("\n\n").unwrap();
    let listed: Vec<&str> = (list.lines())
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "))
        .filter_map(|line| line.split_whitespace().next())
        .filter(|name| *name != "help")
        .collect();
    assert_eq!(listed, COMMANDS);
}

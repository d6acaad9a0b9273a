//! `tripivot record` as a user meets it, against a simulated stage in real time.
#![cfg(unix)]

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::{Child, Command, Output, Stdio};

/// A served stage.
struct Served {
    child: Child,
    address: String,
    terminal: String,
}

impl Served {
    fn start() -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_tripivot"))
            .args(["serve", "--listen", "127.0.0.1:0", "--web", "off", "--pty"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut out = BufReader::new(child.stdout.take().unwrap());
        let mut place = |prefix: &str| {
            loop {
                let mut line = String::new();
                assert_ne!(out.read_line(&mut line).unwrap(), 0, "{prefix}");
                if let Some(place) = line.trim().strip_prefix(prefix) {
                    break place.to_owned();
                }
            }
        };
        let (address, terminal) = (place("listening at "), place("terminal at "));
        // Read on, so that its notices find somebody.
        std::thread::spawn(move || out.lines().count());
        Self {
            child,
            address,
            terminal,
        }
    }

    /// Records; the output, and the folder.
    fn record(&self, name: &str, arguments: &[&str]) -> (Output, PathBuf) {
        record(["--connect", &self.address], name, arguments)
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn record(way: [&str; 2], name: &str, arguments: &[&str]) -> (Output, PathBuf) {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    // Not there at the first run.
    let _ = fs::remove_dir_all(&folder);
    let output = Command::new(env!("CARGO_BIN_EXE_tripivot"))
        .arg("record")
        .args(way)
        .arg("--out")
        .arg(&folder)
        .args(arguments)
        .output()
        .unwrap();
    (output, folder)
}

/// The table: names, and rows of numbers.
fn table(folder: &std::path::Path) -> (String, Vec<Vec<f64>>) {
    let text = fs::read_to_string(folder.join("record.csv")).unwrap();
    let (names, rows) = text.split_once('\n').unwrap();
    let rows = (rows.lines())
        .map(|row| row.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    (names.to_owned(), rows)
}

fn error_line(output: &Output) -> String {
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(text.lines().count(), 1, "{text}");
    text
}

#[test]
fn a_move_from_before_its_start() {
    let served = Served::start();
    // Referencing is a line too.
    let (output, _) = served.record(
        "reference",
        &["--send", "FRF", "--trigger", "now", "--points", "100"],
    );
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let arguments = [
        "--tables",
        "X:1,X:3,1:73,0:202",
        "--points",
        "1500",
        "--before",
        "200",
        "--every",
        "2",
        "--send",
        "MOV X 10 W 5",
    ];
    let (output, folder) = served.record("move", &arguments);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(text.starts_with("1500 points, 100 us apart\n"), "{text}");
    // What it is at now, as a document.
    let again = ["--tables", "X:1", "--points", "100", "--json", "--out"];
    let again = Command::new(env!("CARGO_BIN_EXE_tripivot"))
        .args(["record", "--connect", &served.address])
        .args(again)
        .arg(folder.with_file_name("document"))
        .output()
        .unwrap();
    assert_eq!(again.status.code(), Some(0), "{again:?}");
    let document: serde_json::Value = serde_json::from_slice(&again.stdout).unwrap();
    assert_eq!(document["controller"], served.address);
    assert_eq!(document["sent"], serde_json::Value::Null);
    assert_eq!(document["points"], 100);
    assert_eq!(
        document["signals"][0]["name"],
        "commanded position of X, mm"
    );
    let highest = document["signals"][0]["highest"].as_f64().unwrap();
    assert!((highest - 10.0).abs() < 1e-2, "{document}");
    let (names, rows) = table(&folder);
    assert_eq!(
        names,
        "\"time since trigger, s\",\"commanded position of X, mm\",\"position error of X, mm\",motor output of pivot 1,state"
    );
    assert_eq!(rows.len(), 1500);
    let moving = rows.iter().position(|row| row[4] == 2.0).unwrap();
    assert_eq!(moving, 200, "the trigger's row is the first that moves");
    assert_eq!(rows[200][0], 0.0);
    assert!((rows[0][0] + 0.02).abs() < 1e-9);
    assert!(rows[199][1].abs() < 1e-2 && (rows[1499][1] - 10.0).abs() < 1e-2);
    assert!(rows.iter().all(|row| row[2].abs() < 0.02));
    for file in ["record.svg", "record.png"] {
        assert!(folder.join(file).metadata().unwrap().len() > 1000, "{file}");
    }

    // Refused, and nothing waits for a trigger afterwards.
    let (output, _) = served.record("refused", &["--send", "MOV X 100"]);
    assert_eq!(output.status.code(), Some(1));
    let line = error_line(&output);
    assert!(
        line.contains("refused `MOV X 100` with GCS error 7"),
        "{line}"
    );
    let (output, _) = served.record("option", &["--tables", "X:99"]);
    assert!(error_line(&output).contains("HDR?"), "{output:?}");
    // A trigger that does not come.
    let (output, _) = served.record("never", &["--trigger", "rises:1:50", "--patience", "0.3"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(
        error_line(&output).contains("nothing has triggered"),
        "{output:?}"
    );
}

#[test]
fn over_a_serial_line() {
    let served = Served::start();
    let way = ["--port", &served.terminal];
    let reference = ["--send", "FRF", "--trigger", "now", "--points", "100"];
    let (output, _) = record(way, "line-reference", &reference);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let arguments = [
        "--tables", "X:1,X:2", "--every", "10", "--points", "500", "--send", "MOV X 5",
    ];
    let arguments = [&arguments[..], &["--baud", "115200"]].concat();
    let (output, folder) = record(way, "line-move", &arguments);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let (names, rows) = table(&folder);
    assert_eq!(
        names,
        "\"time since trigger, s\",\"commanded position of X, mm\",\"real position of X, mm\""
    );
    let [first, last] = [&rows[0], rows.last().unwrap()];
    assert!(
        first[1].abs() < 1e-2 && (last[1] - 5.0).abs() < 1e-6,
        "{first:?} {last:?}"
    );
    assert!(rows.iter().all(|row| (row[1] - row[2]).abs() < 0.02));
    // The line is free again, and says the same as TCP.
    let (output, _) = record(way, "line-refused", &["--send", "MOV X 100"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(error_line(&output).contains("GCS error 7"), "{output:?}");
}

#[test]
fn nobody_there() {
    let (output, _) = record(["--connect", "127.0.0.1:1"], "nobody", &[]);
    assert_eq!(output.status.code(), Some(2));
    let line = error_line(&output);
    assert!(
        line.starts_with("tripivot: no controller at 127.0.0.1:1: "),
        "{line}"
    );
    assert!(line.contains("tripivot serve"), "{line}");
    for bad in [
        &["--tables", "X"][..],
        &["--tables", "X:1,X:1,X:1,X:1,X:1,X:1,X:1,X:1,X:1"],
        &["--trigger", "later"],
        &["--port", "/nowhere/tty"],
        &["--every", "0"],
    ] {
        let arguments = [&["record"][..], bad].concat();
        let output = Command::new(env!("CARGO_BIN_EXE_tripivot"))
            .args(arguments)
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2), "{bad:?}");
        error_line(&output);
    }
}

//! `tripivot board` against a simulated stage: every test passes on a sound one, and fails where it is to.

#![cfg(unix)]

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, ChildStdout, Command, Output, Stdio};

/// A simulated stage; ends with the test.
struct Served {
    child: Child,
    address: String,
    // A server whose output is closed ends.
    _out: BufReader<ChildStdout>,
}

impl Served {
    fn start(arguments: &[&str]) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_tripivot"))
            .args(["serve", "--listen", "127.0.0.1:0", "--web", "off"])
            .args(arguments)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        let mut out = BufReader::new(child.stdout.take().unwrap());
        out.read_line(&mut line).unwrap();
        let address = line
            .trim()
            .strip_prefix("listening at ")
            .unwrap()
            .to_owned();
        Self {
            child,
            address,
            _out: out,
        }
    }

    fn board(&self, arguments: &[&str]) -> (Output, String) {
        let output = Command::new(env!("CARGO_BIN_EXE_tripivot"))
            .args(["board", "--connect", &self.address])
            .args(arguments)
            .output()
            .unwrap();
        let text = String::from_utf8(output.stdout.clone()).unwrap();
        (output, text)
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        // Dead already, if it has failed.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn a_sound_stage_passes_every_test() {
    let served = Served::start(&[]);
    // A busy machine simulates slower than real time: what depends on its seconds is not what is tested here.
    let page = Path::new(env!("CARGO_TARGET_TMPDIR")).join("board.html");
    let out = page.to_str().unwrap();
    let (output, text) = served.board(&["--move", "--emulated", "--out", out]);
    assert!(
        !text.contains("FAILED") && !text.contains("left out"),
        "{text}"
    );
    assert_eq!(text.lines().count(), 16, "{text}");
    assert_eq!(output.status.code(), Some(0));
    let page = std::fs::read_to_string(page).unwrap();
    assert!(page.contains("nothing has failed"), "{page}");
    // Every test, and what the loop knows of itself: a simulated controller has no chip.
    for row in [
        "<td>servo</td>",
        "<td>ENCODER3</td><td>1</td><td>1 to 1</td><td class=\"ok\">ok</td>",
    ] {
        assert!(page.contains(row), "{row}: {page}");
    }
    let (output, _) = served.board(&["--out", "/nowhere/board.html"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(
        String::from_utf8_lossy(&output.stderr).contains("/nowhere/board.html: cannot be written")
    );
}

#[test]
fn an_uncommissioned_one_fails_and_nothing_is_moved_unasked() {
    let served = Served::start(&["--uncommissioned"]);
    let (output, text) = served.board(&["--emulated"]);
    let failed: Vec<&str> = text
        .lines()
        .filter(|line| line.contains("FAILED"))
        .collect();
    assert_eq!(failed.len(), 1, "{text}");
    assert!(failed[0].starts_with("commissioned"), "{text}");
    assert_eq!(text.matches("left out").count(), 5, "{text}");
    assert_eq!(output.status.code(), Some(1));
    let (_, text) = served.board(&["--move", "--emulated"]);
    assert!(text.contains("error 4005"), "{text}");
}

#[test]
fn a_slow_clock_is_found() {
    let served = Served::start(&["--speed", "0.5"]);
    let (output, text) = served.board(&[]);
    let rate = text.lines().find(|line| line.starts_with("rate")).unwrap();
    assert!(rate.contains("FAILED"), "{text}");
    assert_eq!(output.status.code(), Some(1));
}

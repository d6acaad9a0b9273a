//! Nothing that was asked for before a stop follows it.

use crate::bench::{Stage, Viewer, page_at};
use desk::line::Endpoint;
use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

/// What waits for its turn on a line that pages share does not go out behind a stop; who asked for it is told.
#[test]
fn what_was_asked_for_before_a_stop_does_not_follow_it() {
    let (slow, lines) = SlowController::start();
    let page = page_at(Endpoint::Tcp(slow.to_string()));
    let (mut one, mut other) = (Viewer::ready(&page), Viewer::ready(&page));
    // The line is busy with the first for longer than the rest takes.
    let first = one.post("MOV X 1");
    while !lines.lock().unwrap().iter().any(|line| line == "MOV X 1") {
        thread::sleep(Duration::from_millis(1));
    }
    let second = one.post("MOV X 2");
    let question = one.post("POS? Z");
    thread::sleep(Duration::from_millis(100));
    assert_eq!(other.ask("STP")["error"], 0);
    assert_eq!(one.wait(|message| message["id"] == first)["error"], 0);
    let dropped = one.wait(|message| message["id"] == second);
    assert_eq!(dropped["reason"], "not sent: a stop came before its turn");
    assert_eq!(
        one.wait(|message| message["id"] == question)["kind"],
        "answer"
    );
    // What comes after the stop goes out.
    assert_eq!(other.ask("MOV X 3")["error"], 0);
    let sent: Vec<String> = lines
        .lock()
        .unwrap()
        .iter()
        .filter(|line| line.starts_with("MOV ") || *line == "#24")
        .cloned()
        .collect();
    assert_eq!(sent, ["MOV X 1", "#24", "MOV X 3"]);
}

/// Over connections of the pages' own as well: a stop of one drops what another has waiting.
#[test]
fn over_its_own_connection_too_nothing_follows_a_stop() {
    let stage = Stage::start("127.0.0.1:0");
    let page = page_at(Endpoint::Tcp(stage.address.to_string()));
    let (mut one, mut other) = (Viewer::ready(&page), Viewer::ready(&page));
    assert_eq!(one.ask("FRF")["error"], 0);
    let under_way = one.post("DEL 1000");
    let waiting = one.post("MOV X 2");
    thread::sleep(Duration::from_millis(100));
    other.ask("STP");
    one.wait(|message| message["id"] == under_way);
    let dropped = one.wait(|message| message["id"] == waiting);
    assert_eq!(dropped["reason"], "not sent: a stop came before its turn");
    // Where referencing found it.
    assert!(other.value("MOV? X").abs() < 0.01);
}

/// A controller for one client that takes its time for a move; it keeps what it has received.
struct SlowController;

impl SlowController {
    const MOVE: Duration = Duration::from_millis(400);

    fn start() -> (SocketAddr, Arc<Mutex<Vec<String>>>) {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap();
        let lines = Arc::<Mutex<Vec<String>>>::default();
        let kept = Arc::clone(&lines);
        thread::spawn(move || {
            // Further clients wait in vain.
            let (mut stream, _) = listener.accept().unwrap();
            let mut line = Vec::new();
            let mut byte = [0];
            while matches!(stream.read(&mut byte), Ok(1)) {
                match byte[0] {
                    24 => kept.lock().unwrap().push("#24".to_owned()),
                    b'\n' => {
                        let text = String::from_utf8(std::mem::take(&mut line)).unwrap();
                        if text.starts_with("MOV ") {
                            kept.lock().unwrap().push(text.clone());
                            thread::sleep(Self::MOVE);
                        }
                        let answer = match &*text {
                            "*IDN?" => "(c)2026 Tripivot, XYT-1, 1, 1",
                            "ERR?" => "0",
                            "HLP?" => {
                                "The following commands are available: \nMOV \nOWN \nOWN? \nend of help"
                            }
                            _ if text.ends_with('?') || text.contains("? ") => "X=0",
                            _ => continue,
                        };
                        if stream.write_all(format!("{answer}\n").as_bytes()).is_err() {
                            return;
                        }
                    }
                    other => line.push(other),
                }
            }
        });
        (address, lines)
    }
}

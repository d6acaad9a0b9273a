//! What viewers are told, and how many there may be.

use crate::bench::{PATIENCE, Stage, Viewer, connect};
use serde_json::{Value, json};
use std::io::{Read, Write};
use std::net::TcpStream;
use std::thread;
use std::time::{Duration, Instant};

#[test]
fn errors_are_those_of_the_line_and_every_viewer_sees_the_same_stage() {
    let stage = Stage::start("127.0.0.1:0");
    let page = stage.page();
    let (mut one, mut other) = (Viewer::ready(&page), Viewer::ready(&page));
    assert_eq!(one.ask("MOV X 1")["error"], 5);
    one.reply("FRF");
    assert_eq!(one.ask("MOV X 500")["error"], 7);
    assert_eq!(one.ask("QQQ?")["error"], 2);
    assert_eq!(one.reply("VMO? X 60 Y 60").as_deref(), Some("0"));
    assert_eq!(one.reply("*IDN?"), other.reply("*IDN?"));
    one.reply("MOV X 2 W 4");
    for viewer in [&mut one, &mut other] {
        viewer.until("POS? X", 2.0);
        viewer.until("POS? W", 4.0);
        let seen = |message: &Value| {
            let monitor = message["replies"]["MON?"].as_str().unwrap_or_default();
            monitor.contains("\nX=2.00") && monitor.contains("\nPIVOT3=")
        };
        viewer.wait(seen);
    }
}

#[test]
fn a_stop_ends_a_motion_and_is_no_error_of_the_next_line() {
    let stage = Stage::start("127.0.0.1:0");
    let page = stage.page();
    let mut viewer = Viewer::ready(&page);
    viewer.reply("FRF");
    viewer.reply("VLS 5");
    viewer.reply("MOV X 60");
    viewer.wait(|message| {
        let monitor = message["replies"]["MON?"].as_str().unwrap_or_default();
        monitor.contains("MODE=moving")
    });
    viewer.reply("STP");
    viewer.reply("SVO? X");
    viewer.wait(|message| {
        let monitor = message["replies"]["MON?"].as_str().unwrap_or_default();
        monitor.contains("MODE=holding")
    });
    let x = viewer.value("POS? X");
    assert!((0.0..50.0).contains(&x), "{x}");
}

#[test]
fn it_comes_back_when_the_controller_does() {
    let stage = Stage::start("127.0.0.1:0");
    let (page, address) = (stage.page(), stage.address);
    let mut viewer = Viewer::ready(&page);
    viewer.reply("FRF");
    drop(stage);
    let lost = viewer.wait(|message| message["connected"] == false);
    assert!(!lost["reason"].as_str().unwrap().is_empty());
    let refused = viewer.ask("MOV X 1");
    assert_eq!(refused["kind"], "refused", "{refused}");
    let _stage = Stage::start(&address.to_string());
    viewer.wait(|message| message["connected"] == true);
    assert_eq!(viewer.value("FRF? X"), 0.0);
    viewer.reply("FRF");
}

/// A script's connection beside the page.
struct Script(TcpStream);

impl Script {
    fn connect(stage: &Stage) -> Self {
        let stream = TcpStream::connect(stage.address).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        Self(stream)
    }

    /// The error that lines leave.
    fn error_after(&mut self, lines: &str) -> String {
        self.0
            .write_all(format!("{lines}ERR?\n").as_bytes())
            .unwrap();
        let mut answer = [0; 8];
        let count = self.0.read(&mut answer).unwrap();
        String::from_utf8_lossy(&answer[..count]).trim().to_owned()
    }

    /// Starts a move of a minute, says nothing for far longer than the heartbeat, and tells whether the stage was stopped.
    fn is_missed(&mut self, heartbeat: &str, waits_s: &[u64]) -> bool {
        let lines = format!("FRF\nVLS 1\n{heartbeat}\nMOV X 60\n");
        assert_eq!(self.error_after(&lines), "0");
        // The stage's time may be slower than the clock's.
        waits_s.iter().any(|&wait_s| {
            thread::sleep(Duration::from_secs(wait_s));
            self.error_after("") == "10"
        })
    }
}

#[test]
fn a_page_that_looks_on_does_not_stand_for_a_script_that_has_died() {
    let stage = Stage::start("127.0.0.1:0");
    let page = stage.page();
    let mut viewer = Viewer::ready(&page);
    assert!(Script::connect(&stage).is_missed("HBT 1200", &[3, 6, 12]));
    viewer.wait(|message| message["kind"] == "status");
}

#[test]
fn a_page_that_nobody_looks_at_is_no_host_that_is_heard() {
    let stage = Stage::start("127.0.0.1:0");
    let page = stage.page();
    // Somebody has looked, and has gone.
    drop(Viewer::ready(&page));
    // Promised by nobody, so that anybody counts.
    assert!(Script::connect(&stage).is_missed("SPA 1 0x54500510 1200", &[3, 6, 12]));
    // As somebody who looks does.
    let _viewer = Viewer::ready(&page);
    assert!(!Script::connect(&stage).is_missed("SPA 1 0x54500510 1200", &[4]));
}

#[test]
fn a_serial_line_serves_as_well() {
    let stage = Stage::start("127.0.0.1:0");
    let page = stage.page_on_line();
    let mut viewer = Viewer::ready(&page);
    viewer.reply("FRF");
    viewer.reply("MOV X 1");
    viewer.until("POS? X", 1.0);
}

#[test]
fn more_requests_than_fit_are_refused_and_none_is_lost() {
    let stage = Stage::start("127.0.0.1:0");
    let page = stage.page();
    let mut viewer = Viewer::ready(&page);
    let count = 200;
    for id in 1..=count {
        let request = json!({"id": id, "token": viewer.token, "line": "CSV?"});
        viewer.send(&request.to_string());
    }
    let mut answered = 0;
    for _ in 0..count {
        let answer = viewer.wait(|message| message["id"].is_u64());
        match answer["reply"].as_str() {
            Some(reply) => {
                assert_eq!(reply, "2.0");
                answered += 1;
            }
            None => assert_eq!(answer["reason"], "too many requests at once"),
        }
    }
    assert!(answered > 0);
    viewer.reply("CSV?");
}

#[test]
fn so_many_pages_are_served_and_no_more() {
    let stage = Stage::start("127.0.0.1:0");
    let page = stage.page();
    let origin = format!("http://{}", page.address());
    let pages: Vec<_> = (0..128)
        .map(|_| connect(&page, Some(&origin)).unwrap())
        .collect();
    assert_eq!(connect(&page, Some(&origin)).err(), Some(503));
    drop(pages);
    let end = Instant::now() + PATIENCE;
    while connect(&page, Some(&origin)).is_err() {
        assert!(Instant::now() < end, "no place is free again");
        thread::sleep(Duration::from_millis(50));
    }
}

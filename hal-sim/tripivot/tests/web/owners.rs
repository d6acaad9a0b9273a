//! Connections of their own, and one line for all: whose commands count, and what ends with a page.

use crate::bench::{PATIENCE, Stage, Viewer};
use desk::line::Endpoint;
use desk::web::{Page, PageOptions};
use serde_json::json;
use std::io::{self};
use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
use std::thread;
use std::time::{Duration, Instant};

/// What `OWN?` says under a name.
fn owned(viewer: &mut Viewer, name: &str) -> String {
    let reply = viewer.reply("OWN?").unwrap();
    let value = reply
        .lines()
        .find_map(|line| line.strip_prefix(name)?.strip_prefix('='));
    value.unwrap().to_owned()
}

#[test]
fn each_page_is_a_connection_of_its_own() {
    let stage = Stage::start("127.0.0.1:0");
    let page = stage.page();
    let (mut one, mut other) = (Viewer::ready(&page), Viewer::ready(&page));
    one.reply("FRF");
    one.reply("CCL 1 ADVANCED");
    assert_eq!(other.reply("CCL?").as_deref(), Some("0"));
    assert_eq!(other.ask("SPA 1 0x54500301 41")["error"], 60);
    // What one records, or waits for, is nothing to the other.
    one.reply("VAR Q MAC");
    one.reply("$Q BEG TRAP");
    other.reply("MOV X 1");
    other.until("POS? X", 1.0);
    one.reply("MAC END");
    assert_eq!(one.reply("MAC? TRAP").as_deref(), Some(""));
    one.send(&json!({"id": 9999, "token": one.token, "line": "WAC POS? X = 99"}).to_string());
    other.reply("MOV X 2");
    other.until("POS? X", 2.0);
    // A page that is gone leaves nothing behind that waits.
    drop(one);
    other.reply("STP");
    other.reply("MOV X 3");
}

/// A port with one serial line behind it: the next client waits until the one before is gone.
fn one_client_at_a_time(stage: SocketAddr) -> SocketAddr {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    thread::spawn(move || {
        while let Ok((client, _)) = listener.accept() {
            let controller = TcpStream::connect(stage).unwrap();
            let (mut from, mut to) = (client.try_clone().unwrap(), controller.try_clone().unwrap());
            let there = thread::spawn(move || {
                let _ = io::copy(&mut from, &mut to);
                let _ = to.shutdown(Shutdown::Both);
            });
            let (mut from, mut to) = (controller, client);
            let _ = io::copy(&mut from, &mut to);
            let _ = there.join();
        }
    });
    address
}

/// So is the emulated chip, and a real board behind a converter.
#[test]
fn behind_a_port_for_one_client_pages_share_its_line() {
    let stage = Stage::start("127.0.0.1:0");
    let endpoint = Endpoint::Tcp(one_client_at_a_time(stage.address).to_string());
    let page = Page::start(&PageOptions::local("127.0.0.1:0"), endpoint).unwrap();
    let (mut one, mut other) = (Viewer::ready(&page), Viewer::ready(&page));
    one.reply("FRF");
    other.reply("MOV X 1");
    one.until("POS? X", 1.0);
    // What would change another's words is refused, as on a serial line.
    assert!(other.ask("VAR A 1")["reason"].is_string());
}

#[test]
fn a_page_may_own_the_stage_as_long_as_it_is_there() {
    let stage = Stage::start("127.0.0.1:0");
    for page in [stage.page(), stage.page_on_line()] {
        let (mut one, mut other) = (Viewer::ready(&page), Viewer::ready(&page));
        one.reply("FRF");
        one.reply("OWN 1");
        assert_eq!(
            (owned(&mut one, "MINE"), owned(&mut other, "MINE")),
            ("1".into(), "0".into())
        );
        assert_eq!(owned(&mut one, "OWNER"), owned(&mut other, "OWNER"));
        for line in ["MOV X 5", "OWN 1", "VLS 10"] {
            assert_eq!(other.ask(line)["error"], 4002, "{line}");
        }
        assert_eq!(other.reply("POS? Z").as_deref(), Some("Z=0.000000000"));
        one.reply("VLS 1");
        one.reply("MOV X 60");
        other.reply("STP");
        one.until("JOG? X", 0.0);
        assert!(one.value("MOV? X") < 50.0);
        one.reply("VLS 200");
        one.reply("MOV X 0");
        drop(one);
        let end = Instant::now() + PATIENCE;
        while owned(&mut other, "OWNER") != "(nobody)" {
            assert!(Instant::now() < end, "still owned");
        }
        other.reply("MOV X 0");
    }
}

/// A page that says nothing is gone for its server after 2.5 s: what ends before then ends by itself.
const LONG_AFTER: Duration = Duration::from_secs(2);

/// A computer that sleeps closes nothing: it answers no ping.
#[test]
fn a_page_that_is_silent_is_gone() {
    let stage = Stage::start("127.0.0.1:0");
    let page = stage.page();
    let (mut asleep, mut other) = (Viewer::ready(&page), Viewer::ready(&page));
    assert_eq!(asleep.ask("OWN 1 Ada")["error"], 0);
    assert_eq!(owned(&mut other, "OWNER"), "Ada");
    let end = Instant::now() + Duration::from_secs(5);
    while owned(&mut other, "OWNER") != "(nobody)" {
        assert!(Instant::now() < end, "it still owns the stage");
    }
    drop(asleep);
}

#[test]
fn a_jog_of_a_page_ends_without_it() {
    let stage = Stage::start("127.0.0.1:0");
    for page in [stage.page(), stage.page_on_line()] {
        let mut looker = Viewer::ready(&page);
        looker.reply("FRF");
        // Killed: its connection ends.
        let mut killed = Viewer::ready(&page);
        killed.reply("JOG W 20");
        drop(killed);
        looker.until("JOG? W", 0.0);
        // Asleep, or out of reach: it is there and says nothing.
        let mut asleep = Viewer::ready(&page);
        asleep.reply("JOG W 20");
        let start = Instant::now();
        looker.until("JOG? W", 0.0);
        assert!(
            start.elapsed() > Duration::from_millis(200),
            "{:?}",
            start.elapsed()
        );
        // Renewed, it goes on.
        for _ in 0..20 {
            asleep.reply("JOG W 20");
            thread::sleep(Duration::from_millis(50));
            assert_eq!(looker.value("JOG? W"), 20.0);
        }
        looker.until("JOG? W", 0.0);
        // The controller has started again, and knows nothing of what was said before.
        for line in ["RBT", "FRF"] {
            let end = Instant::now() + PATIENCE;
            while looker.ask(line)["error"] != 0 {
                assert!(Instant::now() < end, "{line} is not taken");
            }
        }
        // Another connection does not wait for what this one has asked for.
        looker.until("FRF? X", 1.0);
        asleep.reply("JOG W 20");
        let start = Instant::now();
        looker.until("JOG? W", 0.0);
        assert!(start.elapsed() < LONG_AFTER, "{:?}", start.elapsed());
        // Nor is its end that of the page's connection, for which a minute is too long.
        asleep.reply("CSV?");
    }
}

#[test]
fn over_a_line_that_pages_share_none_changes_what_another_says() {
    let stage = Stage::start("127.0.0.1:0");
    let page = stage.page_on_line();
    let (mut one, mut other) = (Viewer::ready(&page), Viewer::ready(&page));
    for line in [
        "VAR Q MAC",
        "$Q BEG TRAP",
        "MAC BEG TRAP",
        "WAC POS? X = 99",
        "DEL 1000",
    ] {
        let refused = one.ask(line);
        assert_eq!(refused["kind"], "refused", "{line}: {refused}");
        assert!(
            refused["reason"]
                .as_str()
                .unwrap()
                .contains("share this serial line"),
            "{refused}"
        );
    }
    one.reply("CCL 1 ADVANCED");
    assert_eq!(other.reply("CCL?").as_deref(), Some("0"));
    assert_eq!(other.ask("SPA 1 0x54500301 41")["error"], 60);
    assert_eq!(one.reply("CCL?").as_deref(), Some("1"));
}

//! The page as browsers and others meet it: who may look, who may drive, what comes of bad messages, and that it comes back.
#![cfg(unix)]

use std::io::{self, Read, Write};
use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use desk::serve::{ServeOptions, Server};
use desk::web::{Endpoint, Page, PageOptions};
use hal_sim::machine::devices::SettingsFlash;
use hal_sim::rig::ControllerMemory;
use hal_sim::rig::run::RunOptions;
use serde_json::{Value, json};
use tripivot::simulated::Simulated;
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket, client};

/// Far longer than anything here takes, on a busy machine too.
const PATIENCE: Duration = Duration::from_secs(60);

/// A simulated stage in a thread of the test.
struct Stage {
    address: SocketAddr,
    terminal: Option<std::path::PathBuf>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Stage {
    fn start(listen: &str) -> Self {
        let run = RunOptions::default();
        let server = Server::bind(ServeOptions {
            listen: listen.to_owned(),
            speed: 1.0,
            terminal: true,
        })
        .unwrap();
        let (address, terminal) = (server.address().unwrap(), server.terminal().map(Into::into));
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = Arc::clone(&stop);
        let thread = thread::spawn(move || {
            let mut memory = ControllerMemory::new();
            let mut stage = Simulated::new(&mut memory, &run, SettingsFlash::in_memory());
            server.run(&mut stage, &stopped, &mut drop).unwrap();
        });
        Self {
            address,
            terminal,
            stop,
            thread: Some(thread),
        }
    }

    fn page(&self) -> Page {
        page_at(Endpoint::Tcp(self.address.to_string()))
    }

    /// The same over its terminal, which all viewers share.
    fn page_on_line(&self) -> Page {
        page_at(Endpoint::Serial {
            device: self.terminal.clone().unwrap(),
            baud: 115_200,
        })
    }
}

fn page_at(endpoint: Endpoint) -> Page {
    Page::start(&PageOptions::local("127.0.0.1:0"), endpoint).unwrap()
}

impl Drop for Stage {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        let result = self.thread.take().unwrap().join();
        assert!(thread::panicking() || result.is_ok());
    }
}

/// The whole answer to a request for `path`, under the name `host`.
fn get(page: SocketAddr, path: &str, host: &str) -> String {
    let mut stream = TcpStream::connect(page).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    write!(
        stream,
        "GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"
    )
    .unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    answer
}

fn token(page: &Page) -> String {
    let answer = get(page.address(), "/token", &page.address().to_string());
    let (_, token) = answer.split_once("\r\n\r\n").unwrap();
    token.to_owned()
}

/// A browser's connection.
struct Viewer {
    socket: WebSocket<TcpStream>,
    token: String,
    next: u64,
}

fn connect(page: &Page, origin: Option<&str>) -> Result<WebSocket<TcpStream>, u16> {
    connect_to(page, "live", origin)
}

fn connect_to(page: &Page, path: &str, origin: Option<&str>) -> Result<WebSocket<TcpStream>, u16> {
    let stream = TcpStream::connect(page.address()).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    let mut request = format!("ws://{}/{path}", page.address())
        .into_client_request()
        .unwrap();
    if let Some(origin) = origin {
        let headers = request.headers_mut();
        headers.insert("Origin", origin.parse().unwrap());
    }
    match client(request, stream) {
        Ok((socket, _)) => Ok(socket),
        Err(tungstenite::HandshakeError::Failure(tungstenite::Error::Http(response))) => {
            Err(response.status().as_u16())
        }
        Err(error) => panic!("{error}"),
    }
}

impl Viewer {
    fn new(page: &Page) -> Self {
        let origin = format!("http://{}", page.address());
        Self {
            socket: connect(page, Some(&origin)).unwrap(),
            token: token(page),
            next: 1,
        }
    }

    /// Connected to a controller.
    fn ready(page: &Page) -> Self {
        let mut viewer = Self::new(page);
        viewer.wait(|message| message["kind"] == "hello" && message["connected"] == true);
        viewer
    }

    /// The next message that `wanted` knows.
    fn wait(&mut self, wanted: impl Fn(&Value) -> bool) -> Value {
        let end = Instant::now() + PATIENCE;
        while Instant::now() < end {
            if let Message::Text(text) = self.socket.read().unwrap() {
                let message = serde_json::from_str(&text).unwrap();
                if wanted(&message) {
                    return message;
                }
            }
        }
        panic!("waited in vain");
    }

    fn send(&mut self, text: &str) {
        self.socket.send(Message::text(text)).unwrap();
    }

    /// Asks for a line, and goes on; the request's number.
    fn post(&mut self, line: &str) -> u64 {
        let id = self.next;
        self.next += 1;
        self.send(&json!({"id": id, "token": self.token, "line": line}).to_string());
        id
    }

    /// What becomes of a line.
    fn ask(&mut self, line: &str) -> Value {
        let id = self.post(line);
        self.wait(|message| message["id"] == id)
    }

    /// The reply to a line that is not refused.
    fn reply(&mut self, line: &str) -> Option<String> {
        let answer = self.ask(line);
        assert_eq!(answer["error"], 0, "{line}: {answer}");
        answer["reply"].as_str().map(str::to_owned)
    }

    /// What an axis of a query is.
    fn value(&mut self, query: &str) -> f64 {
        let reply = self.reply(query).unwrap();
        reply.split_once('=').unwrap().1.parse().unwrap()
    }

    fn until(&mut self, query: &str, expected: f64) {
        let end = Instant::now() + PATIENCE;
        while (self.value(query) - expected).abs() > 1e-3 {
            assert!(Instant::now() < end, "{query} does not become {expected}");
        }
    }
}

#[test]
fn the_page_is_served_to_its_own_name_and_may_load_nothing_from_elsewhere() {
    let stage = Stage::start("127.0.0.1:0");
    let page = stage.page();
    let place = page.address().to_string();
    let index = get(page.address(), "/", &place);
    assert!(index.starts_with("HTTP/1.1 200"), "{index}");
    assert!(index.contains("default-src 'none'"), "{index}");
    let mut files = 0;
    for part in index
        .split(['"', '\''])
        .filter(|part| part.starts_with('/'))
    {
        let answer = get(page.address(), part, &place);
        assert!(answer.starts_with("HTTP/1.1 200"), "{part}: {answer}");
        files += 1;
    }
    assert!(files >= 5, "{files}");
    let lesson = get(page.address(), "/lesson.json", "localhost");
    assert!(
        lesson.contains("\"frames\":[{\"pose\":[0.0,0.0,"),
        "{lesson}"
    );
    let elsewhere = get(page.address(), "/nothing", &place);
    assert!(elsewhere.starts_with("HTTP/1.1 404"), "{elsewhere}");
    for path in ["/", "/token", "/live"] {
        let stolen = get(page.address(), path, "evil.example");
        assert!(stolen.starts_with("HTTP/1.1 421"), "{stolen}");
        assert!(!stolen.contains(&token(&page)));
    }
}

#[test]
fn a_page_of_somebody_else_cannot_connect() {
    let stage = Stage::start("127.0.0.1:0");
    let page = stage.page();
    let mut other = page.address();
    other.set_port(1);
    let strangers = [
        None,
        Some("http://evil.example".to_owned()),
        Some(format!("http://{other}")),
    ];
    for origin in strangers {
        for path in ["live", "operator"] {
            let result = connect_to(&page, path, origin.as_deref());
            assert_eq!(result.err(), Some(403), "{path}: {origin:?}");
        }
    }
}

#[test]
fn what_is_not_a_request_gets_its_reason_and_changes_nothing() {
    let stage = Stage::start("127.0.0.1:0");
    let page = stage.page();
    let mut viewer = Viewer::ready(&page);
    viewer.reply("FRF");
    let before = viewer.reply("MOV? X Y W");
    for (message, reason) in [
        ("MOV X 10".to_owned(), "not a request: expected value"),
        (
            json!({"id": 1, "line": "MOV X 10"}).to_string(),
            "not a request: missing field `token`",
        ),
        (
            json!({"id": 1, "token": "0", "line": "MOV X 10"}).to_string(),
            "the token is wrong",
        ),
        (
            json!({"id": 1, "token": viewer.token, "line": "MOV X 10\nMOV Y 10"}).to_string(),
            "a character",
        ),
    ] {
        viewer.send(&message);
        let answer = viewer.wait(|answer| answer["kind"] == "refused");
        let said = answer["reason"].as_str().unwrap();
        assert!(said.starts_with(reason), "{message}: {said}");
    }
    viewer.socket.send(Message::binary(vec![24])).unwrap();
    viewer.wait(|answer| answer["kind"] == "refused");
    assert_eq!(viewer.reply("MOV? X Y W"), before);
}

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
fn a_sequence_needs_the_token_runs_without_pages_and_is_told_to_those_that_come() {
    let stage = Stage::start("127.0.0.1:0");
    let page = stage.page();
    let mut viewer = Viewer::ready(&page);
    let origin = format!("http://{}", page.address());
    let open = || Viewer {
        socket: connect_to(&page, "operator", Some(&origin)).unwrap(),
        token: token(&page),
        next: 1,
    };
    let text = "FRF\nWAC ONT? W = 1\nMOV X 5\nWAC ONT? X = 1\nDEL 20\nPOS? X\n";
    let order = |token: &str| {
        json!({"token": token, "order": {"run": {"name": "tour", "text": text}}}).to_string()
    };
    let mut stranger = open();
    stranger.send(&order("0123"));
    stranger.wait(|message| message["kind"] == "sequence");
    let mut operator = open();
    let token = operator.token.clone();
    operator.send(&order(&token));
    let end = operator.wait(|message| message["kind"] == "sequence" && message["state"] == "ended");
    assert_eq!(
        (&end["good"], &end["done"], &end["name"]),
        (&json!(true), &json!(6), &json!("tour")),
        "{end}"
    );
    assert!(
        end["answers"][0]["reply"]
            .as_str()
            .unwrap()
            .starts_with("X="),
        "{end}"
    );
    viewer.until("POS? X", 5.0);
    // Who comes later is told what was done, by whom, and nothing of the stranger's.
    viewer.reply("MOV X 0");
    let mut late = open();
    let mut lines = Vec::new();
    late.socket.send(Message::Ping(Default::default())).unwrap();
    while lines.last().is_none_or(|line| line != "MOV X 0") {
        let entry = late.wait(|message| message["kind"] == "log");
        lines.push(entry["line"].as_str().unwrap().to_owned());
    }
    assert_eq!(lines, ["FRF", "MOV X 5", "MOV X 0"]);
}

/// The sequence of the page that owns the stage is that page's; another page's is refused.
#[test]
fn who_owns_the_stage_runs_sequences() {
    let stage = Stage::start("127.0.0.1:0");
    for page in [stage.page(), stage.page_on_line()] {
        let mut other = Viewer::ready(&page);
        let mut owner = Viewer::new(&page);
        let key = owner.wait(|message| message["kind"] == "you")["key"].clone();
        other.reply("FRF");
        assert_eq!(owner.ask("OWN 1")["error"], 0);
        let origin = format!("http://{}", page.address());
        let mut operator = Viewer {
            socket: connect_to(&page, "operator", Some(&origin)).unwrap(),
            token: token(&page),
            next: 1,
        };
        let text = "MOV X 1\nWAC ONT? X = 1\nMOV X 0\nWAC ONT? X = 1\n";
        for (key, good) in [(key, true), (json!(""), false)] {
            let run = json!({"run": {"name": "one", "text": text}});
            let order = json!({"token": operator.token, "order": run, "key": key});
            operator.send(&order.to_string());
            operator.wait(|message| message["state"] == "running");
            let end = operator.wait(|message| message["state"] == "ended");
            assert_eq!(end["good"], good, "{end}");
            let said = end["said"].as_str().unwrap();
            assert_eq!(
                said.contains("another connection owns the stage"),
                !good,
                "{said}"
            );
            owner.reply("OWN?");
        }
        assert_eq!(owner.ask("OWN 0")["error"], 0);
    }
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

/// The cookie that a password brings, or what the page says in place of one.
fn enter(page: SocketAddr, origin: &str, password: &str) -> Result<String, String> {
    let mut stream = TcpStream::connect(page).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    let form = format!("password={password}");
    write!(
        stream,
        "POST /login HTTP/1.1\r\nHost: {page}\r\nOrigin: {origin}\r\nConnection: close\r\nContent-Type: application/x-www-form-urlencoded\r\nContent-Length: {}\r\n\r\n{form}",
        form.len()
    )
    .unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    let cookie = answer
        .lines()
        .find_map(|line| line.strip_prefix("set-cookie: "));
    cookie
        .and_then(|cookie| cookie.split(';').next())
        .map(str::to_owned)
        .ok_or(answer)
}

#[test]
fn a_page_that_others_reach_wants_its_password() {
    let stage = Stage::start("127.0.0.1:0");
    let options = PageOptions {
        password: Some("correct horse".to_owned()),
        public_url: Some("https://stage.example.org".to_owned()),
        ..PageOptions::local("127.0.0.1:0")
    };
    let page = Page::start(&options, Endpoint::Tcp(stage.address.to_string())).unwrap();
    let (address, place) = (page.address(), page.address().to_string());
    for (path, status) in [
        ("/", "303"),
        ("/token", "401"),
        ("/live", "401"),
        ("/js/main.js", "401"),
        ("/login", "200"),
    ] {
        let answer = get(address, path, &place);
        assert!(
            answer.starts_with(&format!("HTTP/1.1 {status}")),
            "{path}: {answer}"
        );
    }
    assert_eq!(
        connect(&page, Some(&format!("http://{place}"))).err(),
        Some(401)
    );
    let own = format!("http://{place}");
    // Nobody else's page tries for its user.
    assert!(
        enter(address, "http://evil.example", "correct+horse")
            .unwrap_err()
            .starts_with("HTTP/1.1 403")
    );
    let wrong = enter(address, &own, "wrong").unwrap_err();
    assert!(wrong.contains("not the password"), "{wrong}");
    let soon = enter(address, &own, "correct+horse").unwrap_err();
    assert!(soon.contains("too soon"), "{soon}");
    thread::sleep(Duration::from_millis(1_100));
    // Through the proxy as well.
    let cookie = enter(address, "https://stage.example.org", "correct+horse").unwrap();
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    let host = "stage.example.org";
    write!(
        stream,
        "GET /token HTTP/1.1\r\nHost: {host}\r\nCookie: {cookie}\r\nConnection: close\r\n\r\n"
    )
    .unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
}

//! Dead, flooding and half-open clients: none takes another's place, the stage's time or the disk.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::process::{Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use crate::served::{PATIENCE, Served, connect};
use desk::line::Endpoint;
use desk::serve::{Controller, Notice, ServeOptions, Server};
use desk::web::{Page, PageOptions};
use firmware::fault::Fault;
use firmware::gcs::Session;
use hal_sim::machine::devices::SettingsFlash;
use hal_sim::rig::ControllerMemory;
use hal_sim::rig::run::RunOptions;
use tripivot::simulated::Simulated;

/// A script that waits for what never comes, with so many lines behind it that nothing more is read, and then dies.
fn die_behind_a_wait(served: &Served) {
    let mut client = served.connect();
    client.send("CSV?\nWAC POS? X = 99\n");
    client.port.set_nonblocking(true).unwrap();
    let lines = "MOV X 1\n".repeat(1024);
    let mut refused = 0;
    while refused < 5 {
        if client.port.write(lines.as_bytes()).is_err() {
            refused += 1;
            thread::sleep(Duration::from_millis(5));
        }
    }
    // The answer has not been read: the connection is reset.
}

#[test]
fn a_client_that_died_behind_a_wait_frees_its_place() {
    let served = Served::start(1.0, false);
    for _ in 0..3 {
        die_behind_a_wait(&served);
        let died = Instant::now();
        served.notice(|notice| matches!(notice, Notice::Left(_)));
        // Its end is told; a client that is not even told has the keepalive's twelve seconds.
        assert!(
            died.elapsed() < Duration::from_secs(10),
            "{:?}",
            died.elapsed()
        );
    }
}

#[test]
fn a_stop_finds_a_place_when_there_is_none() {
    let served = Served::start(1.0, false);
    let mut mover = served.ready();
    mover.send("VLS 1\nMOV X 60\nMOV? X\n");
    assert_eq!(mover.reply(), "X=60\n");
    let mut clients: Vec<_> = (0..63).map(|_| served.connect()).collect();
    assert_eq!(clients[62].ask("CSV?\n"), "2.0\n");
    for stop in ["\x18", "STP\n", "MOV X 3\nhlt X\n"] {
        assert_eq!(mover.ask("MOV X 60\nDEL 100\n\x05"), "1\n");
        let mut late = served.connect();
        served.notice(|notice| matches!(notice, Notice::TurnedAway(_)));
        late.send(stop);
        assert_eq!(mover.ask("WAC ONT? X = 1\nERR?\n"), "10\n");
        assert!(mover.value("MOV? X\n") < 50.0, "{stop:?}");
        // Nothing else is taken from it, and it does not stay.
        let mut rest = Vec::new();
        let _ = late.port.read_to_end(&mut rest);
        assert_eq!(rest, b"");
    }
    // Nor do many that come and say nothing stand in its way: each would have half a second.
    assert_eq!(mover.ask("MOV X 60\n\x05"), "1\n");
    let silent: Vec<_> = (0..60).map(|_| served.connect()).collect();
    let begun = Instant::now();
    served.connect().send("STP\n");
    assert_eq!(mover.ask("WAC ONT? X = 1\nERR?\n"), "10\n");
    assert!(
        begun.elapsed() < Duration::from_secs(3),
        "{:?}",
        begun.elapsed()
    );
    drop(silent);
}

/// A stage whose lines take a millisecond each.
struct Slow<'a> {
    stage: Simulated<'a>,
    /// Lines since the last tick, and the most between two.
    lines: usize,
    most_lines: usize,
    all_lines: Arc<AtomicUsize>,
}

impl Controller for Slow<'_> {
    fn rate_hz(&self) -> f64 {
        self.stage.rate_hz()
    }

    fn tick(&mut self) {
        self.most_lines = self.most_lines.max(self.lines);
        self.lines = 0;
        self.stage.tick();
    }

    fn advance(&mut self) {
        self.stage.advance();
    }

    fn service<W: embedded_io::Write>(
        &mut self,
        session: &mut Session,
        replies: &mut W,
    ) -> Result<(), W::Error> {
        if !session.is_idle() {
            self.lines += 1;
            self.all_lines.fetch_add(1, Ordering::Relaxed);
            thread::sleep(Duration::from_millis(1));
        }
        self.stage.service(session, replies)
    }

    fn disconnect(&mut self, session: &mut Session) {
        self.stage.disconnect(session);
    }

    fn keep(&mut self) {
        self.stage.keep();
    }

    fn restart_if_wanted(&mut self) -> bool {
        self.stage.restart_if_wanted()
    }

    fn fault(&self) -> Option<Fault> {
        self.stage.fault()
    }
}

/// Such a stage, served. What comes of `drive`, and the most lines between two ticks.
fn with_slow<T>(drive: impl FnOnce(SocketAddr, &AtomicUsize) -> T) -> (T, usize) {
    let options = ServeOptions {
        listen: "127.0.0.1:0".into(),
        speed: 1.0,
        terminal: false,
    };
    let server = Server::bind(options).unwrap();
    let address = server.address().unwrap();
    let stop = Arc::new(AtomicBool::new(false));
    let stopped = Arc::clone(&stop);
    let all_lines = Arc::<AtomicUsize>::default();
    let counted = Arc::clone(&all_lines);
    let serving = thread::spawn(move || {
        let mut memory = ControllerMemory::new();
        let stage = Simulated::new(
            &mut memory,
            &RunOptions::default(),
            SettingsFlash::in_memory(),
        );
        let mut slow = Slow {
            stage,
            lines: 0,
            most_lines: 0,
            all_lines: counted,
        };
        server.run(&mut slow, &stopped, &mut drop).unwrap();
        slow.most_lines
    });
    let result = drive(address, &all_lines);
    stop.store(true, Ordering::Relaxed);
    (result, serving.join().unwrap())
}

#[test]
fn a_stop_waits_for_no_flood() {
    let (mut waited, _) = with_slow(|address, lines| {
        let floods: Vec<_> = (0..40)
            .map(|_| {
                let mut flood = connect(address);
                flood.send(&"x\n".repeat(100));
                flood
            })
            .collect();
        let mut stopper = connect(address);
        let mut waited = Vec::new();
        for _ in 0..11 {
            let before = lines.load(Ordering::Relaxed);
            // The stop has no answer, the question behind it has.
            assert_eq!(stopper.ask("\x18\x05"), "0\n");
            waited.push(lines.load(Ordering::Relaxed) - before);
        }
        drop(floods);
        waited
    });
    waited.sort_unstable();
    // Half of 40, one a turn, if it had to wait for its turn.
    assert!(waited[5] < 10, "{waited:?}");
}

#[test]
fn a_flood_of_lines_does_not_take_the_time_of_the_stage() {
    let ((), most_lines) = with_slow(|address, _| flood_and_wait(address));
    // A turn's time is less than a line's here: one is carried out in it, and one more where no tick was due.
    assert!((1..=2).contains(&most_lines), "{most_lines}");
}

fn flood_and_wait(address: SocketAddr) {
    let mut floods: Vec<_> = (0..4).map(|_| connect(address)).collect();
    for flood in &mut floods {
        flood.send(&"x\n".repeat(500));
    }
    for flood in &mut floods {
        // Answered when all of it has been carried out: none waits for ever.
        assert_eq!(flood.ask("CSV?\n"), "2.0\n");
    }
}

#[test]
fn a_request_that_never_comes_does_not_keep_its_place() {
    let served = Served::start(1.0, false);
    let endpoint = Endpoint::Tcp(served.address.to_string());
    let page = Page::start(&PageOptions::local("127.0.0.1:0"), endpoint).unwrap();
    let half_open: Vec<_> = (0..80)
        .map(|_| {
            let mut stream = TcpStream::connect(page.address()).unwrap();
            stream.write_all(b"GET / HTTP/1.1\r\n").unwrap();
            stream
        })
        .collect();
    // More than are served at once: an honest one is answered when the first of them have been given up.
    let mut honest = TcpStream::connect(page.address()).unwrap();
    honest.set_read_timeout(Some(PATIENCE)).unwrap();
    let request = format!(
        "GET / HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n",
        page.address()
    );
    honest.write_all(request.as_bytes()).unwrap();
    let mut answer = String::new();
    honest.read_to_string(&mut answer).unwrap();
    assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
    for mut stream in half_open {
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        let mut rest = Vec::new();
        assert!(stream.read_to_end(&mut rest).is_ok(), "still held");
    }
}

#[test]
fn a_log_has_a_bound() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_tripivot"))
        .args(["serve", "--listen", "127.0.0.1:0", "--web", "off"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut out = child.stdout.take().unwrap();
    let mut first = Vec::new();
    while first.last() != Some(&b'\n') {
        let mut byte = [0];
        out.read_exact(&mut byte).unwrap();
        first.push(byte[0]);
    }
    let address = String::from_utf8(first).unwrap();
    let address = address
        .trim()
        .strip_prefix("listening at ")
        .unwrap()
        .parse()
        .unwrap();
    let mut client = connect(address);
    for _ in 0..20 {
        client.send(&"x\nERR?\n".repeat(100));
        (0..100).for_each(|_| assert_eq!(client.reply(), "2\n"));
    }
    let interrupted = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(interrupted.unwrap().success());
    child.wait().unwrap();
    let mut log = String::new();
    out.read_to_string(&mut log).unwrap();
    let told = log
        .lines()
        .filter(|line| line.ends_with("error 2 after x"))
        .count();
    let counted = |line: &str| {
        line.strip_prefix('(')?
            .strip_suffix(" notices left out)")?
            .parse::<usize>()
            .ok()
    };
    let left_out: usize = log.lines().filter_map(counted).sum();
    // Two that come between two looks at the error are told as one.
    assert!((1_000..=2_000).contains(&(told + left_out)), "{log}");
    assert!(told < 1_000, "{told}");
}

/// At a port where somebody says a line over and over, with a pause between: what the program says that is to find a
/// controller there.
fn said_of_talk(pause: Duration) -> Vec<String> {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap().to_string();
    thread::spawn(move || {
        for stream in listener.incoming() {
            let mut stream = stream.unwrap();
            while stream.write_all(b"temperature 21.5\r\n").is_ok() {
                thread::sleep(pause);
            }
        }
    });
    let name = format!("tripivot-talk-{}-{}", pause.as_millis(), std::process::id());
    let folder = std::env::temp_dir().join(name);
    let file = folder.join("settings");
    let programs = [
        ["settings", "export", file.to_str().unwrap()],
        ["record", "--out", folder.to_str().unwrap()],
        ["view", "--web", "127.0.0.1:0"],
    ];
    programs
        .map(|arguments| {
            let output = Command::new(env!("CARGO_BIN_EXE_tripivot"))
                .args(arguments)
                .args(["--connect", &address])
                .output()
                .unwrap();
            assert_eq!(output.status.code(), Some(2), "{output:?}");
            assert!(!folder.exists(), "a folder was left");
            let said = String::from_utf8(output.stderr).unwrap();
            assert!(said.contains("this is no controller"), "{said}");
            said
        })
        .into()
}

#[test]
fn a_line_that_never_stops_talking_is_no_controller() {
    for said in said_of_talk(Duration::ZERO) {
        // A machine that holds the talker up makes pauses of its own.
        let is_heard_out = said.contains("temperature 21.5");
        assert!(
            said.contains("never stops sending") || is_heard_out,
            "{said}"
        );
    }
}

#[test]
fn a_line_that_talks_now_and_then_is_no_controller() {
    for said in said_of_talk(Duration::from_millis(200)) {
        assert!(said.contains("temperature 21.5"), "{said}");
    }
}

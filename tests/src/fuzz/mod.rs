//! A fuzz target: random sessions, with faults now and then, on the controller's own command side and tick over an ideal
//! stage.
//!
//! What holds whatever is sent, and is looked at in every tick or after every line:
//! - nothing panics;
//! - a line that leaves an error has changed nothing;
//! - the setpoint never steps: position follows from velocity, velocity from acceleration, and that is bounded; so do pivots;
//! - with the servo off, or a fault, nothing drives.
//!
//! A case is its seed: the same one does the same everywhere.

mod settings;
mod watch;
mod words;

use hal_sim::random::Random;
pub use settings::run as run_settings;

use crate::ideal::{Connection, Ideal, Trouble};
use watch::Watch;

/// Connections of a case.
const CONNECTIONS: usize = 3;
/// The one that looks and never commands.
const OBSERVER: usize = CONNECTIONS;
/// Things that happen in a case.
const STEPS: usize = 60;

/// What does not change when a line is refused. Who asks is another connection, which sees the same.
const STATE: &[u8] =
    b"MOV?\nSVO?\nFRF?\nVLS?\nNLM?\nPLM?\nSSL?\nSPA?\nVAR?\nMAC?\nMAC FREE?\nRMC?\nHBT?\nERR?\n";

/// A case under way.
struct Case {
    random: Random,
    stage: Ideal,
    watch: Watch,
    names: Vec<String>,
}

/// Carries out a case of each kind.
///
/// # Panics
/// When something did not hold; the message says what.
pub fn run_all(seed: u64) {
    run_settings(seed);
    run(seed);
}

/// Carries out a case.
///
/// # Panics
/// When something did not hold; the message says what, and after which line.
pub fn run(seed: u64) {
    let mut stage = Ideal::new(CONNECTIONS + 1);
    // With some parameters the voltage is far from what holds the stage; encoders without noise would be taken for frozen then.
    stage.flicker = true;
    stage.run(10);
    let help = stage.ask(OBSERVER, b"HLP?\n");
    let names = names(&String::from_utf8_lossy(&help));
    let mut case = Case {
        random: Random::new(seed),
        stage,
        watch: Watch::default(),
        names,
    };
    for _ in 0..STEPS {
        case.step();
    }
}

/// The names of the commands that `HLP?` lists.
fn names(help: &str) -> Vec<String> {
    let lines: Vec<_> = help.lines().collect();
    let names = lines[1..lines.len() - 1].iter().map(|line| {
        let mut words = line.split(' ');
        let first = words.next().unwrap_or_default();
        match (first, words.next()) {
            ("MAC", Some(keyword)) => format!("MAC {keyword}"),
            _ => first.to_owned(),
        }
    });
    names.collect()
}

impl Case {
    fn step(&mut self) {
        match self.random.index(20) {
            0 => self.trouble(),
            1 => self.reconnect(),
            2..=7 => self.check_line(),
            _ => self.send(),
        }
        let ticks = match self.random.index(6) {
            0 => 400,
            1 | 2 => 60,
            _ => self.random.index(8) as u32,
        };
        self.ticks(ticks);
    }

    fn ticks(&mut self, ticks: u32) {
        for _ in 0..ticks {
            self.stage.tick();
            self.watch.look(&self.stage);
        }
    }

    /// Sends lines to a connection, in pieces.
    fn send(&mut self) {
        let number = self.random.index(CONNECTIONS);
        for _ in 0..=self.random.index(3) {
            let mut line = words::line(&mut self.random, &self.names);
            self.watch.note(&line);
            while !line.is_empty() {
                let cut = 1 + self.random.index(line.len());
                let piece: Vec<u8> = line.drain(..cut).collect();
                self.stage.connections[number].input.extend(piece);
                if self.random.once_in(3) {
                    self.ticks(1);
                }
            }
        }
    }

    /// A client goes, another comes.
    fn reconnect(&mut self) {
        let number = self.random.index(CONNECTIONS);
        self.stage.connections[number] = Connection::default();
    }

    /// Something is wrong with the hardware for a while.
    fn trouble(&mut self) {
        let mut trouble = Trouble::default();
        match self.random.index(4) {
            0 => trouble.emergency_stop = true,
            1 => trouble.silent[self.random.index(3)] = true,
            2 => trouble.bridge = true,
            _ => trouble.no_supply = true,
        }
        self.stage.trouble = trouble;
        let ticks = 1 + self.random.index(10) as u32;
        self.ticks(ticks);
        self.stage.trouble = Trouble::default();
    }

    /// With everything at rest: a line with an error leaves everything as it was.
    fn check_line(&mut self) {
        let silence = self.last_silence();
        self.make_quiet();
        let line = words::line(&mut self.random, &self.names);
        // What may be several lines, or part of one, has no single error; a stop is an error that does something; and what is
        // recorded is lost with its error.
        let text = String::from_utf8_lossy(&line).to_ascii_uppercase();
        let printable = |bytes: &[u8]| bytes.iter().all(|byte| matches!(byte, b' '..=b'~'));
        let whole = line.strip_suffix(b"\n").is_some_and(printable);
        let skipped = ["MAC END", "RBT", "HBT", "WAC", "DEL"];
        if !whole || skipped.iter().any(|word| text.contains(word)) {
            return;
        }
        self.watch.note(&line);
        // With the error that a fault has set, which is told once.
        let faults = self.stage.ask(OBSERVER, b"FLT?\nERR?\n");
        let before = self.state();
        let mut probe = line;
        probe.extend(b"ERR?\n");
        let answer = self.stage.ask(0, &probe);
        self.watch.look(&self.stage);
        let answer = String::from_utf8_lossy(&answer).into_owned();
        let error = answer.lines().last().unwrap_or("none").trim().to_owned();
        if self.stage.ask(OBSERVER, b"FLT?\nERR?\n") != faults {
            // What was asked for has been done, and has met a fault: with some parameters the encoders show impossible pivots.
            return;
        }
        let after = self.state();
        if self.last_silence() != silence {
            // A client that went had promised to be heard: everyone was told of a stop meanwhile.
            return;
        }
        if error != "0" && error != "10" && self.stage.connections[0].session.is_idle() {
            assert_eq!(
                String::from_utf8_lossy(&before),
                String::from_utf8_lossy(&after),
                "error {error} has changed something: {}; {}",
                self.watch.story(),
                String::from_utf8_lossy(&self.stage.ask(OBSERVER, b"FLT?\nEVT?\n")),
            );
        }
    }

    /// No motion, no macro, no wait, no error; commanding goes on from here.
    fn make_quiet(&mut self) {
        for connection in &mut self.stage.connections[..CONNECTIONS] {
            *connection = Connection::default();
        }
        self.stage.ask(0, b"\x18HBT 0\nCCL 1 ADVANCED\n");
        for _ in 0..100 {
            if self.stage.ask(OBSERVER, b"\x05\x08") == b"0\n0\n" {
                break;
            }
            self.ticks(100);
        }
        // Behind the number of a stop there may be that of a fault.
        for connection in [OBSERVER, 0] {
            for _ in 0..4 {
                if self.stage.ask(connection, b"ERR?\n") == b"0\n" {
                    break;
                }
            }
        }
    }

    /// The newest event of a silent host.
    fn last_silence(&mut self) -> Option<String> {
        let events = self.stage.ask(OBSERVER, b"EVT?\n");
        let events = String::from_utf8_lossy(&events).into_owned();
        let mut silences = events.lines().filter(|line| line.contains("no host heard"));
        silences.next_back().map(str::to_owned)
    }

    fn state(&mut self) -> Vec<u8> {
        self.stage.ask(OBSERVER, STATE)
    }
}

//! A command side with several connections in front of a tick that moves exactly as commanded.
#![allow(dead_code)] // Each test file uses its part.

use core::convert::Infallible;
use firmware::gcs::{Identity, Interpreter, Session};
use firmware::parameters::Parameters;
use firmware::queues::{CommandQueues, Queues};

pub mod axes;
pub mod fake_tick;
pub use fake_tick::{DWELL, FakeTick};

/// What the command side has written.
#[derive(Default)]
pub struct Written(pub Vec<u8>);

impl embedded_io::ErrorType for Written {
    type Error = Infallible;
}

impl embedded_io::Write for Written {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        self.0.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

/// The command side of the reference stage.
pub fn reference_panel() -> Interpreter {
    let identity = Identity {
        serial: "4711",
        version: "0.1.0",
    };
    Interpreter::new(&Parameters::REFERENCE, identity)
}

/// A bench with queues of its own.
pub type Bench = BenchBetween<'static>;

/// The command side, its connections and the tick.
pub struct BenchBetween<'q> {
    panel: Interpreter,
    sessions: Vec<(Session, Written)>,
    pub queues: CommandQueues<'q>,
    pub tick: FakeTick<'q>,
}

impl Bench {
    /// One connection, nothing has run yet.
    pub fn cold() -> Self {
        Self::with(reference_panel())
    }

    /// The same with this command side.
    pub fn with(panel: Interpreter) -> Self {
        Self::new_between(panel, Box::leak(Box::new(Queues::new())))
    }

    /// Running, not referenced.
    pub fn new() -> Self {
        let mut bench = Self::cold();
        bench.run(2);
        bench
    }

    /// Referenced at the origin, settled.
    pub fn ready() -> Self {
        let mut bench = Self::new();
        bench.reference();
        bench
    }
}

impl<'q> BenchBetween<'q> {
    /// One connection, nothing has run yet; for whoever makes thousands of benches and
    /// has the queues back after each.
    pub fn new_between(panel: Interpreter, queues: &'q mut Queues) -> Self {
        let (tick, queues) = queues.split();
        Self {
            panel,
            sessions: vec![(Session::new(), Written::default())],
            queues,
            tick: FakeTick::new(tick, &Parameters::REFERENCE),
        }
    }

    /// References, and waits until the stage has settled.
    pub fn reference(&mut self) {
        assert_eq!(self.say("FRF\n"), "");
        self.run(2 * DWELL);
        assert_eq!(self.say("ERR?\n"), "0\n");
        self.tick.log.clear();
    }

    /// One more connection; its number.
    pub fn connect(&mut self) -> usize {
        self.sessions.push((Session::new(), Written::default()));
        self.service(self.sessions.len() - 1);
        self.sessions.len() - 1
    }

    /// A connection ends, and nothing of it is serviced any more.
    pub fn disconnect(&mut self, number: usize) {
        let (mut session, _) = self.sessions.remove(number);
        self.panel.disconnect(&mut session);
    }

    pub fn service(&mut self, number: usize) {
        let (session, out) = &mut self.sessions[number];
        match self.panel.service(session, &mut self.queues, out) {
            Ok(()) => {}
        }
    }

    /// Services the first connection with another output.
    pub fn service_into<W: embedded_io::Write>(&mut self, out: &mut W) -> Result<(), W::Error> {
        self.panel
            .service(&mut self.sessions[0].0, &mut self.queues, out)
    }

    pub fn session(&mut self, number: usize) -> &mut Session {
        &mut self.sessions[number].0
    }

    /// Offers bytes to a connection, servicing it whenever it has no room; no tick runs. False when it takes no more.
    pub fn offer(&mut self, number: usize, mut bytes: &[u8]) -> bool {
        let mut refusals = 0;
        while refusals < 2 {
            let taken = self.session(number).receive(bytes);
            bytes = &bytes[taken..];
            self.service(number);
            if bytes.is_empty() {
                return true;
            }
            refusals = if taken == 0 { refusals + 1 } else { 0 };
        }
        false
    }

    /// A tick and a service of every connection, `ticks` times.
    pub fn run(&mut self, ticks: u64) {
        for _ in 0..ticks {
            self.tick.run();
            for number in 0..self.sessions.len() {
                self.service(number);
            }
        }
    }

    /// Runs until the tick holds and is settled.
    pub fn run_to_rest(&mut self) {
        for _ in 0..1_000_000 {
            self.run(1);
            if self.say("\x05") == "0\n" {
                return;
            }
        }
        panic!("never at rest");
    }

    pub fn panel(&self) -> &Interpreter {
        &self.panel
    }

    /// What is stored of it.
    pub fn contents(&mut self) -> firmware::gcs::Contents<'_, 'q> {
        self.panel.contents(&mut self.queues.trial)
    }

    pub fn panel_mut(&mut self) -> &mut Interpreter {
        &mut self.panel
    }

    /// What a connection has been answered since the last time.
    pub fn answers_of(&mut self, number: usize) -> Vec<u8> {
        core::mem::take(&mut self.sessions[number].1.0)
    }

    /// Sends to the first connection, runs three ticks (for what waits for one), and returns its answers.
    pub fn say(&mut self, bytes: &str) -> String {
        self.say_to(0, bytes)
    }

    pub fn say_to(&mut self, number: usize, bytes: &str) -> String {
        assert!(self.offer(number, bytes.as_bytes()), "no room");
        self.run(3);
        let answers = self.answers_of(number);
        answers.iter().map(|&byte| char::from(byte)).collect()
    }

    /// The number that a query of one axis answers.
    pub fn value(&mut self, query: &str) -> f64 {
        let answer = self.say(&format!("{query}\n"));
        let (_, number) = answer.trim_end().split_once('=').expect("one answer");
        number.parse().expect("a number")
    }

    /// The error after `bytes`, which are answered by nothing else.
    pub fn error_after(&mut self, bytes: &str) -> String {
        let answer = self.say(&format!("{bytes}\nERR?\n"));
        answer.trim_end().to_string()
    }
}

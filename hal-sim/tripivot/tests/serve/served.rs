//! A simulated stage that is served in a thread of the test, and clients that wait for their answers.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use desk::serve::{Notice, Pacing, ServeOptions, Server};
use hal_sim::machine::devices::SettingsFlash;
use hal_sim::rig::ControllerMemory;
use hal_sim::rig::run::RunOptions;
use tripivot::simulated::Simulated;

/// Far longer than anything here takes, on a busy machine too.
pub const PATIENCE: Duration = Duration::from_secs(60);

/// A server in a thread of the test.
pub struct Served {
    pub address: SocketAddr,
    pub terminal: Option<PathBuf>,
    pub notices: Receiver<Notice>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<Pacing>>,
}

impl Served {
    pub fn start(speed: f64, terminal: bool) -> Self {
        let run = RunOptions::default();
        let server = Server::bind(ServeOptions {
            listen: "127.0.0.1:0".into(),
            speed,
            terminal,
        })
        .unwrap();
        let (address, path) = (server.address().unwrap(), server.terminal().map(Into::into));
        let stop = Arc::new(AtomicBool::new(false));
        let (say, notices) = channel();
        let stopped = Arc::clone(&stop);
        let thread = thread::spawn(move || {
            let mut say = |notice| drop(say.send(notice));
            let mut memory = ControllerMemory::new();
            let mut stage = Simulated::new(&mut memory, &run, SettingsFlash::in_memory());
            server.run(&mut stage, &stopped, &mut say).unwrap()
        });
        Self {
            address,
            terminal: path,
            notices,
            stop,
            thread: Some(thread),
        }
    }

    pub fn connect(&self) -> Client<TcpStream> {
        connect(self.address)
    }

    /// A stage that is referenced and settled.
    pub fn ready(&self) -> Client<TcpStream> {
        let mut client = self.connect();
        assert_eq!(client.ask("FRF\nWAC ONT? X = 1\nERR?\n"), "0\n");
        client
    }

    /// The next notice that `wanted` knows.
    pub fn notice(&self, wanted: impl Fn(&Notice) -> bool) -> Notice {
        let end = Instant::now() + PATIENCE;
        loop {
            let left = end.saturating_duration_since(Instant::now());
            let notice = self.notices.recv_timeout(left).expect("a notice");
            if wanted(&notice) {
                return notice;
            }
        }
    }

    /// Ends it; how well it kept to the clock.
    pub fn end(mut self) -> Pacing {
        self.stop.store(true, Ordering::Relaxed);
        self.thread.take().unwrap().join().unwrap()
    }

    pub fn assert_no_fault(&self) {
        let fault = (self.notices.try_iter()).find(|notice| matches!(notice, Notice::Fault(_)));
        assert_eq!(fault, None);
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        let result = self.thread.take().map(JoinHandle::join);
        assert!(thread::panicking() || !matches!(result, Some(Err(_))));
    }
}

/// A client that waits for its answers.
pub struct Client<P> {
    pub port: P,
    pub received: Vec<u8>,
}

pub fn connect(address: SocketAddr) -> Client<TcpStream> {
    let port = TcpStream::connect(address).unwrap();
    port.set_nodelay(true).unwrap();
    port.set_read_timeout(Some(PATIENCE)).unwrap();
    Client {
        port,
        received: Vec::new(),
    }
}

impl<P: Read + Write> Client<P> {
    pub fn send(&mut self, text: &str) {
        self.port.write_all(text.as_bytes()).unwrap();
    }

    /// The next whole reply.
    pub fn reply(&mut self) -> String {
        loop {
            let bytes = &self.received;
            let end =
                (0..bytes.len()).find(|&i| bytes[i] == b'\n' && (i == 0 || bytes[i - 1] != b' '));
            if let Some(end) = end {
                let reply = self.received.drain(..=end).collect();
                return String::from_utf8(reply).unwrap();
            }
            let mut bytes = [0; 4096];
            let count = self.port.read(&mut bytes).expect("a reply");
            assert_ne!(count, 0, "the connection was closed");
            self.received.extend_from_slice(&bytes[..count]);
        }
    }

    pub fn ask(&mut self, text: &str) -> String {
        self.send(text);
        self.reply()
    }

    pub fn value(&mut self, query: &str) -> f64 {
        let reply = self.ask(query);
        let (_, value) = reply.trim_end().split_once('=').expect("axis=value");
        value.parse().unwrap()
    }
}

//! Who does not wait for answers, does not read them, or dies.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::Duration;

use serde_json::json;
use tungstenite::Message;

use crate::honest::open;

/// What is sent without pause; questions are answered, and read.
pub const FLOODS: [&str; 4] = ["x\n", "POS?\n", "HPA?\n", "MOV? X\n"];
/// Lines at a time.
const LINES: usize = 500;
/// Between two deaths, and between two messages that a slow page reads.
const DEATH_EVERY: Duration = Duration::from_millis(200);
const READ_EVERY: Duration = Duration::from_millis(500);

/// Sends a line over and over. Who is cut off comes again.
pub fn flood(address: SocketAddr, line: &str, done: &AtomicBool) {
    let lines = line.repeat(LINES);
    while !done.load(Ordering::Relaxed) {
        let Ok(mut port) = TcpStream::connect(address) else {
            continue;
        };
        // So that the end of the run is seen.
        let _ = port.set_write_timeout(Some(READ_EVERY));
        let Ok(mut replies) = port.try_clone() else {
            continue;
        };
        let _ = replies.set_read_timeout(Some(READ_EVERY));
        thread::scope(|scope| {
            scope.spawn(move || {
                let mut bytes = [0; 1 << 16];
                while !is_gone(replies.read(&mut bytes)) && !done.load(Ordering::Relaxed) {}
            });
            while !done.load(Ordering::Relaxed) && !is_gone(port.write(lines.as_bytes())) {}
            let _ = port.shutdown(std::net::Shutdown::Both);
        });
    }
}

/// Whether the other end is.
fn is_gone(result: std::io::Result<usize>) -> bool {
    use std::io::ErrorKind::{Interrupted, TimedOut, WouldBlock};
    match result {
        Ok(count) => count == 0,
        Err(error) => ![Interrupted, TimedOut, WouldBlock].contains(&error.kind()),
    }
}

/// Asks for much and reads nothing; when it is cut off it comes again.
pub fn deaf_client(address: SocketAddr, done: &AtomicBool) {
    while !done.load(Ordering::Relaxed) {
        if let Ok(mut port) = TcpStream::connect(address) {
            let _ = port.set_write_timeout(Some(READ_EVERY));
            while !done.load(Ordering::Relaxed) && !is_gone(port.write(b"HLP?\n")) {
                thread::sleep(Duration::from_millis(1));
            }
        }
        thread::sleep(READ_EVERY);
    }
}

/// Reads a message of the status now and then; when it is given up it comes again.
pub fn slow_page(place: SocketAddr, done: &AtomicBool) {
    while !done.load(Ordering::Relaxed) {
        let Some((mut socket, _)) = open(place) else {
            continue;
        };
        while !done.load(Ordering::Relaxed) && socket.read().is_ok() {
            thread::sleep(READ_EVERY);
        }
    }
}

/// Pages that ask for something and are gone before it is answered.
pub fn dying_pages(place: SocketAddr, deaths: &AtomicU64, done: &AtomicBool) {
    for number in 0_u64.. {
        if done.load(Ordering::Relaxed) {
            return;
        }
        if let Some((mut socket, token)) = open(place) {
            let line = ["POS?", "WAC POS? X = 99", "OWN?"][number as usize % 3];
            let asked = json!({"id": 1, "token": token, "line": line}).to_string();
            if socket.send(Message::text(asked)).is_ok() {
                deaths.fetch_add(1, Ordering::Relaxed);
            }
        }
        thread::sleep(DEATH_EVERY);
    }
}

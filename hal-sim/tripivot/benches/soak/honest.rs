//! Who waits for answers, and counts what is wrong with them.

use std::fmt;
use std::io::{BufRead, BufReader, Write};
use std::net::{SocketAddr, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket};

use crate::latency::Latency;

/// Longest wait for an answer, on a busy machine too.
pub const PATIENCE: Duration = Duration::from_secs(60);
/// Between two questions.
const EVERY: Duration = Duration::from_millis(20);
/// Questions between two moves of the client that moves.
const MOVE_EVERY: u64 = 100;
/// Questions, and how their answers begin.
const QUESTIONS: [(&str, &str); 4] = [
    ("POS? X", "X="),
    ("ERR?", "0\n"),
    ("*IDN?", "(c)2026 Tripivot"),
    ("MOV? W", "W="),
];
/// Problems that are kept of one client.
const KEPT: usize = 5;

/// What became of the questions.
#[derive(Default)]
pub struct Tally {
    pub latency: Latency,
    pub problems: Vec<String>,
}

impl Tally {
    pub fn add(&mut self, other: &Self) {
        self.latency.add(&other.latency);
        self.problems.extend_from_slice(&other.problems);
    }

    fn note(&mut self, begun: Instant, question: &str, answer: &str, expected: &str) {
        self.latency.note(begun.elapsed());
        if !answer.starts_with(expected) {
            self.complain(format!("{question} answers {answer:?}"));
        }
    }

    fn complain(&mut self, problem: String) {
        if self.problems.len() < KEPT {
            self.problems.push(problem);
        }
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [half, most, all] = [0.5, 0.99, 1.0].map(|share| self.latency.quantile_ms(share));
        let count = self.latency.count();
        write!(f, "{count:>10}{half:>7.2} ms{most:>7.2} ms{all:>7.1} ms")
    }
}

/// A client that asks over and over; one of them moves the stage.
pub fn client(address: SocketAddr, moves: bool, done: &AtomicBool) -> Tally {
    let mut port = TcpStream::connect(address).expect("a place");
    port.set_nodelay(true).expect("a socket");
    port.set_read_timeout(Some(PATIENCE)).expect("a socket");
    let mut replies = BufReader::new(port.try_clone().expect("a socket"));
    let mut tally = Tally::default();
    if moves {
        port.write_all(b"FRF\n").expect("the server");
    }
    for number in 0_u64.. {
        if done.load(Ordering::Relaxed) {
            break;
        }
        if moves && number % MOVE_EVERY == 50 {
            let target = if (number / MOVE_EVERY).is_multiple_of(2) {
                30
            } else {
                -30
            };
            port.write_all(format!("MOV X {target} W {target}\n").as_bytes())
                .expect("the server");
        }
        let (question, expected) = QUESTIONS[number as usize % QUESTIONS.len()];
        let begun = Instant::now();
        let mut answer = String::new();
        let asked = port.write_all(format!("{question}\n").as_bytes());
        match asked.and_then(|()| replies.read_line(&mut answer)) {
            Ok(_) => tally.note(begun, question, &answer, expected),
            Err(error) => {
                tally.complain(format!("{question}: {error}"));
                break;
            }
        }
        thread::sleep(EVERY);
    }
    tally
}

/// A page that asks over and over, and misses no status.
pub fn page(place: SocketAddr, done: &AtomicBool) -> Tally {
    let mut tally = Tally::default();
    let (mut socket, token) = open(place).expect("a page");
    for number in 0_u64.. {
        if done.load(Ordering::Relaxed) {
            break;
        }
        let (question, expected) = QUESTIONS[number as usize % QUESTIONS.len()];
        // What a page asks is followed by its error: `ERR?` has an answer of its own all the same.
        let begun = Instant::now();
        let asked = json!({"id": number, "token": token, "line": question});
        let sent = socket.send(Message::text(asked.to_string()));
        let answer = sent.and_then(|()| answer(&mut socket, number, &mut tally));
        match answer {
            Ok(answer) => {
                let reply = format!("{}\n", answer["reply"].as_str().unwrap_or("nothing"));
                tally.note(begun, question, &reply, expected);
            }
            Err(error) => {
                tally.complain(format!("{question}: {error}"));
                break;
            }
        }
        thread::sleep(EVERY);
    }
    tally
}

fn answer(
    socket: &mut WebSocket<TcpStream>,
    id: u64,
    tally: &mut Tally,
) -> Result<Value, tungstenite::Error> {
    loop {
        let Message::Text(text) = socket.read()? else {
            continue;
        };
        let message: Value = serde_json::from_str(&text).expect("JSON");
        if message["kind"] == "lost" {
            tally.complain(message.to_string());
        } else if message["id"] == id {
            return Ok(message);
        }
    }
}

/// A page's connection to the server, and its token.
pub fn open(place: SocketAddr) -> Option<(WebSocket<TcpStream>, String)> {
    let token = token_of(place)?;
    let stream = TcpStream::connect(place).ok()?;
    stream.set_read_timeout(Some(PATIENCE)).ok()?;
    stream.set_nodelay(true).ok()?;
    let mut request = format!("ws://{place}/live").into_client_request().ok()?;
    let origin = format!("http://{place}").parse().ok()?;
    request.headers_mut().insert("Origin", origin);
    Some((tungstenite::client(request, stream).ok()?.0, token))
}

fn token_of(place: SocketAddr) -> Option<String> {
    let mut stream = TcpStream::connect(place).ok()?;
    stream.set_read_timeout(Some(PATIENCE)).ok()?;
    write!(
        stream,
        "GET /token HTTP/1.1\r\nHost: {place}\r\nConnection: close\r\n\r\n"
    )
    .ok()?;
    let answer = std::io::read_to_string(stream).ok()?;
    Some(answer.split_once("\r\n\r\n")?.1.to_owned())
}

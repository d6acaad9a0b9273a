//! A served page in a thread of the test, and viewers of it.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use desk::line::Endpoint;
use desk::serve::{ServeOptions, Server};
use desk::web::{Page, PageOptions};
use hal_sim::machine::devices::SettingsFlash;
use hal_sim::rig::ControllerMemory;
use hal_sim::rig::run::RunOptions;
use serde_json::{Value, json};
use tripivot::simulated::Simulated;
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket, client};

/// Far longer than anything here takes, on a busy machine too.
pub const PATIENCE: Duration = Duration::from_secs(60);

/// A simulated stage in a thread of the test.
pub struct Stage {
    pub address: SocketAddr,
    pub terminal: Option<std::path::PathBuf>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Stage {
    pub fn start(listen: &str) -> Self {
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

    pub fn page(&self) -> Page {
        page_at(Endpoint::Tcp(self.address.to_string()))
    }

    /// The same over its terminal, which all viewers share.
    pub fn page_on_line(&self) -> Page {
        page_at(Endpoint::Serial {
            device: self.terminal.clone().unwrap(),
            baud: 115_200,
        })
    }
}

pub fn page_at(endpoint: Endpoint) -> Page {
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
pub fn get(page: SocketAddr, path: &str, host: &str) -> String {
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

pub fn token(page: &Page) -> String {
    let answer = get(page.address(), "/token", &page.address().to_string());
    let (_, token) = answer.split_once("\r\n\r\n").unwrap();
    token.to_owned()
}

/// A browser's connection.
pub struct Viewer {
    pub socket: WebSocket<TcpStream>,
    pub token: String,
    pub next: u64,
}

pub fn connect(page: &Page, origin: Option<&str>) -> Result<WebSocket<TcpStream>, u16> {
    connect_to(page, "live", origin)
}

pub fn connect_to(
    page: &Page,
    path: &str,
    origin: Option<&str>,
) -> Result<WebSocket<TcpStream>, u16> {
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
    pub fn new(page: &Page) -> Self {
        let origin = format!("http://{}", page.address());
        Self {
            socket: connect(page, Some(&origin)).unwrap(),
            token: token(page),
            next: 1,
        }
    }

    /// Connected to a controller.
    pub fn ready(page: &Page) -> Self {
        let mut viewer = Self::new(page);
        viewer.wait(|message| message["kind"] == "hello" && message["connected"] == true);
        viewer
    }

    /// The next message that `wanted` knows.
    pub fn wait(&mut self, wanted: impl Fn(&Value) -> bool) -> Value {
        let end = Instant::now() + PATIENCE;
        let mut last = Value::Null;
        while Instant::now() < end {
            if let Message::Text(text) = self.socket.read().unwrap() {
                let message = serde_json::from_str(&text).unwrap();
                if wanted(&message) {
                    return message;
                }
                last = message;
            }
        }
        panic!("waited in vain; the last message: {last}");
    }

    pub fn send(&mut self, text: &str) {
        self.socket.send(Message::text(text)).unwrap();
    }

    /// Asks for a line, and goes on; the request's number.
    pub fn post(&mut self, line: &str) -> u64 {
        let id = self.next;
        self.next += 1;
        self.send(&json!({"id": id, "token": self.token, "line": line}).to_string());
        id
    }

    /// What becomes of a line.
    pub fn ask(&mut self, line: &str) -> Value {
        let id = self.post(line);
        self.wait(|message| message["id"] == id)
    }

    /// The reply to a line that is not refused.
    pub fn reply(&mut self, line: &str) -> Option<String> {
        let answer = self.ask(line);
        assert_eq!(answer["error"], 0, "{line}: {answer}");
        answer["reply"].as_str().map(str::to_owned)
    }

    /// What an axis of a query is.
    pub fn value(&mut self, query: &str) -> f64 {
        let reply = self.reply(query).unwrap();
        reply.split_once('=').unwrap().1.parse().unwrap()
    }

    pub fn until(&mut self, query: &str, expected: f64) {
        let end = Instant::now() + PATIENCE;
        while (self.value(query) - expected).abs() > 1e-3 {
            assert!(Instant::now() < end, "{query} does not become {expected}");
        }
    }
}

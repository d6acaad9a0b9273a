//! A viewer's own connection to the controller: its errors, its command level, its waits and its constant velocities are nobody
//! else's, and end with it.

use std::io;
use std::net::Shutdown;
use std::sync::mpsc::{self, Receiver, SyncSender, TrySendError};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use firmware::gcs::{Action, Request, parse};
use tokio::sync::oneshot;

use super::request::Refusal;
use super::stops::Stops;
use crate::line::{self, Answer, Endpoint, Line, Port};

/// Requests that may wait for the line.
const WAITING: usize = 16;
/// How long a line may take: `WAC` and `DEL` are as long as they say. The viewer's end cuts it short.
const PATIENCE: Duration = Duration::from_secs(86_400);
/// How long a constant velocity of a page lasts without being renewed, ms: a page that is gone does not let a button go.
const JOG_TIME_MS: u32 = 300;

/// For how long constant velocities of a line last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Jogs {
    /// As long as a button is held, and renews them.
    Held,
    /// As long as whoever asks for them says.
    Free,
}

/// A line that waits for its turn.
struct Pending {
    line: String,
    jogs: Jogs,
    /// Stops when it was asked for.
    stops: u64,
    answer: oneshot::Sender<Result<Answer, Refusal>>,
}

/// A viewer's own connection, opened with its first line.
pub(super) struct OwnLine {
    requests: SyncSender<Pending>,
    port: Arc<Mutex<OpenPort>>,
    stops: Stops,
}

/// What there is to be closed.
#[derive(Default)]
struct OpenPort {
    port: Option<Port>,
    is_over: bool,
}

impl OwnLine {
    /// The thread of a connection that is opened when it is needed; `name` is shown to those who ask who commands.
    pub fn start(endpoint: Endpoint, name: String, stops: Stops) -> io::Result<Self> {
        let (requests, incoming) = mpsc::sync_channel(WAITING);
        let port = Arc::<Mutex<OpenPort>>::default();
        let worker = Worker {
            endpoint,
            name,
            port: Arc::clone(&port),
            stops: stops.clone(),
        };
        thread::Builder::new()
            .name("viewer".into())
            .spawn(move || worker.run(&incoming))?;
        Ok(Self {
            requests,
            port,
            stops,
        })
    }

    /// Has a line carried out.
    pub async fn ask(&self, line: String, jogs: Jogs) -> Result<Answer, Refusal> {
        let (answer, answered) = oneshot::channel();
        let pending = Pending {
            line,
            jogs,
            stops: self.stops.count(),
            answer,
        };
        (self.requests.try_send(pending)).map_err(|error| match error {
            TrySendError::Full(_) => Refusal::TooMany,
            TrySendError::Disconnected(_) => Refusal::Offline,
        })?;
        answered.await.unwrap_or(Err(Refusal::Broken))
    }
}

impl OwnLine {
    /// Closes it, whatever is under way.
    pub fn close(&self) {
        let mut open = self.port.lock().unwrap_or_else(PoisonError::into_inner);
        open.is_over = true;
        if let Some(Port::Tcp(stream)) = open.port.take() {
            // It may be gone already.
            let _ = stream.shutdown(Shutdown::Both);
        }
    }
}

/// The thread's side.
struct Worker {
    endpoint: Endpoint,
    name: String,
    port: Arc<Mutex<OpenPort>>,
    stops: Stops,
}

impl Worker {
    /// Until the viewer is gone.
    fn run(self, incoming: &Receiver<Pending>) {
        let mut line = None;
        for Pending {
            line: text,
            jogs,
            stops,
            answer,
        } in incoming
        {
            if self.stops.have_ended(stops, &text) {
                // A viewer that is gone needs no answer. So below.
                let _ = answer.send(Err(Refusal::Stopped));
                continue;
            }
            let result = match &mut line {
                Some(line) => carry_out(line, &text, jogs),
                closed => match self.open() {
                    Ok(opened) => carry_out(closed.insert(opened), &text, jogs),
                    Err(_) => Err(Refusal::Offline),
                },
            };
            if result.is_err() {
                line = None;
            }
            let _ = answer.send(result);
        }
    }

    fn open(&self) -> io::Result<Line> {
        let mut line = Line::open(&self.endpoint, line::PATIENCE)?;
        {
            let mut open = self.port.lock().unwrap_or_else(PoisonError::into_inner);
            if open.is_over {
                return Err(io::ErrorKind::NotConnected.into());
            }
            open.port = Some(line.bypass()?);
        }
        // A controller that does not know it says so, and does without.
        line.ask(&format!("OWN 0 {}", self.name))?;
        line.set_patience(PATIENCE);
        Ok(line)
    }
}

fn carry_out(line: &mut Line, text: &str, jogs: Jogs) -> Result<Answer, Refusal> {
    let mut ask = |text: &str| line.ask(text).map_err(|_| Refusal::Broken);
    if let Some(limit) = jogs.limit(text) {
        ask(&limit)?;
    }
    ask(text)
}

impl Jogs {
    /// What goes before a line that lasts as long as a button is held: who looks to its renewal may forget it with a restart
    /// (`RBT`, a reset), so it is said each time. A controller that does not know it says so, and does without.
    pub(super) fn limit(self, line: &str) -> Option<String> {
        let is_held = self == Self::Held
            && match parse(line.as_bytes()) {
                Ok(Request::Act(Action::Jog(_))) => true,
                Ok(Request::Act(Action::Recover(on))) => on != 0.0,
                // What a variable stands for is not known here.
                _ => line.contains('$'),
            };
        is_held.then(|| format!("JTM {JOG_TIME_MS}"))
    }
}

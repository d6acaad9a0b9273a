//! The thread that owns the line to the controller: the status for all viewers, and in between the requests of those that share
//! the line.

use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};
use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, SyncSender, TrySendError};
use std::sync::{Arc, Mutex, OnceLock, PoisonError, Weak};
use std::thread;
use std::time::{Duration, Instant};

use serde::Serialize;
use tokio::sync::{broadcast, oneshot, watch};
use tokio::time::timeout;

use super::arbiter::{Arbiter, Verdict, ViewerNumber, page_name};
use super::own_line::{Jogs, OwnLine};
use super::password::random_text;
use super::request::Refusal;
use super::stops::Stops;
use super::watch::{FAST, SLOW_EVERY, slow};
use crate::line::{Answer, Endpoint, Line, PATIENCE, Port};

/// Between two status messages: a screen's refresh.
const PERIOD: Duration = Duration::from_micros(16_667);
/// Between two looks for viewers while there are none. The controller is not asked anything then: a page that nobody looks at
/// must not be the host that a heartbeat (`HBT`) waits for.
const IDLE_PERIOD: Duration = Duration::from_millis(100);
/// Between two attempts to reach the controller.
const RETRY: Duration = Duration::from_millis(500);
/// Longest time for which the controller may be silent in the middle of an answer: it is twice as long each time that it was
/// too short, so that one that is slow is found.
const LONGEST_PATIENCE: Duration = Duration::from_secs(80);
/// Requests that may wait for the line.
const WAITING: usize = 64;
/// Status messages that a viewer may be behind before it loses some.
const BACKLOG: usize = 128;
/// `#24`.
const STOP: u8 = 24;
/// How long a viewer may be busy with a line of its own when it is asked whether it owns the stage.
const OWNER_PATIENCE: Duration = Duration::from_millis(500);
/// Bytes of randomness in the key of a way.
const KEY_BYTES: usize = 8;

/// What viewers hold of the bridge.
#[derive(Clone)]
pub(super) struct Bridge {
    requests: SyncSender<Pending>,
    status: broadcast::Sender<Arc<str>>,
    hello: watch::Receiver<Arc<str>>,
    bypass: Arc<Mutex<Option<Port>>>,
    endpoint: Endpoint,
    viewers: Arc<AtomicU64>,
    /// Viewers' ways by their keys.
    ways: Arc<Mutex<HashMap<String, Weak<Way>>>>,
    takes_several: Arc<AtomicBool>,
    no_controller: Arc<OnceLock<String>>,
    stops: Stops,
}

/// How a viewer's lines get to the controller: over a connection of its own where the other end takes several, and else over the
/// line that all share.
pub(super) struct Way {
    bridge: Bridge,
    viewer: ViewerNumber,
    /// What its viewer alone is told, to be known by elsewhere.
    key: String,
    /// Opened with its first line; a serial line has none.
    own: Option<OwnLine>,
}

/// What waits for the line.
enum Pending {
    /// A line of a viewer, for its turn.
    Line {
        viewer: ViewerNumber,
        line: String,
        jogs: Jogs,
        /// Stops when it was asked for.
        stops: u64,
        answer: oneshot::Sender<Result<Answer, Refusal>>,
    },
    /// A viewer is gone.
    Gone(ViewerNumber),
}

/// Who is at the other end of the line, if anybody.
#[derive(Serialize)]
#[serde(tag = "kind", rename = "hello")]
struct Hello<'a> {
    connected: bool,
    /// Where the controller is, or should be.
    place: String,
    identity: &'a str,
    /// What `HLP?` answers.
    help: &'a str,
    /// Why there is no connection.
    reason: String,
}

/// Answers to the questions that are asked over and over.
#[derive(Serialize)]
#[serde(tag = "kind", rename = "status")]
struct Status<'a> {
    replies: BTreeMap<&'a str, String>,
}

impl Bridge {
    /// Starts the thread; it ends when the last of its handles is gone.
    pub fn start(endpoint: Endpoint) -> io::Result<Self> {
        let (requests, incoming) = mpsc::sync_channel(WAITING);
        let (status, _) = broadcast::channel(BACKLOG);
        let (hello_sender, hello) = watch::channel(Arc::from(""));
        let bypass = Arc::default();
        let takes_several = Arc::<AtomicBool>::default();
        let no_controller = Arc::<OnceLock<String>>::default();
        let stops = Stops::default();
        let worker = Worker {
            endpoint: endpoint.clone(),
            incoming,
            status: status.clone(),
            hello: hello_sender,
            bypass: Arc::clone(&bypass),
            arbiter: RefCell::default(),
            takes_several: Arc::clone(&takes_several),
            no_controller: Arc::clone(&no_controller),
            stops: stops.clone(),
        };
        worker.say_offline("not connected yet".to_owned());
        thread::Builder::new()
            .name("page".into())
            .spawn(move || worker.run())?;
        Ok(Self {
            requests,
            status,
            hello,
            bypass,
            endpoint,
            viewers: Arc::default(),
            ways: Arc::default(),
            takes_several,
            no_controller,
            stops,
        })
    }

    /// Why what is at the other end cannot be a controller, once that is known. One that was there before may come back.
    pub fn no_controller(&self) -> Arc<OnceLock<String>> {
        Arc::clone(&self.no_controller)
    }

    /// Where the controller is, or should be.
    pub fn place(&self) -> String {
        self.endpoint.to_string()
    }

    /// The status messages from now on.
    pub fn status(&self) -> broadcast::Receiver<Arc<str>> {
        self.status.subscribe()
    }

    /// Who is at the other end.
    pub fn hello(&self) -> watch::Receiver<Arc<str>> {
        self.hello.clone()
    }

    /// The way of one more viewer, or of what runs here.
    pub fn way(&self) -> io::Result<HeldWay> {
        let viewer = self.viewers.fetch_add(1, Ordering::Relaxed) + 1;
        let own = (self.endpoint.is_tcp())
            .then(|| OwnLine::start(self.endpoint.clone(), page_name(viewer), self.stops.clone()))
            .transpose()?;
        let key = random_text(KEY_BYTES)?;
        let way = Arc::new(Way {
            bridge: self.clone(),
            viewer,
            key: key.clone(),
            own,
        });
        let mut ways = self.ways.lock().unwrap_or_else(PoisonError::into_inner);
        ways.retain(|_, way| way.strong_count() > 0);
        ways.insert(key, Arc::downgrade(&way));
        Ok(HeldWay(way))
    }

    /// The way with this key, while its viewer is there.
    fn way_of(&self, key: &str) -> Weak<Way> {
        let ways = self.ways.lock().unwrap_or_else(PoisonError::into_inner);
        ways.get(key).cloned().unwrap_or_default()
    }

    /// The way with this key if its viewer owns the stage.
    pub async fn owners_way(&self, key: &str) -> Option<Arc<Way>> {
        let way = self.way_of(key).upgrade()?;
        let owns = timeout(OWNER_PATIENCE, way.owns()).await.unwrap_or(false);
        owns.then_some(way)
    }

    async fn ask(&self, viewer: ViewerNumber, line: String, jogs: Jogs) -> Result<Answer, Refusal> {
        let (answer, answered) = oneshot::channel();
        let pending = Pending::Line {
            viewer,
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

    /// Stops the stage, ahead of everything: has been sent when this returns, and nothing goes out after it that was asked for
    /// before.
    pub fn stop(&self) -> Result<Answer, Refusal> {
        let mut bypass = self.bypass.lock().unwrap_or_else(PoisonError::into_inner);
        self.stops.note();
        let port = bypass.as_mut().ok_or(Refusal::Offline)?;
        port.write_all(&[STOP]).map_err(|_| Refusal::Broken)?;
        Ok(Answer {
            reply: None,
            error: 0,
        })
    }
}

impl Way {
    /// Whether other viewers use it too.
    pub fn is_shared(&self) -> bool {
        self.own_line().is_none()
    }

    /// What others are told who commands.
    pub fn name(&self) -> String {
        page_name(self.viewer)
    }

    /// What its viewer is known by elsewhere.
    pub fn key(&self) -> &str {
        &self.key
    }

    /// Whether it owns the stage.
    pub async fn owns(&self) -> bool {
        let told = self.ask("OWN?".to_owned()).await;
        told.is_ok_and(|answer| {
            let reply = answer.reply.unwrap_or_default();
            reply.lines().any(|line| line.trim() == "MINE=1")
        })
    }

    /// Has a line carried out in its turn.
    pub async fn ask(&self, line: String) -> Result<Answer, Refusal> {
        self.ask_so(line, Jogs::Held).await
    }

    /// The same, with constant velocities that last so.
    pub async fn ask_so(&self, line: String, jogs: Jogs) -> Result<Answer, Refusal> {
        match self.own_line() {
            Some(own) => own.ask(line, jogs).await,
            None => self.bridge.ask(self.viewer, line, jogs).await,
        }
    }

    fn own_line(&self) -> Option<&OwnLine> {
        let takes_several = self.bridge.takes_several.load(Ordering::Relaxed);
        self.own.as_ref().filter(|_| takes_several)
    }
}

/// A viewer's way, which ends with it, whatever is under way there.
pub(super) struct HeldWay(pub Arc<Way>);

impl Drop for HeldWay {
    fn drop(&mut self) {
        let Way {
            bridge,
            viewer,
            own,
            ..
        } = &*self.0;
        if let Some(own) = own {
            own.close();
        }
        // With no room for that, or nobody there, its ownership ends with the line.
        let _ = bridge.requests.try_send(Pending::Gone(*viewer));
    }
}

/// The thread's side.
struct Worker {
    endpoint: Endpoint,
    incoming: Receiver<Pending>,
    status: broadcast::Sender<Arc<str>>,
    hello: watch::Sender<Arc<str>>,
    bypass: Arc<Mutex<Option<Port>>>,
    arbiter: RefCell<Arbiter>,
    takes_several: Arc<AtomicBool>,
    no_controller: Arc<OnceLock<String>>,
    stops: Stops,
}

/// All viewers and the server are gone.
struct Done;

impl Worker {
    fn run(self) {
        let mut was_there = false;
        let mut patience = PATIENCE;
        loop {
            let reason = match self.serve(&mut was_there, patience) {
                Ok(Done) => return,
                Err(error) => error,
            };
            patience = if reason.kind() == io::ErrorKind::TimedOut {
                LONGEST_PATIENCE.min(patience * 2)
            } else {
                PATIENCE
            };
            if reason.kind() == io::ErrorKind::InvalidData && !was_there {
                // Said once is enough.
                let _ = self.no_controller.set(reason.to_string());
            }
            self.set_bypass(None);
            self.say_offline(reason.to_string());
            if self.refuse_for(RETRY).is_err() {
                return;
            }
        }
    }

    /// Serves as long as the line holds.
    fn serve(&self, was_there: &mut bool, patience: Duration) -> io::Result<Done> {
        let mut line = Line::open(&self.endpoint, patience)?;
        *was_there = true;
        self.set_bypass(Some(line.bypass()?));
        let takes_several = self.endpoint.is_tcp() && Line::has_another(&self.endpoint);
        self.takes_several.store(takes_several, Ordering::Relaxed);
        let help = line.ask_known(&["HLP?"])?.remove(0);
        self.say(&Hello {
            connected: true,
            place: self.endpoint.to_string(),
            identity: line.identity(),
            help: &help,
            reason: String::new(),
        });
        self.arbiter.borrow_mut().forget();
        let all = [FAST, &slow(&help)].concat();
        let mut next = Instant::now();
        for number in 0_u32.. {
            loop {
                let left = next.saturating_duration_since(Instant::now());
                match self.incoming.recv_timeout(left) {
                    Ok(pending) => self.take(&mut line, pending)?,
                    Err(RecvTimeoutError::Timeout) => break,
                    Err(RecvTimeoutError::Disconnected) => return Ok(Done),
                }
                if Instant::now() >= next {
                    break;
                }
            }
            let looked_at = self.status.receiver_count() > 0;
            if looked_at && number % SLOW_EVERY == 0 {
                self.poll(&mut line, &all)?;
            } else if looked_at {
                self.poll(&mut line, FAST)?;
            }
            let period = if looked_at { PERIOD } else { IDLE_PERIOD };
            // A line that is slower than a screen is asked as fast as it goes, and what was missed is not made up for.
            next = (next + period).max(Instant::now());
        }
        Ok(Done)
    }

    fn take(&self, line: &mut Line, pending: Pending) -> io::Result<()> {
        match pending {
            Pending::Line {
                viewer,
                line: text,
                jogs,
                stops,
                answer,
            } => {
                let result = self.carry_out(line, (viewer, jogs), &text, stops);
                let told = result.as_ref().map_or(Err(Refusal::Broken), Clone::clone);
                // A viewer that is gone needs no answer.
                let _ = answer.send(told);
                result.map(drop)
            }
            Pending::Gone(viewer) if self.arbiter.borrow_mut().leave(viewer) => {
                line.ask("OWN 0").map(drop)
            }
            Pending::Gone(_) => Ok(()),
        }
    }

    fn carry_out(
        &self,
        line: &mut Line,
        (viewer, jogs): (ViewerNumber, Jogs),
        text: &str,
        asked_after: u64,
    ) -> io::Result<Result<Answer, Refusal>> {
        let mut arbiter = self.arbiter.borrow_mut();
        let mut lines = match arbiter.judge(viewer, text) {
            Verdict::Refuse(code) => {
                return Ok(Ok(Answer {
                    reply: None,
                    error: code.number(),
                }));
            }
            Verdict::Send(lines) => lines,
        };
        if let Some(limit) = jogs.limit(text) {
            lines.insert(0, limit);
        }
        let mut answer = Answer {
            reply: None,
            error: 0,
        };
        for line_out in &lines {
            {
                // As long as this is held no stop goes out.
                let _held = self.bypass.lock().unwrap_or_else(PoisonError::into_inner);
                if self.stops.have_ended(asked_after, text) {
                    arbiter.interrupt();
                    return Ok(Err(Refusal::Stopped));
                }
                line.send(line_out)?;
            }
            answer = line.take_answer()?;
        }
        arbiter.note(viewer, text, &mut answer);
        Ok(Ok(answer))
    }

    fn poll(&self, line: &mut Line, questions: &[&'static str]) -> io::Result<()> {
        let answers = line.ask_known(questions)?;
        let replies = questions.iter().copied().zip(answers).collect();
        // Nobody needs to look.
        let _ = self.status.send(json(&Status { replies }));
        Ok(())
    }

    /// Refuses what comes in meanwhile.
    fn refuse_for(&self, time: Duration) -> Result<(), Done> {
        let end = Instant::now() + time;
        loop {
            let left = end.saturating_duration_since(Instant::now());
            match self.incoming.recv_timeout(left) {
                Ok(Pending::Line { answer, .. }) => drop(answer.send(Err(Refusal::Offline))),
                Ok(Pending::Gone(viewer)) => drop(self.arbiter.borrow_mut().leave(viewer)),
                Err(RecvTimeoutError::Timeout) => return Ok(()),
                Err(RecvTimeoutError::Disconnected) => return Err(Done),
            }
        }
    }

    fn set_bypass(&self, port: Option<Port>) {
        *self.bypass.lock().unwrap_or_else(PoisonError::into_inner) = port;
    }

    fn say_offline(&self, reason: String) {
        self.say(&Hello {
            connected: false,
            place: self.endpoint.to_string(),
            identity: "",
            help: "",
            reason,
        });
    }

    fn say(&self, hello: &Hello<'_>) {
        let text = json(hello);
        self.hello.send_if_modified(|current| {
            let new = *current != text;
            *current = text;
            new
        });
    }
}

/// As a message; none of ours fails to be one.
pub(super) fn json(message: &impl Serialize) -> Arc<str> {
    serde_json::to_string(message).unwrap_or_default().into()
}

//! A client: its session, the bytes that come in and the replies that go out. Nothing here blocks.

use std::io::{self, Read, Write};
use std::time::{Duration, Instant};

use firmware::gcs::Session;
use rustix::event::PollFlags;
use rustix::fd::{AsFd, BorrowedFd};

use super::output::{Output, Overflow};
use super::{Controller, Notice, ProtocolCheck};

/// Bytes read at a time.
const READ_BYTES: usize = 4096;
/// With more lines than this waiting to be carried out, or replies to be read, nothing more is read from the client.
const WAITING_BYTES: usize = 64 << 10;
/// How long replies may wait with none of them read.
const PATIENCE: Duration = Duration::from_secs(5);
/// How much of a line is kept for notices.
const LINE_BYTES: usize = 80;
/// Lines of a client that are carried out in a turn: more would take the time of the others.
const LINES_PER_TURN: usize = 16;
/// A stop among so many bytes that wait is carried out whatever time others have taken.
const STOP_BYTES: usize = 256;
/// Time for the lines of all clients in a turn: more would take the stage's. The line that is under way then is finished.
const TIME_PER_TURN: Duration = Duration::from_micros(500);
/// `#24`
const STOP: u8 = 24;
/// How long a connection that may only stop the stage has for saying so.
const STOP_PATIENCE: Duration = Duration::from_millis(500);

/// What a client is at: a socket, or the pseudo-terminal.
pub(super) trait Port: Read + Write + AsFd {}

impl<P: Read + Write + AsFd> Port for P {}

/// A client.
pub(super) struct Connection {
    name: String,
    port: Box<dyn Port>,
    kind: ConnectionKind,
    opened: Instant,
    check: ProtocolCheck,
    /// Lines that may still be carried out in this turn.
    lines_left: usize,
    session: Session,
    /// Read, and not taken by the session yet.
    input: Vec<u8>,
    output: Output,
    /// When the client last read, or had nothing to read.
    last_read: Instant,
    /// Its end was seen at this time.
    ended: Option<Instant>,
    /// The last line it sent, as far as it has come.
    line: Vec<u8>,
    /// The last error that was told.
    error: u16,
    state: ClientState,
}

/// What a connection is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ConnectionKind {
    /// A client over TCP.
    Client,
    /// The pseudo-terminal, which stays when its client is gone.
    Terminal,
    /// There is no place left for a client; a stop is taken all the same.
    StopOnly,
}

/// What a turn has left for the lines of clients.
#[derive(Debug, Default)]
pub(super) struct Budget {
    spent: Duration,
}

impl Budget {
    /// Whether no further line is carried out in this turn.
    pub fn is_spent(&self) -> bool {
        self.spent >= TIME_PER_TURN
    }
}

/// What has become of a client.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ClientState {
    Here,
    Gone,
    /// It does not read.
    Unread,
    /// It speaks another protocol.
    NoClient,
}

impl Connection {
    /// A client at a port that does not block.
    pub fn new(name: String, port: Box<dyn Port>, kind: ConnectionKind, now: Instant) -> Self {
        let mut session = Session::new();
        session.set_name(&name);
        Self {
            name,
            port,
            kind,
            opened: now,
            check: ProtocolCheck::default(),
            lines_left: LINES_PER_TURN,
            session,
            input: Vec::new(),
            output: Output::default(),
            last_read: now,
            ended: None,
            line: Vec::new(),
            error: 0,
            state: ClientState::Here,
        }
    }

    /// The controller starts again, the connection stays.
    pub fn controller_restarts(&mut self) {
        self.session.start_again();
        self.error = 0;
    }

    /// What to wait at.
    pub fn port(&self) -> BorrowedFd<'_> {
        self.port.as_fd()
    }

    /// What to wait for there.
    pub fn interest(&self) -> PollFlags {
        let mut flags = PollFlags::empty();
        let room = self.input.len().max(self.output.len()) < WAITING_BYTES;
        if self.ended.is_none() && room {
            flags |= PollFlags::IN;
        }
        if self.output.len() > 0 {
            flags |= PollFlags::OUT;
        }
        flags
    }

    /// Whether nothing but a stop is taken from it.
    pub fn is_stop_only(&self) -> bool {
        self.kind == ConnectionKind::StopOnly
    }

    /// When it was.
    pub const fn opened(&self) -> Instant {
        self.opened
    }

    /// Whether its end has been seen.
    pub const fn has_ended(&self) -> bool {
        self.ended.is_some()
    }

    /// Its client has sent all that it will; what came before is still carried out, as far as it takes no longer than
    /// [`PATIENCE`].
    pub const fn end(&mut self, now: Instant) {
        self.ended = Some(now);
    }

    /// Its client is gone and reads nothing any more.
    pub const fn break_off(&mut self) {
        self.state = ClientState::Gone;
    }

    /// Reads what has come; to be called when [`interest`](Self::interest) has been met.
    pub fn read(&mut self, now: Instant) {
        let mut bytes = [0; READ_BYTES];
        match self.port.read(&mut bytes) {
            Ok(0) => self.end(now),
            Ok(count) => self.take(&bytes[..count]),
            Err(error) if is_passing(&error) => {}
            Err(_) => self.break_off(),
        }
    }

    fn take(&mut self, bytes: &[u8]) {
        if self.kind != ConnectionKind::Terminal && !self.check.accepts(bytes) {
            self.state = ClientState::NoClient;
            self.input.clear();
            return;
        }
        self.input.extend_from_slice(bytes);
    }

    /// A turn begins.
    pub const fn begin_turn(&mut self) {
        self.lines_left = LINES_PER_TURN;
    }

    /// Whether lines of it wait for the next turn.
    pub fn has_lines_left(&self, budget: &Budget) -> bool {
        (self.lines_left == 0 || budget.is_spent()) && !self.input.is_empty()
    }

    /// Has the controller carry out what has come, line by line, so that a refusal can be told with its line.
    pub fn service(
        &mut self,
        controller: &mut impl Controller,
        budget: &mut Budget,
        say: &mut dyn FnMut(Notice),
    ) {
        if self.state != ClientState::Here {
            return;
        }
        if self.kind == ConnectionKind::StopOnly {
            self.take_stop();
        }
        loop {
            let may = self.kind != ConnectionKind::StopOnly
                && self.lines_left > 0
                && (!budget.is_spent() || self.asks_for_a_stop());
            let begun = (may && !self.input.is_empty()).then(Instant::now);
            let taken = begun.is_some() && self.feed();
            self.lines_left -= usize::from(taken);
            let waiting = self.output.len();
            (self.session).set_room(WAITING_BYTES.saturating_sub(waiting));
            if let Err(Overflow) = controller.service(&mut self.session, &mut self.output) {
                self.state = ClientState::Unread;
                return;
            }
            self.tell_error(say);
            budget.spent += begun.map_or(Duration::ZERO, |begun| begun.elapsed());
            if !taken {
                return;
            }
        }
    }

    /// Whether a stop waits, with so little before it that it waits for nobody's time.
    fn asks_for_a_stop(&self) -> bool {
        self.input.len() <= STOP_BYTES && stop_in(&self.input).is_some()
    }

    /// Gives the session a stop, if one has come, and nothing else.
    fn take_stop(&mut self) {
        if let Some(stop) = stop_in(&self.input) {
            self.session.receive(stop);
            self.input.clear();
            self.ended = Some(self.opened);
        }
    }

    /// Gives the session the rest of a line; whether it has taken any of it.
    fn feed(&mut self) -> bool {
        let end = (self.input.iter())
            .position(|&byte| byte == b'\n')
            .map_or(self.input.len(), |at| at + 1);
        let taken = self.session.receive(&self.input[..end]);
        for byte in self.input.drain(..taken) {
            if self.line.last() == Some(&b'\n') {
                self.line.clear();
            }
            if self.line.len() < LINE_BYTES || byte == b'\n' {
                self.line.push(byte);
            }
        }
        taken > 0
    }

    fn tell_error(&mut self, say: &mut dyn FnMut(Notice)) {
        let error = self.session.error().number();
        if error != self.error && error != 0 {
            say(Notice::Refused {
                name: self.name.clone(),
                error,
                line: self.line.trim_ascii().escape_ascii().to_string(),
            });
        }
        self.error = error;
    }

    /// Writes as many replies as the client takes.
    pub fn write(&mut self, now: Instant) {
        if self.output.len() == 0 {
            self.last_read = now;
            return;
        }
        match self.output.write_to(&mut self.port) {
            Ok(true) => self.last_read = now,
            Ok(false) if now.duration_since(self.last_read) > PATIENCE => {
                self.state = ClientState::Unread;
            }
            Ok(false) => {}
            Err(_) => self.state = ClientState::Gone,
        }
    }

    /// Whether it is still there; tells when not.
    pub fn stays(
        &mut self,
        now: Instant,
        controller: &mut impl Controller,
        say: &mut dyn FnMut(Notice),
    ) -> bool {
        let finished = self.ended.is_some_and(|ended| {
            let done = self.input.is_empty() && self.session.is_idle() && self.output.len() == 0;
            done || now.duration_since(ended) > PATIENCE
        });
        let has_no_place = self.kind == ConnectionKind::StopOnly
            && now.duration_since(self.opened) > STOP_PATIENCE;
        if (finished || has_no_place) && self.state == ClientState::Here {
            self.state = ClientState::Gone;
        }
        match self.state {
            ClientState::Here => return true,
            // It has been told that it was turned away.
            ClientState::Gone if self.kind == ConnectionKind::StopOnly => {}
            ClientState::Gone => say(Notice::Left(self.name.clone())),
            ClientState::Unread => say(Notice::Unread(self.name.clone())),
            ClientState::NoClient => say(Notice::NoClient(self.name.clone())),
        }
        controller.disconnect(&mut self.session);
        let stays = self.kind == ConnectionKind::Terminal;
        if stays {
            self.start_again(now);
        }
        stays
    }

    /// Nobody is known to be there: as after a restart of the line.
    fn start_again(&mut self, now: Instant) {
        self.session = Session::new();
        self.session.set_name(&self.name);
        self.input.clear();
        self.output = Output::default();
        self.ended = None;
        self.last_read = now;
        self.state = ClientState::Here;
    }
}

/// The first stop in what has come, as a byte or a line.
fn stop_in(input: &[u8]) -> Option<&[u8]> {
    let is_stop = |line: &&[u8]| {
        let word = line.trim_ascii().get(..3).unwrap_or_default();
        line.ends_with(b"\n")
            && [b"STP", b"HLT"]
                .iter()
                .any(|stop| word.eq_ignore_ascii_case(*stop))
    };
    if input.contains(&STOP) {
        return Some(&[STOP]);
    }
    input.split_inclusive(|&byte| byte == b'\n').find(is_stop)
}

fn is_passing(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted
    )
}

//! The emulated chip's serial line over TCP: what any client of the real board's line can do, it can do here.
//!
//! The line is one, so there is one client at a time; the next one waits until it is gone. The emulator runs as fast as it
//! can, a few times slower than the real chip; replies are that much slower.

use std::fmt;
use std::io::{self, ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::ops::ControlFlow::{self, Break, Continue};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Receiver;

use super::run::machine_settings;
use super::{Bench, ChipError, Period, elf_file};
use desk::commission::Task;
use desk::serve::{ProtocolCheck, keep_alive};
use hal_sim::machine::devices::{SettingsFlash, Stage};
use hal_sim::rig::run::{RunOptions, stage_parameters};
use tripivot::person::Person;

/// Control periods between two looks at the client: half a millisecond of the chip's time.
const LOOK_EVERY: u64 = 10;
/// What the chip, which does not see its client go, is sent then: the rest of a line that it has begun is nobody's, and its
/// constant velocity ends with it.
const LEFT: &[u8] = b"\nJTM 10\nDEL 20\nJTM 0\n";
/// Bytes read at a time: what the line passes between two looks, and not more than the image's buffer holds.
const READ_BYTES: usize = 512;

/// An address that is listened at, and a bench that does not run yet.
pub struct LineServer {
    listener: TcpListener,
    /// What the person beside the machine is asked for.
    tasks: Option<Receiver<Task>>,
    /// What its flash holds at the start, in place of what the machine's own would.
    settings: Option<SettingsFlash>,
}

/// Something that happened at the line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LineNotice {
    /// A client has the line.
    Connected(SocketAddr),
    /// It is gone.
    Left(SocketAddr),
    /// It is no client but a browser, or speaks another protocol: the chip has got nothing of that.
    NoClient(SocketAddr),
}

impl fmt::Display for LineNotice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Connected(address) => write!(f, "{address}: connected"),
            Self::Left(address) => write!(f, "{address}: left"),
            Self::NoClient(address) => {
                write!(f, "{address}: sent HTTP or another protocol, cut off")
            }
        }
    }
}

impl LineServer {
    /// Listens; clients are answered once it [`run`](Self::run)s.
    ///
    /// # Errors
    /// Those of the system.
    pub fn bind(address: &str) -> io::Result<Self> {
        let listener = TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        Ok(Self {
            listener,
            tasks: None,
            settings: None,
        })
    }

    /// The same with a simulated person beside the machine, who does what is asked for.
    #[must_use]
    pub fn with_person(self, tasks: Receiver<Task>) -> Self {
        Self {
            tasks: Some(tasks),
            ..self
        }
    }

    /// The same on a board whose flash keeps these settings.
    #[must_use]
    pub fn with_settings(self, settings: SettingsFlash) -> Self {
        Self {
            settings: Some(settings),
            ..self
        }
    }

    /// Where it listens.
    ///
    /// # Errors
    /// Those of the system.
    pub fn address(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }

    /// Boots the image that lies in the target folder and passes bytes until `stop` is set.
    ///
    /// # Errors
    /// [`ChipError`].
    pub fn run(
        self,
        options: &RunOptions,
        stop: Arc<AtomicBool>,
        say: impl Fn(&LineNotice) + Send + 'static,
    ) -> Result<(), ChipError> {
        let path = elf_file::find().ok_or(ChipError::NoImage)?;
        let bench = |error| ChipError::Bench(path.clone(), error);
        let stage = Stage::new(&stage_parameters(options));
        let mut line = Line {
            listener: self.listener,
            client: None,
            check: ProtocolCheck::default(),
            replies: Vec::new(),
            person: Person::default(),
            tasks: self.tasks,
        };
        let settings = (self.settings).unwrap_or_else(|| machine_settings(options));
        let outcome = Bench::load(&path, stage)
            .map_err(bench)?
            .with_settings(settings)
            .run(move |period| line.period(period, &stop, &say))
            .map_err(bench)?;
        if outcome.gaps.is_empty() {
            Ok(())
        } else {
            Err(ChipError::Gaps(outcome.gaps))
        }
    }
}

/// The line and who has it.
struct Line {
    listener: TcpListener,
    client: Option<(TcpStream, SocketAddr)>,
    check: ProtocolCheck,
    /// Received from the chip, not written to the client yet.
    replies: Vec<u8>,
    person: Person,
    tasks: Option<Receiver<Task>>,
}

impl Line {
    fn period(
        &mut self,
        period: &mut Period<'_>,
        stop: &AtomicBool,
        say: &impl Fn(&LineNotice),
    ) -> ControlFlow<()> {
        if let Some(task) = self.tasks.as_ref().and_then(|tasks| tasks.try_recv().ok()) {
            self.person.begin(task, period.stage);
        }
        self.person.tick(period.stage);
        if !period.tick.is_multiple_of(LOOK_EVERY) {
            return Continue(());
        }
        if stop.load(Ordering::Relaxed) {
            return Break(());
        }
        self.replies.append(&mut period.received());
        self.accept(say);
        let Some((client, address)) = &mut self.client else {
            // Nobody is there to read them.
            self.replies.clear();
            return Continue(());
        };
        let mut bytes = [0; READ_BYTES];
        let gone = match pass(client, &mut self.replies, &mut bytes) {
            Ok(count) if self.check.accepts(&bytes[..count]) => {
                period.send(&bytes[..count]);
                None
            }
            Ok(_) => Some(LineNotice::NoClient(*address)),
            Err(_) => Some(LineNotice::Left(*address)),
        };
        if let Some(notice) = gone {
            period.send(LEFT);
            say(&notice);
            self.client = None;
        }
        Continue(())
    }

    fn accept(&mut self, say: &impl Fn(&LineNotice)) {
        if self.client.is_some() {
            return;
        }
        // Nobody there, or gone again before being accepted: the next look will tell.
        let Ok((stream, address)) = self.listener.accept() else {
            return;
        };
        let is_ready = (stream.set_nonblocking(true))
            .and_then(|()| stream.set_nodelay(true))
            .and_then(|()| keep_alive(&stream));
        if is_ready.is_ok() {
            say(&LineNotice::Connected(address));
            self.client = Some((stream, address));
            self.check = ProtocolCheck::default();
        }
    }
}

/// Writes as many replies as the client takes and reads what it has sent; an error when it is gone.
fn pass(client: &mut TcpStream, replies: &mut Vec<u8>, bytes: &mut [u8]) -> io::Result<usize> {
    while !replies.is_empty() {
        match client.write(replies) {
            Ok(count) => drop(replies.drain(..count)),
            Err(error) if is_passing(&error) => break,
            Err(error) => return Err(error),
        }
    }
    match client.read(bytes) {
        Ok(0) => Err(ErrorKind::UnexpectedEof.into()),
        Ok(count) => Ok(count),
        Err(error) if is_passing(&error) => Ok(0),
        Err(error) => Err(error),
    }
}

fn is_passing(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted)
}

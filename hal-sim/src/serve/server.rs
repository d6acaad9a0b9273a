//! The turns: ticks that are due, then what has come in meanwhile.

use std::fs::File;
use std::io;
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::os::fd::OwnedFd;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use firmware::fault_record::RetainedMemory;
use firmware::gcs::Interpreter;
use firmware::parameters::Parameters;
use firmware::queues::{CommandQueues, Queues, TickQueues};
use firmware::settings_store::SettingsStore;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;

use super::connection::Connection;
use super::pace::{Pace, Pacing};
use super::terminal::Terminal;
use super::{Notice, ServeError, ServeOptions};
use crate::devices::SettingsFlash;
use crate::host::Host;
use crate::run::started;

/// Clients at once.
const CLIENTS: usize = 64;
/// How long no connection is accepted after one could not be.
const ACCEPT_PAUSE: Duration = Duration::from_secs(1);
/// How often being late is told.
const BEHIND_EVERY: Duration = Duration::from_secs(5);
/// How long nothing else may keep it from seeing that it is to stop.
const LOOK_EVERY: Duration = Duration::from_millis(50);

/// A simulated stage that can be reached, and does not run yet.
pub struct Server {
    options: ServeOptions,
    listener: TcpListener,
    terminal: Option<Terminal>,
    flash: SettingsFlash,
}

impl Server {
    /// Listens. Clients can connect from now on, and are answered once it [`run`](Self::run)s.
    ///
    /// # Errors
    /// [`ServeError::Settings`], [`ServeError::Listen`] and [`ServeError::Terminal`].
    pub fn bind(options: ServeOptions) -> Result<Self, ServeError> {
        let flash = match &options.settings {
            Some(path) => SettingsFlash::open(path)?,
            None => SettingsFlash::in_memory(),
        };
        let listener = listen(&options.listen).map_err(|error| ServeError::Listen {
            listen: options.listen.clone(),
            error,
        })?;
        let terminal = (options.terminal)
            .then(Terminal::open)
            .transpose()
            .map_err(ServeError::Terminal)?;
        Ok(Self {
            options,
            listener,
            terminal,
            flash,
        })
    }

    /// Where it listens.
    ///
    /// # Errors
    /// Those of the system.
    pub fn address(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }

    /// The pseudo-terminal, if there is one.
    #[must_use]
    pub fn terminal(&self) -> Option<&Path> {
        self.terminal.as_ref().map(|terminal| &*terminal.path)
    }

    /// Runs the stage and serves it until `stop` is set; looks at that 20 times a second at least. How well it kept to the
    /// clock.
    ///
    /// # Errors
    /// [`ServeError::Wait`].
    pub fn run(self, stop: &AtomicBool, say: &mut dyn FnMut(Notice)) -> Result<Pacing, ServeError> {
        let mut queues = Queues::new();
        let black_box = Box::new(RetainedMemory::new());
        let (tick_queues, command_queues) = queues.split_with_retained(&black_box);
        let now = Instant::now();
        let parameters = &self.options.parameters;
        let rate_hz = parameters.limits.rate_hz * self.options.speed;
        // The client's end has to stay open as long as the controller's.
        let (terminal, _client) = self.terminal.map(|t| (t.controller, t.client)).unzip();
        let connections = terminal.map(|port| Connection::new("terminal".into(), port, true, now));
        let mut keeper = SettingsStore::new(self.flash);
        let (panel, fault) = started(parameters, &mut keeper);
        let mut host = Host::new(&self.options.stage, panel.parameters());
        host.restart(panel.parameters(), fault);
        let mut service = Service {
            parameters: parameters.clone(),
            host,
            panel,
            keeper,
            tick_queues,
            command_queues,
            pace: Pace::new(now, rate_hz),
            listener: self.listener,
            connections: connections.into_iter().collect(),
            accept_from: now,
            fault_tick: None,
            lost_told: None,
            say,
        };
        while !stop.load(Ordering::Relaxed) {
            service.turn().map_err(ServeError::Wait)?;
        }
        Ok(service.pace.pacing())
    }
}

fn listen(address: &str) -> io::Result<TcpListener> {
    let listener = TcpListener::bind(address)?;
    listener.set_nonblocking(true)?;
    Ok(listener)
}

/// A stage that runs and is served.
struct Service<'a> {
    parameters: Parameters,
    host: Host,
    panel: Interpreter,
    keeper: SettingsStore<SettingsFlash>,
    tick_queues: TickQueues<'a>,
    command_queues: CommandQueues<'a>,
    pace: Pace,
    listener: TcpListener,
    connections: Vec<Connection>,
    /// No connection is accepted before.
    accept_from: Instant,
    /// The fault that was told last.
    fault_tick: Option<u64>,
    /// When the time that could not be made up for was told last.
    lost_told: Option<Instant>,
    say: &'a mut dyn FnMut(Notice),
}

impl Service<'_> {
    fn turn(&mut self) -> io::Result<()> {
        for _ in 0..self.pace.take(Instant::now()) {
            self.host.tick(&mut self.tick_queues, &mut ());
            self.service();
            if self.panel.wants_restart() {
                self.restart();
            }
        }
        self.tell_fault();
        self.tell_lost(Instant::now());
        let ready = self.wait(self.pace.wait(Instant::now()).min(LOOK_EVERY))?;
        self.transfer(ready, Instant::now());
        Ok(())
    }

    /// What `RBT` asks for: the controller starts again, its clients stay connected.
    fn restart(&mut self) {
        let (panel, fault) = started(&self.parameters, &mut self.keeper);
        self.panel = panel;
        self.host.restart(self.panel.parameters(), fault);
        self.tick_queues.clear();
        self.command_queues.clear();
        for connection in &mut self.connections {
            connection.controller_restarts();
        }
        (self.say)(Notice::Restarted);
    }

    fn service(&mut self) {
        // Also with nobody there: a macro goes on.
        self.panel.advance(&mut self.command_queues);
        for connection in &mut self.connections {
            connection.service(&mut self.panel, &mut self.command_queues, self.say);
        }
        self.keeper.store_pending(&mut self.panel);
    }

    fn tell_fault(&mut self) {
        let fault = self.host.fault();
        let tick = fault.map(|fault| fault.tick);
        if let Some(fault) = fault
            && tick != self.fault_tick
        {
            (self.say)(Notice::Fault(fault));
        }
        self.fault_tick = tick;
    }

    fn tell_lost(&mut self, now: Instant) {
        if self.pace.give_up(now).is_none() {
            return;
        }
        if (self.lost_told).is_none_or(|told| now.duration_since(told) > BEHIND_EVERY) {
            self.lost_told = Some(now);
            (self.say)(Notice::Behind(self.pace.pacing().lost.as_secs_f64()));
        }
    }

    /// Waits until something has come or the time is over; which connections it has come from.
    fn wait(&self, time: Duration) -> io::Result<Vec<usize>> {
        // A connection with nothing to wait for is left out: its end would be reported over and over.
        let (numbers, mut ports): (Vec<_>, Vec<_>) = (self.connections.iter().enumerate())
            .filter(|(_, connection)| !connection.interest().is_empty())
            .map(|(number, c)| (number, PollFd::from_borrowed_fd(c.port(), c.interest())))
            .unzip();
        if Instant::now() >= self.accept_from {
            ports.push(PollFd::new(&self.listener, PollFlags::IN));
        }
        let time = Timespec {
            tv_sec: time.as_secs().cast_signed(),
            tv_nsec: time.subsec_nanos().into(),
        };
        match poll(&mut ports, Some(&time)) {
            Ok(_) | Err(Errno::INTR) => {}
            Err(error) => return Err(error.into()),
        }
        // An error or the other's end is found by reading.
        let come = PollFlags::IN | PollFlags::HUP | PollFlags::ERR;
        Ok((numbers.into_iter().zip(ports))
            .filter(|(_, port)| port.revents().intersects(come))
            .map(|(number, _)| number)
            .collect())
    }

    /// Reads, carries out and writes what can be.
    fn transfer(&mut self, ready: Vec<usize>, now: Instant) {
        for number in ready {
            self.connections[number].read(now);
        }
        self.service();
        for connection in &mut self.connections {
            connection.write(now);
        }
        let say = &mut *self.say;
        (self.connections).retain_mut(|connection| connection.stays(now, say));
        if now >= self.accept_from {
            self.accept(now);
        }
    }

    fn accept(&mut self, now: Instant) {
        let accepted =
            (self.listener.accept()).and_then(|(stream, from)| Ok((port(stream)?, from)));
        match accepted {
            Ok((_, from)) if self.connections.len() >= CLIENTS => {
                (self.say)(Notice::TurnedAway(from.to_string()));
            }
            Ok((port, from)) => {
                (self.say)(Notice::Connected(from.to_string()));
                (self.connections).push(Connection::new(from.to_string(), port, false, now));
            }
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {}
            Err(error) => {
                self.accept_from = now + ACCEPT_PAUSE;
                (self.say)(Notice::NotAccepted(error.to_string()));
            }
        }
    }
}

/// The stream as a file that does not block and sends short replies at once.
fn port(stream: TcpStream) -> io::Result<File> {
    stream.set_nonblocking(true)?;
    stream.set_nodelay(true)?;
    Ok(OwnedFd::from(stream).into())
}

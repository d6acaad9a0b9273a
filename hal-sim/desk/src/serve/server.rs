//! The turns: ticks that are due, then what has come in meanwhile.

use std::io;
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::Errno;

use super::connection::{Budget, Connection, ConnectionKind, Port};
use super::keepalive::keep_alive;
use super::pace::{Pace, Pacing};
use super::terminal::Terminal;
use super::{Controller, Notice, ServeError, ServeOptions};

/// Clients at once.
const CLIENTS: usize = 64;
/// Connections besides, from which nothing but a stop is taken: the next one takes the place of the oldest.
const STOP_PLACES: usize = 4;
/// How long no connection is accepted after one could not be.
const ACCEPT_PAUSE: Duration = Duration::from_secs(1);
/// How often being late is told.
const BEHIND_EVERY: Duration = Duration::from_secs(5);
/// How long nothing else may keep it from seeing that it is to stop.
const LOOK_EVERY: Duration = Duration::from_millis(50);

/// A client has sent all that it will.
#[cfg(target_os = "linux")]
const ENDED: PollFlags = PollFlags::RDHUP;
/// Other systems tell by reading.
#[cfg(not(target_os = "linux"))]
const ENDED: PollFlags = PollFlags::empty();

/// Where a controller can be reached that does not run yet.
pub struct Server {
    options: ServeOptions,
    listener: TcpListener,
    terminal: Option<Terminal>,
}

impl Server {
    /// Listens. Clients can connect from now on, and are answered once it [`run`](Self::run)s.
    ///
    /// # Errors
    /// [`ServeError::Listen`] and [`ServeError::Terminal`].
    pub fn bind(options: ServeOptions) -> Result<Self, ServeError> {
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
        self.terminal.as_ref().map(Terminal::path)
    }

    /// Runs the controller and serves it until `stop` is set; looks at that 20 times a second at least. How well it kept to the
    /// clock.
    ///
    /// # Errors
    /// [`ServeError::Wait`].
    pub fn run(
        self,
        controller: &mut impl Controller,
        stop: &AtomicBool,
        say: &mut dyn FnMut(Notice),
    ) -> Result<Pacing, ServeError> {
        let now = Instant::now();
        let rate_hz = controller.rate_hz() * self.options.speed;
        let terminal = self.terminal.map(|terminal| {
            let kind = ConnectionKind::Terminal;
            Connection::new("terminal".into(), terminal.into_port(), kind, now)
        });
        let mut service = Service {
            controller,
            pace: Pace::new(now, rate_hz),
            listener: self.listener,
            connections: terminal.into_iter().collect(),
            budget: Budget::default(),
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

/// A controller that runs and is served.
struct Service<'a, C> {
    controller: &'a mut C,
    pace: Pace,
    listener: TcpListener,
    /// The first one has the first turn.
    connections: Vec<Connection>,
    budget: Budget,
    /// No connection is accepted before.
    accept_from: Instant,
    /// The fault that was told last.
    fault_tick: Option<u64>,
    /// When the time that could not be made up for was told last.
    lost_told: Option<Instant>,
    say: &'a mut dyn FnMut(Notice),
}

impl<C: Controller> Service<'_, C> {
    fn turn(&mut self) -> io::Result<()> {
        self.begin_turn();
        for _ in 0..self.pace.take(Instant::now()) {
            self.controller.tick();
            self.service();
            if self.controller.restart_if_wanted() {
                self.tell_restart();
            }
        }
        self.tell_fault();
        self.tell_lost(Instant::now());
        let ready = self.wait(self.idle_time())?;
        self.transfer(ready, Instant::now());
        Ok(())
    }

    fn begin_turn(&mut self) {
        for connection in &mut self.connections {
            connection.begin_turn();
        }
        if self.budget.is_spent() {
            // Who came last in a turn whose time was not enough for all comes earlier in the next one.
            self.connections.rotate_left(1);
        }
        self.budget = Budget::default();
    }

    /// How long nothing is due.
    fn idle_time(&self) -> Duration {
        let has_lines_left = |one: &Connection| one.has_lines_left(&self.budget);
        if self.connections.iter().any(has_lines_left) {
            return Duration::ZERO;
        }
        self.pace.wait(Instant::now()).min(LOOK_EVERY)
    }

    /// The controller has started again; its clients stay connected.
    fn tell_restart(&mut self) {
        for connection in &mut self.connections {
            connection.controller_restarts();
        }
        (self.say)(Notice::Restarted);
    }

    fn service(&mut self) {
        // Also with nobody there: a macro goes on.
        self.controller.advance();
        for connection in &mut self.connections {
            connection.service(self.controller, &mut self.budget, self.say);
        }
        self.controller.keep();
    }

    fn tell_fault(&mut self) {
        let fault = self.controller.fault();
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

    /// Waits until something has come or the time is over; what has come, by the number of the connection.
    fn wait(&self, time: Duration) -> io::Result<Vec<(usize, PollFlags)>> {
        let mut ports: Vec<_> = (self.connections.iter())
            .map(|connection| {
                let mut flags = connection.interest();
                if !connection.has_ended() {
                    flags |= ENDED;
                }
                PollFd::from_borrowed_fd(connection.port(), flags)
            })
            .collect();
        if Instant::now() >= self.accept_from {
            ports.push(PollFd::new(&self.listener, PollFlags::IN));
        }
        if ports.is_empty() {
            // Windows takes waiting for nothing for a mistake.
            thread::sleep(time);
            return Ok(Vec::new());
        }
        // A turn's wait is short: it always fits.
        let time = Timespec::try_from(time).unwrap_or_default();
        match poll(&mut ports, Some(&time)) {
            Ok(_) | Err(Errno::INTR) => {}
            Err(error) => return Err(error.into()),
        }
        Ok((ports.iter().map(PollFd::revents).enumerate())
            .take(self.connections.len())
            .filter(|(_, come)| !come.is_empty())
            .collect())
    }

    /// Reads, carries out and writes what can be.
    fn transfer(&mut self, ready: Vec<(usize, PollFlags)>, now: Instant) {
        for (number, come) in ready {
            let connection = &mut self.connections[number];
            if come.contains(PollFlags::IN) {
                connection.read(now);
            } else if come.intersects(PollFlags::HUP | PollFlags::ERR) {
                // With no room for what it sends, reading would not find this out.
                connection.break_off();
            } else if come.intersects(ENDED) {
                connection.end(now);
            }
        }
        self.service();
        for connection in &mut self.connections {
            connection.write(now);
        }
        let (say, controller) = (&mut *self.say, &mut *self.controller);
        (self.connections).retain_mut(|connection| connection.stays(now, controller, say));
        if now >= self.accept_from {
            self.accept(now);
        }
    }

    fn accept(&mut self, now: Instant) {
        let accepted =
            (self.listener.accept()).and_then(|(stream, from)| Ok((port(stream)?, from)));
        match accepted {
            Ok((port, from)) => {
                let name = from.to_string();
                if self.connections.len() >= CLIENTS + STOP_PLACES {
                    // What it has sent has been carried out.
                    let stop_only = self.connections.iter_mut().filter(|one| one.is_stop_only());
                    let oldest = stop_only.min_by_key(|one| one.opened());
                    oldest.into_iter().for_each(Connection::break_off);
                }
                let kind = if self.connections.len() < CLIENTS {
                    (self.say)(Notice::Connected(name.clone()));
                    ConnectionKind::Client
                } else {
                    (self.say)(Notice::TurnedAway(name.clone()));
                    ConnectionKind::StopOnly
                };
                (self.connections).push(Connection::new(name, port, kind, now));
            }
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {}
            Err(error) => {
                self.accept_from = now + ACCEPT_PAUSE;
                (self.say)(Notice::NotAccepted(error.to_string()));
            }
        }
    }
}

/// The stream, which does not block and sends short replies at once.
fn port(stream: TcpStream) -> io::Result<Box<dyn Port>> {
    stream.set_nonblocking(true)?;
    stream.set_nodelay(true)?;
    keep_alive(&stream)?;
    Ok(Box::new(stream))
}

//! The front panel: the General Command Set interpreter.
//!
//! It runs at low priority, outside the tick, and meets it only through the queues of [`crate::link`]. A [`Panel`] is what all
//! connections share, a [`Session`] is one of them. Bytes go into the session, [`Panel::service`] handles them and writes
//! the replies:
//!
//! ```text
//! bytes -> Session::receive -> line or single byte -> parse -> Request -> Stage -> Command -> tick
//!                                                        \-> reply <- Stage <- Snapshot <----/
//! ```
//!
//! | file | idea |
//! |---|---|
//! | `table` | what commands there are; parsing, `HLP?` and dispatch read it |
//! | `scan`, `parse` | from a line to a [`Request`], or what is wrong with it and where |
//! | `session` | input, line, error and wait of a connection |
//! | `stage` | what is known of the stage, in flight to it, wanted of it |
//! | `answer`, `act` | what a request does |
//! | `parameter` | what parameters there are |
//! | `soft`, `reach` | limits of targets, and how far one can go |
//!
//! Lines are handled in order. While a command is on its way to the tick (one tick) lines that depend on it stay where they
//! are; while `DEL`, `WAC` or `FRF` waits all lines do, and single bytes act ahead of them. A stop (`STP`, `#24`) from any
//! connection ends those waits on all of them, with error 10, and throws away the lines behind them: a script does not go on
//! after a stop.

mod act;
mod answer;
mod axis;
mod course;
mod error;
mod parameter;
mod parse;
mod reach;
mod reply;
mod request;
mod scan;
mod session;
mod soft;
mod stage;
mod table;
mod target;

pub use axis::{Axis, AxisSet, AxisValues};
pub use error::ErrorCode;
pub use parameter::{ADDRESSES, Address, Addresses, Item, Settings};
pub use parse::{ParseError, parse};
pub use request::{Action, Condition, Operator, Property, Quantity, Query, Request};
pub use session::{LINE_BYTES, Session};

use crate::fault::FaultKind;
use crate::link::PanelLink;
use crate::motion::Limits;
use crate::parameters::Parameters;
use answer::tell_reach;
use embedded_io::Write;
use session::{Awaited, Event};
use stage::{Referencing, Stage};
use table::find_byte;

/// Who answers `*IDN?`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Identity {
    /// Serial number.
    pub serial: &'static str,
    /// Version of the firmware.
    pub version: &'static str,
}

/// What all connections share.
pub struct Panel {
    identity: Identity,
    parameters: Parameters,
    /// Limits of motion that the stage was set up for.
    rated: Limits,
    stage: Stage,
    /// Why the controller started, if that is worth telling.
    start: Option<&'static str>,
    /// Times `STP` or `#24` was given.
    stops: u32,
}

impl Panel {
    /// For a stage of these parameters.
    pub fn new(parameters: &Parameters, identity: Identity) -> Self {
        Self {
            identity,
            parameters: parameters.clone(),
            rated: parameters.limits,
            stage: Stage::new(parameters),
            stops: 0,
            start: None,
        }
    }

    /// Notes why the controller started (a watchdog reset, say): `FLT?` tells it while there is no fault.
    pub fn note_start(&mut self, cause: &'static str) {
        self.start = Some(cause);
    }

    /// Takes new snapshots, carries on what is pending, handles what `session` has received and writes the replies to `out`.
    /// To be called for every connection as often as possible: on the host once every tick, on the chip in the idle loop.
    ///
    /// # Errors
    /// Those of `out`. The connection is then to be closed; the panel goes on with the others.
    pub fn service<W: Write>(
        &mut self,
        session: &mut Session,
        link: &mut PanelLink<'_>,
        out: &mut W,
    ) -> Result<(), W::Error> {
        while let Some(snapshot) = link.snapshot() {
            self.stage.take(snapshot);
        }
        self.stage.carry_on(link);
        self.tell_bad_news(session);
        let result = self.handle(session, link, out);
        self.stage.carry_on(link);
        result
    }

    /// A fault sets the error of every connection, once.
    fn tell_bad_news(&self, session: &mut Session) {
        let (count, code) = self.stage.news();
        if session
            .news
            .replace(count)
            .is_some_and(|told| told != count)
        {
            session.error = code;
        }
        let fault = self.stage.snapshot().and_then(|snapshot| snapshot.fault);
        if let Some(fault) = fault
            && session.fault_tick.replace(fault.tick) != Some(fault.tick)
        {
            session.error = match fault.kind {
                FaultKind::FollowingError => ErrorCode::FollowingError,
                _ => ErrorCode::MotionError,
            };
        }
    }

    fn handle<W: Write>(
        &mut self,
        session: &mut Session,
        link: &mut PanelLink<'_>,
        out: &mut W,
    ) -> Result<(), W::Error> {
        loop {
            while self.is_waiting(session, link) {
                let Some(byte) = session.take_single() else {
                    return Ok(());
                };
                self.obey_byte(byte, session, link, out)?;
            }
            match session.next_event() {
                None => return Ok(()),
                Some(Event::Byte(byte)) => self.obey_byte(byte, session, link, out)?,
                Some(Event::TooLong) => session.error = ErrorCode::LineTooLong,
                Some(Event::Line) => match parse(session.line()) {
                    Ok(request) if request.needs_present() && self.stage.present().is_none() => {
                        return Ok(());
                    }
                    Ok(request) => {
                        session.finish_line();
                        self.obey(request, session, link, out)?;
                    }
                    Err(error) => {
                        session.finish_line();
                        session.error = error.code;
                    }
                },
            }
        }
    }

    fn obey_byte<W: Write>(
        &mut self,
        byte: u8,
        session: &mut Session,
        link: &mut PanelLink<'_>,
        out: &mut W,
    ) -> Result<(), W::Error> {
        let Some(request) = find_byte(byte) else {
            session.error = ErrorCode::UnknownCommand;
            return Ok(());
        };
        self.obey(request, session, link, out)
    }

    fn obey<W: Write>(
        &mut self,
        request: Request,
        session: &mut Session,
        link: &mut PanelLink<'_>,
        out: &mut W,
    ) -> Result<(), W::Error> {
        match request {
            Request::Nothing => {}
            Request::Ask(query) => self.answer(query, session, out)?,
            Request::Read(quantity, axes) => self.read(quantity, axes, out)?,
            Request::Tell(property, axes) => self.tell(property, axes, out)?,
            Request::Parameters(addresses) => self.tell_parameters(&addresses, out)?,
            Request::Reachable(values) => self.tell_reachable(&values, out)?,
            Request::Reach(values) => match self.stage.reach(&values) {
                Some(end) => tell_reach(&values, &end, out)?,
                None => session.error = ErrorCode::OutOfRange,
            },
            Request::Act(action) => {
                if let Err(code) = self.act(action, session, link) {
                    session.error = code;
                }
            }
        }
        Ok(())
    }

    /// Whether the lines of the connection have to wait; ends the wait when it is over.
    fn is_waiting(&mut self, session: &mut Session, link: &mut PanelLink<'_>) -> bool {
        let Some(wait) = session.wait else {
            return false;
        };
        if wait.stops != self.stops {
            session.error = ErrorCode::Stopped;
            session.abandon();
            return false;
        }
        let over = match wait.what {
            Awaited::Tick(tick) => self.stage.tick() >= tick,
            // A fault ends it too: the condition may never come about, and the error has been set.
            Awaited::Condition(condition) => {
                self.stage.present().is_some()
                    && (self.stage.is_faulted() || self.holds(&condition))
            }
            Awaited::Reference => match self.stage.reference(link) {
                Referencing::Waiting => false,
                Referencing::Done => true,
                Referencing::Failed(code) => {
                    session.error = code;
                    true
                }
            },
        };
        if over {
            session.wait = None;
        }
        !over
    }

    fn holds(&self, condition: &Condition) -> bool {
        let value = self.stage.value(condition.quantity, condition.axis);
        condition.operator.holds(value, condition.value)
    }
}

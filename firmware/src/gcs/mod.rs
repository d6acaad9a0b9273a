//! The front panel: the General Command Set interpreter.
//!
//! It runs at low priority, outside the tick, and meets it only through the queues of [`crate::queues`]. A [`Panel`] is what all
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
//! | `monitor` | what `MON?` tells, for clients that draw the stage while it moves |
//! | `frames` | coordinate systems of the user's own, and the centre of rotation |
//! | `parameter` | what parameters there are |
//! | `keeping` | what is kept over a restart |
//! | `record` | the data recorder: what it records, when, and reading it |
//! | `events`, `statistics`, `heartbeat` | what has happened, how the loop does, whether the host is there |
//! | `macros` | lines that are kept and carried out later |
//! | `variables`, `short` | names and values in lines |
//! | `wave` | waveforms: tables and generators |
//! | `soft`, `reach` | limits of targets, and how far one can go |
//!
//! Lines are handled in order. While a command is on its way to the tick (one tick) lines that depend on it stay where they
//! are; while `DEL`, `WAC` or `FRF` waits all lines do, and single bytes act ahead of them. A stop (`STP`, `#24`) from any
//! connection ends those waits on all of them, with error 10, and throws away the lines behind them: a script does not go on
//! after a stop.

pub mod frames;
pub mod wave;

pub(crate) mod error;
mod events;
mod execute;
mod heartbeat;
mod macros;
mod monitor;
mod output;
mod parameter;
mod parse;
mod persistence;
mod recorder;
mod replies;
mod reply;
pub(crate) mod request;
mod scan;
mod session;
mod statistics;
mod store_error;
mod table;
mod text;
mod variables;

pub use events::CAUSES;

pub use crate::commander::axis::{Axis, AxisSet, AxisValues};
pub use error::ErrorCode;
pub use macros::{DEPTH, LINES, MACRO_BYTES, MACROS, MacroRequest};
pub use parameter::{
    ADDRESSES, Address, Addresses, Item, Kind, PARAMETERS, Parameter, Settings, When,
};

pub use crate::commander::frames::{
    FrameAction, FrameName, FrameQuery, Kind as FrameKind, ListItem, NAME_BYTES as FRAME_NAME_BYTES,
};
pub use crate::commander::wave::{Curve, Join, Shape, WaveAction, WavePoints, WaveQuery};
pub use parse::{ParseError, parse};
pub use recorder::{Channel, RecordAction, RecordQuery, Source, TableList, Trigger};
pub use request::{Action, Condition, Operand, Operator, Property, Quantity, Query, Request};
pub use session::{LINE_BYTES, Session};
pub use store_error::StoreError;
pub use text::{NAME_BYTES, Name, Short, TEXT_BYTES, Text};
pub use variables::{NAMED, VARIABLES, VariableRequest};

use crate::commander::{Referencing, Stage};
use crate::motion::Limits;
use crate::parameters::Parameters;
use crate::queues::PanelLink;
use embedded_io::Write;
use events::Events;
use heartbeat::Heartbeat;
use macros::{Macros, Recorded};
use output::{Connected, Output, WriteFailed};
use persistence::Keeping;
use recorder::Desk;
use replies::tell_reach;
use session::{Awaited, Event};
use statistics::Statistics;
use table::find_byte;
use variables::Variables;

/// Longest time that a line can ask for: a day.
const LONGEST_MS: f64 = 86_400_000.0;

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
    /// Those before they were set last, in case the tick refuses.
    parameters_before: Parameters,
    /// Limits of motion that the stage was set up for, and those that level 1 has set over them.
    rated: Limits,
    stage: Stage,
    /// Why the controller started, if that is worth telling.
    start: Option<&'static str>,
    /// Times everything was stopped.
    stops: u32,
    desk: Desk,
    events: Events,
    statistics: Statistics,
    heartbeat: Heartbeat,
    wants_restart: bool,
    macros: Macros,
    variables: Variables,
    keeping: Keeping,
}

impl Panel {
    /// For a stage of these parameters.
    pub fn new(parameters: &Parameters, identity: Identity) -> Self {
        Self {
            identity,
            parameters: parameters.clone(),
            parameters_before: parameters.clone(),
            rated: parameters.limits,
            stage: Stage::new(parameters),
            stops: 0,
            desk: Desk::new(),
            events: Events::new(),
            statistics: Statistics::default(),
            heartbeat: Heartbeat::default(),
            wants_restart: false,
            macros: Macros::default(),
            variables: Variables::default(),
            keeping: Keeping::new(parameters),
            start: None,
        }
    }

    /// Notes why the controller started (a watchdog reset, say): `FLT?` tells it while there is no fault, and `EVT?`. The black
    /// box knows the [`CAUSES`] alone.
    pub fn note_start(&mut self, cause: &'static str) {
        self.start = Some(cause);
        self.events.note_start(cause);
    }

    /// The tick of the latest snapshot taken; 0 before the first.
    pub fn tick(&self) -> u64 {
        self.stage.tick()
    }

    /// Whether `RBT` has been given: the board is to start the controller again.
    pub const fn wants_restart(&self) -> bool {
        self.wants_restart
    }

    /// Takes a new snapshot, carries on what is pending, handles what `session` has received and writes the replies to `out`.
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
        self.listen(session);
        self.advance(link);
        if let Some(snapshot) = self.stage.snapshot() {
            session.monitor.look(snapshot);
        }
        self.tell_bad_news(session);
        let mut out = Connected::new(out);
        let result = self.handle(session, link, &mut out);
        self.stage.carry_on(link);
        self.desk.carry_on(&self.parameters, &mut link.recorder);
        match (result, out.error) {
            (Err(WriteFailed), Some(error)) => Err(error),
            _ => Ok(()),
        }
    }

    /// What goes on with and without connections: takes a new snapshot, carries on what is pending, a macro too.
    pub fn advance(&mut self, link: &mut PanelLink<'_>) {
        // One at most, so that a call depends on nothing that happens while it lasts; another one waits for the next call.
        if let Some(snapshot) = link.snapshot() {
            self.events.take(&snapshot);
            self.statistics.take(&snapshot);
            self.stage.take(snapshot);
        }
        if let Some(black_box) = link.black_box {
            self.events.keep(black_box);
        }
        self.take_back_if_refused();
        self.stage.carry_on(link);
        self.watch_heartbeat(link);
        self.run_macro(link);
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
            session.error = ErrorCode::of(fault.kind);
        }
    }

    fn handle(
        &mut self,
        session: &mut Session,
        link: &mut PanelLink<'_>,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        loop {
            while self.carry_dump(session, link, out)?
                || self.carry_history(session, link, out)?
                || self.is_waiting(session, link)
            {
                let Some(byte) = session.take_single() else {
                    return Ok(());
                };
                self.obey_byte(byte, session, link, out)?;
            }
            match session.next_event() {
                None => return Ok(()),
                Some(Event::Byte(byte)) => self.obey_byte(byte, session, link, out)?,
                Some(Event::Thrown(error)) => session.error = error,
                Some(Event::Line) => match self.understand(session) {
                    Ok(request) if request.needs_present() && self.stage.present().is_none() => {
                        return Ok(());
                    }
                    Ok(request) => {
                        session.finish_line();
                        self.obey(request, session, link, out)?;
                    }
                    Err(code) => {
                        session.finish_line();
                        session.error = code;
                    }
                },
            }
        }
    }

    /// What the line of a connection asks for; nothing when it has become part of a macro.
    fn understand(&mut self, session: &Session) -> Result<Request, ErrorCode> {
        let line = session.line();
        if let Some(number) = session.recording {
            let tick = self.stage.tick();
            if let Recorded::Kept = self.macros.record(number, line, tick)? {
                return Ok(Request::Nothing);
            }
        }
        let request = if line.contains(&b'$') {
            let locals = self.macros.locals(session);
            parse(&self.variables.expand(line, locals)?)
        } else {
            parse(line)
        };
        request.map_err(|error| error.code)
    }

    fn obey_byte(
        &mut self,
        byte: u8,
        session: &mut Session,
        link: &mut PanelLink<'_>,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let Some(request) = find_byte(byte) else {
            session.error = ErrorCode::UnknownCommand;
            return Ok(());
        };
        self.obey(request, session, link, out)
    }

    fn obey(
        &mut self,
        request: Request,
        session: &mut Session,
        link: &mut PanelLink<'_>,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        match request {
            Request::Nothing => {}
            Request::Ask(query) => self.answer(query, session, out)?,
            Request::Read(quantity, axes) => {
                if quantity == Quantity::Position {
                    session.told = self.stage.pivots();
                }
                self.read(quantity, axes, out)?;
            }
            Request::Tell(property, axes) => self.tell(property, axes, out)?,
            Request::Parameters(addresses) => self.tell_parameters(&addresses, out)?,
            Request::Reachable(values) => self.tell_reachable(&values, out)?,
            Request::Reach(values) => match self.stage.reach(&values) {
                Some(end) => tell_reach(&values, &end, out)?,
                None => session.error = ErrorCode::OutOfRange,
            },
            Request::Macro(request) => self.obey_macro(&request, session, out)?,
            Request::Variables(request) => self.obey_variables(&request, session, out)?,
            Request::Record(query) => self.tell_record(query, session, link, out)?,
            Request::Frames(query) => {
                if let Err(code) = self.stage.frames().answer(query, out)? {
                    session.error = code;
                }
            }
            Request::Waves(query) => {
                let going = self.stage.generators_going();
                self.stage.waves().answer(query, &going, out)?;
            }
            Request::Act(action) => {
                if let Err(code) = self.act_announced(action, session, link) {
                    session.error = code;
                }
            }
        }
        Ok(())
    }

    /// Carries out an action; one that moves is announced to the recorder, for which it may be the trigger.
    fn act_announced(
        &mut self,
        action: Action,
        session: &mut Session,
        link: &mut PanelLink<'_>,
    ) -> Result<(), ErrorCode> {
        if !action.moves() {
            return self.act(action, session, link);
        }
        let step = matches!(action, Action::Step(_));
        let (sent, parameters) = (self.stage.sent(), &self.parameters);
        let recorder = &mut link.recorder;
        let announced = (self.desk).announce(step, sent.wrapping_add(1), parameters, recorder)?;
        let result = self.act(action, session, link);
        let recorder = &mut link.recorder;
        match result {
            // Already there: nothing had to be sent.
            Ok(()) if self.stage.sent() == sent && !self.stage.motion_is_due() => {
                self.desk.confirm(announced, Some(sent), recorder);
            }
            Ok(()) => self.desk.confirm(announced, None, recorder),
            Err(_) => self.desk.take_back(announced, recorder),
        }
        result
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
                let holds = self.holds(&condition, session);
                if let Err(code) = holds {
                    session.error = code;
                }
                self.stage.present().is_some() && (self.stage.is_faulted() || holds.unwrap_or(true))
            }
            Awaited::Kept => match self.keeping.result() {
                None => false,
                Some(result) => {
                    session.error = result.err().unwrap_or(session.error);
                    true
                }
            },
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

    fn holds(&self, condition: &Condition, session: &Session) -> Result<bool, ErrorCode> {
        let left = match &condition.left {
            Operand::Axis(quantity, axis) => self.stage.value(*quantity, *axis),
            Operand::Variable(name) => {
                let locals = self.macros.locals(session);
                self.variables.number(name, locals)?
            }
        };
        Ok(condition.operator.holds(left, condition.value))
    }
}

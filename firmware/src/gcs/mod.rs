//! The front panel: the General Command Set interpreter.
//!
//! It runs at low priority, outside the tick, and meets it only through the queues of [`crate::queues`]. A [`Panel`] is what all
//! connections share, a [`Session`] is one of them. Bytes go into the session, [`Panel::service`] handles them and writes
//! the replies:
//!
//! ```text
//! bytes -> Session::receive -> line or single byte -> parse -> Request -> Commander -> Command -> tick
//!                                                        \-> reply <- Commander <- Snapshot <----/
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

mod error;
mod events;
mod execute;
mod frames;
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
mod request;
mod scan;
mod session;
mod statistics;
mod table;
mod text;
mod variables;
mod wave;

pub use events::CAUSES;
use frames::reply_frames;
use wave::reply_waves;

pub use error::ErrorCode;
pub use macros::{LINES_PER_TICK, MACRO_BYTES, MAX_CALL_DEPTH, MAX_MACROS, MacroRequest};
pub use parameter::{
    Address, Addresses, Item, Kind, MAX_ADDRESSES, PARAMETERS, Parameter, Settings, When,
};

pub use frames::{FrameQuery, ListItem};
pub use parse::{ParseError, parse};
pub use recorder::{Channel, RecordAction, RecordQuery, SignalSource, TableList, Trigger};
pub use request::{Action, Condition, Operand, Operator, Property, Query, Request};
pub use session::{LINE_BYTES, Session};
pub use text::{FixedText, NAME_BYTES, Name, TEXT_BYTES, Text};
pub use variables::{MAX_NAMED_VARIABLES, MAX_VARIABLES, VariableRequest};
pub use wave::WaveQuery;

use crate::commander::{Commander, Quantity, Referencing};
use crate::motion::Limits;
use crate::parameters::Parameters;
use crate::queues::PanelLink;
use embedded_io::Write;
use events::EventLog;
use heartbeat::Heartbeat;
use macros::{Macros, Recorded};
use output::{Connected, Output, WriteFailed};
use persistence::Persistence;
use recorder::RecorderState;
use replies::reply_furthest_target;
use session::{Awaited, InputItem};
use statistics::Statistics;
use table::find_byte;
use variables::Variables;

/// Longest time that a line can ask for: a day.
const MAX_DELAY_MS: f64 = 86_400_000.0;

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
    previous_parameters: Parameters,
    /// Limits of motion that the stage was set up for, and those that level 1 has set over them.
    rated_limits: Limits,
    commander: Commander,
    /// Why the controller started, if that is worth telling.
    start_cause: Option<&'static str>,
    /// Times everything was stopped.
    stops: u32,
    recorder_state: RecorderState,
    events: EventLog,
    statistics: Statistics,
    heartbeat: Heartbeat,
    wants_restart: bool,
    macros: Macros,
    variables: Variables,
    persistence: Persistence,
    /// Errors for every connection: how many so far, and the latest.
    reported: (u32, ErrorCode),
}

impl Panel {
    /// For a stage of these parameters.
    pub fn new(parameters: &Parameters, identity: Identity) -> Self {
        Self {
            identity,
            parameters: parameters.clone(),
            previous_parameters: parameters.clone(),
            rated_limits: parameters.limits,
            commander: Commander::new(parameters),
            stops: 0,
            recorder_state: RecorderState::new(),
            events: EventLog::new(),
            statistics: Statistics::default(),
            heartbeat: Heartbeat::default(),
            wants_restart: false,
            macros: Macros::default(),
            variables: Variables::default(),
            persistence: Persistence::new(parameters),
            reported: (0, ErrorCode::None),
            start_cause: None,
        }
    }

    /// Notes why the controller started (a watchdog reset, say): `FLT?` tells it while there is no fault, and `EVT?`. The black
    /// box knows the [`CAUSES`] alone.
    pub fn note_start(&mut self, cause: &'static str) {
        self.start_cause = Some(cause);
        self.events.note_start(cause);
    }

    /// The tick of the latest snapshot taken; 0 before the first.
    pub fn tick(&self) -> u64 {
        self.commander.tick()
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
        queues: &mut PanelLink<'_>,
        out: &mut W,
    ) -> Result<(), W::Error> {
        self.note_activity(session);
        self.advance(queues);
        if let Some(snapshot) = self.commander.snapshot() {
            session.monitor.update(snapshot);
        }
        self.report_errors(session);
        let mut out = Connected::new(out);
        let result = self.handle(session, queues, &mut out);
        self.commander.advance_pending(queues);
        self.recorder_state
            .send_pending_order(&self.parameters, &mut queues.recorder);
        match (result, out.error) {
            (Err(WriteFailed), Some(error)) => Err(error),
            _ => Ok(()),
        }
    }

    /// What goes on with and without connections: takes a new snapshot, carries on what is pending, a macro too.
    pub fn advance(&mut self, queues: &mut PanelLink<'_>) {
        // One at most, so that a call depends on nothing that happens while it lasts; another one waits for the next call.
        if let Some(snapshot) = queues.snapshot() {
            self.events.update(&snapshot);
            self.statistics.update(&snapshot);
            self.commander.update(snapshot);
        }
        if let Some(black_box) = queues.black_box {
            self.events.retain(black_box);
        }
        self.revert_if_refused();
        self.commander.advance_pending(queues);
        self.watch_heartbeat(queues);
        self.run_macro(queues);
    }

    /// Sets the error of every connection.
    pub(crate) fn report_to_all(&mut self, code: ErrorCode) {
        self.collect_late_error();
        self.reported = (self.reported.0.wrapping_add(1), code);
    }

    /// What became of a request that had been accepted sets the error of every connection too: the one that asked has had its
    /// silence, which means yes, long since.
    fn collect_late_error(&mut self) {
        if let Some(error) = self.commander.take_late_error() {
            self.reported = (self.reported.0.wrapping_add(1), error.into());
        }
    }

    /// What has been reported to all connections sets the error of this one, and so does a fault, each once.
    fn report_errors(&mut self, session: &mut Session) {
        self.collect_late_error();
        let (count, code) = self.reported;
        if session
            .errors_reported
            .replace(count)
            .is_some_and(|before| before != count)
        {
            session.error = code;
        }
        let fault = self
            .commander
            .snapshot()
            .and_then(|snapshot| snapshot.fault);
        if let Some(fault) = fault
            && session.fault_tick.replace(fault.tick) != Some(fault.tick)
        {
            session.error = ErrorCode::of(fault.kind);
        }
    }

    fn handle(
        &mut self,
        session: &mut Session,
        queues: &mut PanelLink<'_>,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        loop {
            while self.write_readout(session, queues, out)?
                || self.write_fault_record_readout(session, queues, out)?
                || self.is_waiting(session, queues)
            {
                let Some(byte) = session.take_single() else {
                    return Ok(());
                };
                self.execute_byte(byte, session, queues, out)?;
            }
            match session.next_item() {
                None => return Ok(()),
                Some(InputItem::Byte(byte)) => self.execute_byte(byte, session, queues, out)?,
                Some(InputItem::Discarded(error)) => session.error = error,
                Some(InputItem::Line) => match self.parse_line(session) {
                    Ok(request)
                        if request.needs_current_snapshot()
                            && self.commander.current_snapshot().is_none() =>
                    {
                        return Ok(());
                    }
                    Ok(request) => {
                        session.finish_line();
                        self.execute(request, session, queues, out)?;
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
    fn parse_line(&mut self, session: &Session) -> Result<Request, ErrorCode> {
        let line = session.line();
        if let Some(number) = session.recording {
            let tick = self.commander.tick();
            if let Recorded::AddedToMacro = self.macros.record_line(number, line, tick)? {
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

    fn execute_byte(
        &mut self,
        byte: u8,
        session: &mut Session,
        queues: &mut PanelLink<'_>,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let Some(request) = find_byte(byte) else {
            session.error = ErrorCode::UnknownCommand;
            return Ok(());
        };
        self.execute(request, session, queues, out)
    }

    fn execute(
        &mut self,
        request: Request,
        session: &mut Session,
        queues: &mut PanelLink<'_>,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        match request {
            Request::Nothing => {}
            Request::Query(query) => self.reply_query(query, session, out)?,
            Request::Quantity(quantity, axes) => {
                if quantity == Quantity::Position {
                    session.reported_pivots = self.commander.pivots();
                }
                self.reply_quantity(quantity, axes, out)?;
            }
            Request::Property(property, axes) => self.reply_property(property, axes, out)?,
            Request::Parameters(addresses) => self.reply_parameters(&addresses, out)?,
            Request::Reachable(values) => self.reply_reachable(&values, out)?,
            Request::FurthestTarget(values) => match self.commander.furthest_target(&values) {
                Some(end) => reply_furthest_target(&values, &end, out)?,
                None => session.error = ErrorCode::OutOfRange,
            },
            Request::Macro(request) => self.execute_macro(&request, session, out)?,
            Request::Variables(request) => self.execute_variables(&request, session, out)?,
            Request::Record(query) => self.reply_record(query, session, queues, out)?,
            Request::Frames(query) => {
                if let Err(code) = reply_frames(self.commander.frames(), query, out)? {
                    session.error = code;
                }
            }
            Request::Waveforms(query) => {
                let running = self.commander.running_generators();
                reply_waves(self.commander.waves(), query, &running, out)?;
            }
            Request::Act(action) => {
                if let Err(code) = self.perform_announced(action, session, queues) {
                    session.error = code;
                }
            }
        }
        Ok(())
    }

    /// Carries out an action; one that moves is announced to the recorder, for which it may be the trigger.
    fn perform_announced(
        &mut self,
        action: Action,
        session: &mut Session,
        queues: &mut PanelLink<'_>,
    ) -> Result<(), ErrorCode> {
        if !action.starts_motion() {
            return self.perform(action, session, queues);
        }
        let step = matches!(action, Action::Step(_));
        let (sent, parameters) = (self.commander.commands_sent(), &self.parameters);
        let recorder = &mut queues.recorder;
        let announced =
            (self.recorder_state).announce(step, sent.wrapping_add(1), parameters, recorder)?;
        let result = self.perform(action, session, queues);
        let recorder = &mut queues.recorder;
        match result {
            // Already there: nothing had to be sent.
            Ok(())
                if self.commander.commands_sent() == sent
                    && !self.commander.is_motion_pending() =>
            {
                self.recorder_state.confirm(announced, Some(sent), recorder);
            }
            Ok(()) => self.recorder_state.confirm(announced, None, recorder),
            Err(_) => self.recorder_state.revoke(announced, recorder),
        }
        result
    }

    /// Whether the lines of the connection have to wait; ends the wait when it is over.
    fn is_waiting(&mut self, session: &mut Session, queues: &mut PanelLink<'_>) -> bool {
        let Some(wait) = session.wait else {
            return false;
        };
        if wait.stops != self.stops {
            session.error = ErrorCode::Stopped;
            session.abandon();
            return false;
        }
        let over = match wait.what {
            Awaited::Tick(tick) => self.commander.tick() >= tick,
            // A fault ends it too: the condition may never come about, and the error has been set.
            Awaited::Condition(condition) => {
                let holds = self.is_met(&condition, session);
                if let Err(code) = holds {
                    session.error = code;
                }
                self.commander.current_snapshot().is_some()
                    && (self.commander.is_faulted() || holds.unwrap_or(true))
            }
            Awaited::Stored => match self.persistence.result() {
                None => false,
                Some(result) => {
                    session.error = result.err().unwrap_or(session.error);
                    true
                }
            },
            Awaited::Reference => match self.commander.poll_referencing(queues) {
                Referencing::Waiting => false,
                Referencing::Done => true,
                Referencing::Failed(error) => {
                    session.error = error.into();
                    true
                }
            },
        };
        if over {
            session.wait = None;
        }
        !over
    }

    fn is_met(&self, condition: &Condition, session: &Session) -> Result<bool, ErrorCode> {
        let left = match &condition.left {
            Operand::Axis(quantity, axis) => self.commander.value(*quantity, *axis),
            Operand::Variable(name) => {
                let locals = self.macros.locals(session);
                self.variables.number(name, locals)?
            }
        };
        Ok(condition.operator.holds(left, condition.value))
    }
}

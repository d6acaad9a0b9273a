//! What a connection has sent, line by line: taken, understood, carried out, answered.

use super::error::ErrorCode;
use super::frames::reply_frames;
use super::interpreter::Interpreter;
use super::macros::Recorded;
use super::output::{Connected, Output, WriteFailed};
use super::parse::parse;
use super::replies::reply_furthest_target;
use super::request::{Action, Request};
use super::session::{InputItem, Session};
use super::table::find_byte;
use super::variables::expand;
use super::wave::reply_waves;
use crate::commander::Quantity;
use crate::queues::CommandQueues;
use crate::self_test::Board;
use embedded_io::Write;

impl Interpreter {
    /// Takes a new snapshot, carries on what is pending, handles what `session` has received and writes the replies to
    /// `out`. To be called for every connection as often as possible: on the host once every tick, on the chip in the
    /// idle loop.
    ///
    /// # Errors
    /// Those of `out`. The connection is then to be closed; the interpreter goes on with the others.
    pub fn service<W: Write>(
        &mut self,
        session: &mut Session,
        queues: &mut CommandQueues<'_>,
        out: &mut W,
    ) -> Result<(), W::Error> {
        self.register(session);
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
    // A frame of its own, as `handle` and `execute` have: what one needs on the stack is not there below the other.
    #[inline(never)]
    pub fn advance(&mut self, queues: &mut CommandQueues<'_>) {
        self.carry_on(queues);
        self.run_macro(queues);
    }

    /// The same but for a macro, whose lines need all of the stack that is left.
    #[inline(never)]
    fn carry_on(&mut self, queues: &mut CommandQueues<'_>) {
        // One at most, so that a call depends on nothing that happens while it lasts; another one waits for the next
        // call.
        if let Some(snapshot) = queues.snapshot() {
            self.events.update(&snapshot);
            self.statistics.update(&snapshot);
            self.watch_drives(&snapshot);
            if let Some(retained_memory) = queues.retained_memory {
                retained_memory.keep_motor_heat(&snapshot.motor_heat);
            }
            let report = snapshot.servo;
            self.commander.update(snapshot);
            let is_configuring = self.commander.is_configuring();
            self.servo_reports.update(report, is_configuring);
        }
        if let Some(retained_memory) = queues.retained_memory {
            self.events.retain(retained_memory);
        }
        let may_be_halted = self.board.is_some_and(Board::has_debugger)
            && !self.parameters.supervision.debugger_allowed;
        self.commander.set_debugged(may_be_halted);
        self.revert_if_refused();
        self.commander.send_due_calibration(queues);
        // With no room in the queue, the next time.
        let _ = (self.commander).send_due_subdivision(&self.parameters, queues);
        self.commander.advance_pending(queues);
        self.keep_learnt(queues);
        self.watch_heartbeat(queues);
        self.end_jogs(queues);
        self.advance_recovery(queues);
    }

    /// Sets the error of every connection.
    pub(crate) fn report_to_all(&mut self, code: ErrorCode) {
        self.collect_late_error();
        self.reported = (self.reported.0.wrapping_add(1), code);
    }

    /// What became of a request that had been accepted sets the error of every connection too: the one that asked has
    /// had its silence, which means yes, long since.
    fn collect_late_error(&mut self) {
        if let Some(error) = self.commander.take_late_error() {
            self.reported = (self.reported.0.wrapping_add(1), error.into());
        }
    }

    /// What has been reported to all connections sets the error of this one, and so does a fault, each once.
    pub(super) fn report_errors(&mut self, session: &mut Session) {
        self.collect_late_error();
        let (count, code) = self.reported;
        if session
            .errors_reported
            .replace(count)
            .is_some_and(|before| before != count)
        {
            session.error = code;
        }
        self.report_stopped_motion(session);
        let fault = self
            .commander
            .snapshot()
            .and_then(|snapshot| snapshot.fault);
        match fault {
            Some(fault) if session.fault_tick.replace(fault.tick) != Some(fault.tick) => {
                session.error = ErrorCode::of(fault.kind);
            }
            Some(_) => {}
            // Acknowledged, on whichever connection: nobody needs to be told any more.
            None if session.fault_tick.take().is_some() && session.error.is_of_fault() => {
                session.error = ErrorCode::None;
            }
            None => {}
        }
    }

    #[inline(never)]
    pub(super) fn handle(
        &mut self,
        session: &mut Session,
        queues: &mut CommandQueues<'_>,
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
                Some(InputItem::Line) if session.is_line_late() && !is_question(session.line()) => {
                    session.finish_line();
                }
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
            parse(&expand(line, |name| self.variable(name, session))?)
        } else {
            parse(line)
        };
        request.map_err(|error| error.code)
    }

    fn execute_byte(
        &mut self,
        byte: u8,
        session: &mut Session,
        queues: &mut CommandQueues<'_>,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let Some(request) = find_byte(byte) else {
            session.error = ErrorCode::UnknownCommand;
            return Ok(());
        };
        self.execute(request, session, queues, out)
    }

    #[inline(never)]
    fn execute(
        &mut self,
        request: Request,
        session: &mut Session,
        queues: &mut CommandQueues<'_>,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        if let Err(code) = self.check_ownership(&request, session) {
            session.error = code;
            return Ok(());
        }
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
        queues: &mut CommandQueues<'_>,
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
        if result.is_ok() {
            self.note_mover(session);
        }
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
}

/// Whether a line asks for nothing but an answer.
fn is_question(line: &[u8]) -> bool {
    parse(line).is_ok_and(|request| request.is_question())
}

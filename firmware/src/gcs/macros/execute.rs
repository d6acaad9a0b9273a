//! Carrying out what is about macros and variables, and running the macro.

use super::state::lines;
use super::{Failure, LINES_PER_TICK, MacroRequest, Macros};
use crate::gcs::Panel;
use crate::gcs::error::ErrorCode;
use crate::gcs::output::{Discard, Output, WriteFailed};
use crate::gcs::reply::ReplyWriter;
use crate::gcs::request::Condition;
use crate::gcs::session::Session;
use crate::gcs::text::{Name, Text};
use crate::gcs::variables::{Locals, VariableRequest, number_text};
use crate::queues::PanelLink;

impl Macros {
    /// Whether a macro runs.
    pub fn is_running(&self) -> bool {
        !self.calls.is_empty()
    }

    /// Ends the macro that runs, if one does.
    pub fn stop(&mut self) {
        self.calls.clear();
    }

    /// The local variables of the macro that runs, for its own lines.
    pub fn locals(&self, session: &Session) -> Option<&Locals> {
        session.is_macro.then(|| self.calls.locals()).flatten()
    }

    fn locals_mut(&mut self, session: &Session) -> Option<&mut Locals> {
        if session.is_macro {
            self.calls.locals_mut()
        } else {
            None
        }
    }

    /// All macros, with their lines.
    pub fn all(&self) -> impl Iterator<Item = (Name, &[u8])> {
        self.store.all()
    }

    /// Adds to the text of a macro that was kept; false when it can be none, or there is no room.
    pub fn add_text(&mut self, text: &[u8]) -> bool {
        let printable = |byte: &u8| matches!(byte, b' '..=b'~' | b'\n');
        text.iter().all(printable) && self.store.extend(text)
    }

    /// The text that was added is the macro of this name; false when there are too many.
    pub fn end_text(&mut self, name: Name) -> bool {
        self.store.find(&name).is_none() && self.store.commit(name).is_ok()
    }

    /// Forgets all.
    pub fn clear(&mut self) {
        self.store.clear();
    }

    fn place(&self, name: &Name) -> Result<usize, ErrorCode> {
        self.store.find(name).ok_or(ErrorCode::MacroNotFound)
    }

    fn delete(&mut self, name: &Name) -> Result<(), ErrorCode> {
        if self.is_running() {
            return Err(ErrorCode::MacroRunning);
        }
        let place = self.place(name)?;
        self.store.remove(place);
        Ok(())
    }

    /// The macro's line has been carried out: whether it goes on.
    fn check_line_result(&mut self, session: &mut Session) -> bool {
        match core::mem::take(&mut session.error) {
            // What `HLT` leaves; after `STP` nothing runs any more.
            ErrorCode::None | ErrorCode::Stopped => {}
            code => {
                if let Some((place, number)) = self.calls.current() {
                    self.failure = Some(Failure {
                        name: self.store.name(place),
                        line: number,
                        code,
                        text: self.line.clone(),
                    });
                }
                self.stop();
            }
        }
        self.is_running()
    }
}

impl Panel {
    /// Carries out what is about macros; queries are answered.
    pub(in crate::gcs) fn execute_macro(
        &mut self,
        request: &MacroRequest,
        session: &mut Session,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let result = match request {
            MacroRequest::Begin(name) => self.macros.begin(*name, self.commander.tick(), session),
            MacroRequest::End => self.macros.end(session),
            MacroRequest::Start(name, times, arguments) => {
                self.start(name, *times, arguments, session)
            }
            MacroRequest::Delete(name) => self.macros.delete(name),
            MacroRequest::Stop(name) => self.stop_macro(name.as_ref()),
            MacroRequest::List(Some(name)) => match self.macros.place(name) {
                Ok(place) => return reply_lines(self.macros.store.text(place), out),
                Err(code) => Err(code),
            },
            _ => return self.reply_macros(request, out),
        };
        let changes = matches!(request, MacroRequest::End | MacroRequest::Delete(_));
        match result {
            Ok(()) if changes => self.persistence.mark_macros_changed(),
            Ok(()) => {}
            Err(code) => session.error = code,
        }
        Ok(())
    }

    fn reply_macros(
        &self,
        request: &MacroRequest,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let macros = &self.macros;
        let mut reply = ReplyWriter::new(out);
        match request {
            MacroRequest::Error => {
                if let Some(Failure {
                    name,
                    line,
                    code,
                    text,
                }) = &macros.failure
                {
                    // Only what could be printed was recorded.
                    let text = core::str::from_utf8(text).unwrap_or_default();
                    let code = code.number();
                    reply.line(format_args!("{name} {line}={code} <{text}>"))?;
                }
            }
            MacroRequest::Free => reply.line(format_args!("{}", macros.store.free()))?,
            MacroRequest::List(_) => {
                for name in macros.store.names() {
                    reply.line(format_args!("{name}"))?;
                }
            }
            MacroRequest::Running => {
                for place in macros.calls.places() {
                    reply.line(format_args!("{}", macros.store.name(place)))?;
                }
            }
            _ => reply.line(format_args!("{}", u8::from(macros.is_running())))?,
        }
        reply.end()
    }

    /// `MAC START`: from a connection the macro begins a session of its own; from a macro it runs before that goes on.
    fn start(
        &mut self,
        name: &Name,
        times: u32,
        arguments: &[Option<Text>; 2],
        session: &Session,
    ) -> Result<(), ErrorCode> {
        if self.macros.is_running() && !session.is_macro {
            return Err(ErrorCode::MacroRunning);
        }
        let place = self.macros.place(name)?;
        self.macros.calls.enter(place, times, arguments)?;
        if !session.is_macro {
            self.macros.failure = None;
            self.macros.session = Session::for_macro(session.level);
            // What is old news already does not end it.
            let mut session = core::mem::take(&mut self.macros.session);
            self.report_errors(&mut session);
            session.error = ErrorCode::None;
            self.macros.session = session;
        }
        Ok(())
    }

    fn stop_macro(&mut self, name: Option<&Name>) -> Result<(), ErrorCode> {
        if let Some(name) = name {
            let place = self.macros.place(name)?;
            if !self.macros.calls.contains(place) {
                return Ok(());
            }
        }
        self.macros.stop();
        Ok(())
    }

    /// `JRC` and `MEX`, which only a macro can have.
    pub(in crate::gcs) fn jump_if(
        &mut self,
        by: Option<i32>,
        condition: &Condition,
        session: &Session,
    ) -> Result<(), ErrorCode> {
        if !session.is_macro {
            return Err(ErrorCode::NotAllowed);
        }
        if !self.is_met(condition, session)? {
            return Ok(());
        }
        let macros = &mut self.macros;
        match by {
            Some(by) => {
                // A loop without a wait goes round once a tick.
                macros.lines = 0;
                macros.calls.jump(by, &macros.store)
            }
            None => {
                macros.calls.leave();
                Ok(())
            }
        }
    }

    /// Carries out what is about variables.
    pub(in crate::gcs) fn execute_variables(
        &mut self,
        request: &VariableRequest,
        session: &mut Session,
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let result = match request {
            VariableRequest::Set(name, value) => self.set_variable(name, *value, session),
            VariableRequest::Add(name, a, b) => {
                number_text(a + b).and_then(|sum| self.set_variable(name, Some(sum), session))
            }
            VariableRequest::Query(names) => {
                let named = names.iter().flatten();
                let locals = self.macros.locals(session);
                let known = |name: &Name| self.variables.get(name, locals).is_some();
                if named.clone().all(known) {
                    return self.reply_variables(names, out);
                }
                Err(ErrorCode::UnknownVariable)
            }
        };
        if let Err(code) = result {
            session.error = code;
        }
        Ok(())
    }

    fn set_variable(
        &mut self,
        name: &Name,
        value: Option<Text>,
        session: &Session,
    ) -> Result<(), ErrorCode> {
        let locals = self.macros.locals_mut(session);
        self.variables.set(name, value, locals)
    }

    fn reply_variables(
        &self,
        names: &[Option<Name>],
        out: &mut Output<'_>,
    ) -> Result<(), WriteFailed> {
        let mut reply = ReplyWriter::new(out);
        let all = names.iter().all(Option::is_none);
        for (name, value) in self.variables.iter() {
            if all || names.contains(&Some(*name)) {
                reply.line(format_args!("{name}={value}"))?;
            }
        }
        reply.end()
    }

    /// Carries on the macro that runs, as far as its lines for this tick go.
    pub(in crate::gcs) fn run_macro(&mut self, queues: &mut PanelLink<'_>) {
        if !self.macros.is_running() {
            return;
        }
        let tick = self.commander.tick();
        if self.macros.tick != tick {
            self.macros.tick = tick;
            self.macros.lines = LINES_PER_TICK;
        }
        let mut session = core::mem::take(&mut self.macros.session);
        self.report_errors(&mut session);
        loop {
            // Nothing that is thrown away fails.
            let _ = self.handle(&mut session, queues, &mut Discard);
            if !session.is_idle() || !self.macros.check_line_result(&mut session) {
                break;
            }
            if self.macros.lines == 0 {
                break;
            }
            self.macros.lines -= 1;
            let macros = &mut self.macros;
            macros.line.clear();
            // No line was recorded that is longer than one may be, and the input is empty.
            let _ = (macros.line).extend_from_slice(macros.calls.next(&macros.store));
            session.receive(&macros.line);
            session.receive(b"\n");
        }
        if self.macros.is_running() {
            self.macros.session = session;
        }
    }
}

fn reply_lines(text: &[u8], out: &mut Output<'_>) -> Result<(), WriteFailed> {
    let mut reply = ReplyWriter::new(out);
    for line in lines(text) {
        // Only what could be printed was recorded.
        let line = core::str::from_utf8(line).unwrap_or_default();
        reply.line(format_args!("{line}"))?;
    }
    reply.end()
}

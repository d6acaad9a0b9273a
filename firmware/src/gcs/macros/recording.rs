//! Recording a macro, one at a time in the whole controller.
//!
//! A client that goes away in the middle leaves its recording open; another connection may begin its own when nothing
//! has been recorded for [`RECORDING_TIMEOUT_TICKS`]. The lines of the one that lost it, should it be there still, are
//! thrown away up to its `MAC END`, which is an error: they were never meant to be carried out.

use super::request::MacroRequest;
use super::state::{Macros, Recording};
use crate::gcs::error::ErrorCode;
use crate::gcs::parse::parse;
use crate::gcs::request::Request;
use crate::gcs::scan::Scanner;
use crate::gcs::session::Session;
use crate::gcs::table::find;
use crate::gcs::text::Name;

/// How long a recording without a new line keeps others out: 10 s at 20 kHz.
pub const RECORDING_TIMEOUT_TICKS: u64 = 200_000;

/// What becomes of a line of a connection that records.
pub(in crate::gcs) enum Recorded {
    /// It is part of the macro now.
    AddedToMacro,
    /// It is to be carried out.
    CarryOut,
}

impl Macros {
    /// `MAC BEG`
    pub(super) fn begin(
        &mut self,
        name: Name,
        tick: u64,
        session: &mut Session,
    ) -> Result<(), ErrorCode> {
        if self.is_running() {
            return Err(ErrorCode::MacroRunning);
        }
        let open = |recording: &Recording| tick < recording.tick + RECORDING_TIMEOUT_TICKS;
        if self.recording.as_ref().is_some_and(open) {
            return Err(ErrorCode::Busy);
        }
        self.store.discard_recording();
        self.recordings = self.recordings.wrapping_add(1);
        self.recording = Some(Recording {
            name,
            number: self.recordings,
            tick,
            error: None,
        });
        session.recording = Some(self.recordings);
        Ok(())
    }

    /// Takes the line of a connection that records.
    pub(in crate::gcs) fn record_line(
        &mut self,
        number: u32,
        line: &[u8],
        tick: u64,
    ) -> Result<Recorded, ErrorCode> {
        if is_immediate(line) {
            return Ok(Recorded::CarryOut);
        }
        let Some(recording) = self.recording.as_mut().filter(|r| r.number == number) else {
            return Err(ErrorCode::Busy);
        };
        recording.tick = tick;
        let result = check_macro_line(line).and_then(|()| {
            let fits = self.store.append(line);
            fits.then_some(()).ok_or(ErrorCode::NoMemory)
        });
        if let Err(code) = result {
            recording.error.get_or_insert(code);
        }
        result.map(|()| Recorded::AddedToMacro)
    }

    /// `MAC END`: the connection does not record any more, whatever becomes of it.
    pub(super) fn end(&mut self, session: &mut Session) -> Result<(), ErrorCode> {
        let number = session.recording.take().ok_or(ErrorCode::NotRecording)?;
        let own = self.recording.take_if(|r| r.number == number);
        let recording = own.ok_or(ErrorCode::Busy)?;
        let running = self.store.find(&recording.name);
        let running = running.is_some_and(|place| self.calls.contains(place));
        let problem = recording
            .error
            .or(running.then_some(ErrorCode::MacroRunning));
        if let Some(code) = problem {
            self.store.discard_recording();
            return Err(code);
        }
        self.store.commit(recording.name)
    }
}

/// Whether a line is no part of a macro: the end of the recording, and queries, whose answer the client waits for.
fn is_immediate(line: &[u8]) -> bool {
    let name = Scanner::new(line).word().text;
    name.is_empty()
        || name.ends_with(b"?")
        || matches!(parse(line), Ok(Request::Macro(MacroRequest::End)))
}

/// Whether a line can be one of a macro. What stands for a variable is known only when it runs, so of such a line only
/// the command's name is looked at.
fn check_macro_line(line: &[u8]) -> Result<(), ErrorCode> {
    if !line.iter().all(|byte| matches!(byte, b' '..=b'~')) {
        return Err(ErrorCode::Syntax);
    }
    if line.contains(&b'$') {
        let mut scanner = Scanner::new(line);
        let (name, keyword) = (scanner.word().text, scanner.word().text);
        let entry = find(name, b"").or_else(|| find(name, keyword));
        let known = entry.is_some() || name.contains(&b'$');
        return known.then_some(()).ok_or(ErrorCode::UnknownCommand);
    }
    match parse(line) {
        Ok(Request::Macro(MacroRequest::Begin(_))) => Err(ErrorCode::MacroParameter),
        Ok(_) => Ok(()),
        Err(error) => Err(error.code),
    }
}

//! Which line of the running macros comes next.

use super::texts::MacroTexts;
use crate::gcs::error::ErrorCode;
use crate::gcs::text::Text;
use crate::gcs::variables::{Locals, number_text};
use heapless::Vec;

/// How deep a macro may start macros.
pub const MAX_CALL_DEPTH: usize = 5;

/// The macros that run, the one that started the others first.
#[derive(Default)]
pub(super) struct Calls {
    calls: Vec<Call, MAX_CALL_DEPTH>,
}

struct Call {
    /// Its place in the store.
    place: usize,
    /// Byte of its text at which the next line begins.
    at: usize,
    /// Number of the line that was taken last, counted from 1; 0 before the first.
    line: u16,
    /// How often it runs once more after this.
    repeats_left: u32,
    locals: Locals,
}

impl Calls {
    /// Places of those that run, from the outermost to the innermost.
    pub fn places(&self) -> impl Iterator<Item = usize> {
        self.calls.iter().map(|call| call.place)
    }

    pub fn is_empty(&self) -> bool {
        self.calls.is_empty()
    }

    pub fn contains(&self, place: usize) -> bool {
        self.places().any(|running| running == place)
    }

    pub fn clear(&mut self) {
        self.calls.clear();
    }

    /// Place and line of what is being carried out.
    pub fn current(&self) -> Option<(usize, u16)> {
        self.calls.last().map(|call| (call.place, call.line))
    }

    pub fn locals(&self) -> Option<&Locals> {
        self.calls.last().map(|call| &call.locals)
    }

    pub fn locals_mut(&mut self) -> Option<&mut Locals> {
        self.calls.last_mut().map(|call| &mut call.locals)
    }

    /// Starts the macro at a place inside those that run, `times` times.
    pub fn enter(
        &mut self,
        place: usize,
        times: u32,
        arguments: &[Option<Text>; 2],
    ) -> Result<(), ErrorCode> {
        let mut locals = Locals::default();
        let count = arguments.iter().flatten().count();
        locals[0] = Some(number_text(count as f64)?);
        locals[1..=arguments.len()].copy_from_slice(arguments);
        let call = Call {
            place,
            at: 0,
            line: 0,
            repeats_left: times.saturating_sub(1),
            locals,
        };
        self.calls
            .push(call)
            .map_err(|_| ErrorCode::TooDeeplyNested)
    }

    /// Ends the innermost macro, however often it was to run.
    pub fn leave(&mut self) {
        self.calls.pop();
    }

    /// Takes the next line; an empty one when a macro has come to its end, which is a step too.
    pub fn next<'a>(&mut self, store: &'a MacroTexts) -> &'a [u8] {
        let Some(call) = self.calls.last_mut() else {
            return &[];
        };
        let rest = store.text(call.place).get(call.at..).unwrap_or_default();
        if let Some(end) = rest.iter().position(|&byte| byte == b'\n') {
            call.at += end + 1;
            call.line += 1;
            return &rest[..end];
        }
        if call.repeats_left > 0 {
            call.repeats_left -= 1;
            (call.at, call.line) = (0, 0);
        } else {
            self.leave();
        }
        &[]
    }

    /// `JRC`: what comes next is `by` lines from the one that is being carried out. An error leads out of the macro.
    pub fn jump(&mut self, by: i32, store: &MacroTexts) -> Result<(), ErrorCode> {
        let call = self.calls.last_mut().ok_or(ErrorCode::NotAllowed)?;
        let line = i64::from(call.line) + i64::from(by);
        let before = usize::try_from(line - 1).map_err(|_| ErrorCode::OutOfRange)?;
        let mut at = 0;
        let mut lines = super::texts::lines(store.text(call.place));
        for _ in 0..before {
            at += lines.next().ok_or(ErrorCode::OutOfRange)?.len() + 1;
        }
        // Behind the last line is a place too: the end.
        (call.at, call.line) = (at, before as u16);
        Ok(())
    }
}

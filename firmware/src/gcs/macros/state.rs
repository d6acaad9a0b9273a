//! All about macros that the connections share.

use super::calls::Calls;
use super::texts::MacroTexts;
use crate::gcs::error::ErrorCode;
use crate::gcs::session::Session;
use crate::gcs::text::{LINE_BYTES, Name};
use crate::gcs::variables::Locals;

/// Lines of a macro carried out in a tick.
pub const LINES_PER_TICK: u32 = 8;

/// All about macros that the connections share.
#[derive(Default)]
pub(in crate::gcs) struct Macros {
    pub(super) store: MacroTexts,
    pub(super) recording: Option<Recording>,
    /// Recordings begun so far: identifies one.
    pub(super) recordings: u32,
    pub(super) calls: Calls,
    /// The connection of the macro that runs.
    pub(super) session: Session,
    /// Its line that is being carried out.
    pub(super) line: Line,
    /// Lines left for this tick, and which it is.
    pub(super) lines: u32,
    pub(super) tick: u64,
    pub(super) failure: Option<Failure>,
}

/// A line of a macro.
pub(super) type Line = heapless::Vec<u8, { LINE_BYTES }>;

/// The error that ended a macro.
pub(super) struct Failure {
    pub name: Name,
    pub line: u16,
    pub code: ErrorCode,
    pub text: Line,
}

/// The recording under way.
pub(super) struct Recording {
    pub name: Name,
    /// Its connection holds the same number.
    pub number: u32,
    /// When its last line came.
    pub tick: u64,
    /// Why it will not be stored.
    pub error: Option<ErrorCode>,
}

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

    pub fn locals_mut(&mut self, session: &Session) -> Option<&mut Locals> {
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

    /// Adds to the text of a macro that was stored; false when it can be none, or there is no room.
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

    pub(super) fn place(&self, name: &Name) -> Result<usize, ErrorCode> {
        self.store.find(name).ok_or(ErrorCode::MacroNotFound)
    }

    pub(super) fn delete(&mut self, name: &Name) -> Result<(), ErrorCode> {
        if self.is_running() {
            return Err(ErrorCode::MacroRunning);
        }
        let place = self.place(name)?;
        self.store.remove(place);
        Ok(())
    }

    /// The macro's line has been carried out: whether it goes on.
    pub(super) fn check_line_result(&mut self, session: &mut Session) -> bool {
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

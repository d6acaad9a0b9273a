//! One connection: the bytes it has received, its error, and what it waits for.

use super::connection_number::ConnectionNumber;
use super::error::ErrorCode;
use super::monitor::Monitor;
use super::recorder::{FaultRecordReadout, RecordReadout};
use super::request::Condition;
use super::text::{LINE_BYTES, TEXT_BYTES, Text};
use super::variables::Variables;
use core::fmt::Write;
use heapless::{Deque, Vec};
use kinematics::Angle;

/// Bytes that may wait to be handled.
const INPUT_BYTES: usize = 512;

/// `#24`.
const STOP: u8 = 24;

/// One connection. What it sends goes into [`receive`](Self::receive);
/// [`Interpreter::service`](super::Interpreter::service) does the rest.
#[derive(Default)]
pub struct Session {
    input: Deque<u8, INPUT_BYTES>,
    line: Vec<u8, LINE_BYTES>,
    state: LineState,
    pub(super) error: ErrorCode,
    pub(super) wait: Option<Wait>,
    /// An answer that is written as the output has room.
    pub(super) readout: Option<RecordReadout>,
    /// The same for the fault record.
    pub(super) fault_record_readout: Option<FaultRecordReadout>,
    /// Bytes of it that the output takes now; any number where nobody has said.
    pub(super) room: Option<usize>,
    /// Bytes have come since it was last looked at.
    pub(super) received_bytes: bool,
    /// Its number, once the controller has heard of it.
    pub(super) number: Option<ConnectionNumber>,
    /// Who it is, if somebody has said so.
    pub(super) name: Text,
    /// How long its constant velocities last without another `JOG` (`JTM`); `None`: as long as it lasts itself.
    pub(super) jog_time_ms: Option<f64>,
    /// So many of the next bytes came before a stop that ended what they waited for, and whether the line under way begins with
    /// such a byte: questions are answered, anything else is thrown away.
    late_bytes: usize,
    line_is_late: bool,
    /// Its own stop has ended its own wait.
    pub(super) has_stopped_wait: bool,
    /// The pivots when its position was last asked for.
    pub(super) reported_pivots: Option<[Angle; 3]>,
    /// Command level, `CCL`.
    pub(super) level: u8,
    /// The recording of a macro that its lines belong to.
    pub(super) recording: Option<u32>,
    /// Its lines are those of a macro that runs.
    pub(super) is_macro: bool,
    /// Its own; those of macros are the interpreter's.
    pub(super) variables: Variables,
    /// The tick of the last fault that was reported to this connection.
    pub(super) fault_tick: Option<u64>,
    /// What `MON?` has to tell it.
    pub(super) monitor: Monitor,
    /// How many errors have been reported to this connection; `None` before its first service.
    pub(super) errors_reported: Option<u32>,
}

/// State of the line being gathered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum LineState {
    #[default]
    Gathering,
    /// Its LF has come.
    Complete,
    /// Its rest is thrown away, up to the LF, with this error.
    Skipping(ErrorCode),
}

/// Why the lines of a connection wait. Single bytes act all the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wait {
    pub what: Awaited,
    /// Stops so far when it began: one more ends it.
    pub stops: u32,
}

/// What is waited for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Awaited {
    /// `DEL`: this tick.
    Tick(u64),
    /// `WAC`.
    Condition(Condition),
    /// `FRF`: its end.
    Reference,
    /// `WPA`: its end.
    Stored,
}

/// What comes next in the input.
pub(super) enum InputItem {
    /// A single-byte command.
    Byte(u8),
    /// A line is complete: [`Session::line`].
    Line,
    /// A line has been thrown away.
    Discarded(ErrorCode),
}

/// Stands in the input where bytes are missing. No text has it: on a serial line it is what noise looks like.
const GAP: u8 = 0xFF;

/// Whether a byte is a command by itself, wherever it stands.
pub(super) const fn is_single(byte: u8) -> bool {
    matches!(byte, 3..=9 | 24)
}

impl Session {
    /// A new connection.
    pub fn new() -> Self {
        Self::default()
    }

    /// Says how many bytes of a long answer (`DRR?`) the output takes at the next services without keeping anybody
    /// waiting; any number of them before this is called. Other answers are short and are written whatever the room.
    pub const fn set_room(&mut self, bytes: usize) {
        self.room = Some(bytes);
    }

    /// Says who is at the other end (an address, a device), for those who ask who commands; what is too long is cut off.
    pub fn set_name(&mut self, name: &str) {
        let end = name.len().min(TEXT_BYTES);
        self.name = Text::new(name.as_bytes().get(..end).unwrap_or_default()).unwrap_or(self.name);
    }

    /// Who is at the other end; the number of the connection where nobody has said that.
    pub(super) fn shown_name(&self) -> Text {
        let mut name = self.name;
        if name.as_bytes().is_empty() {
            // No number is too long.
            let _ = write!(name, "connection {}", self.number.unwrap_or(0));
        }
        name
    }

    /// The controller starts again: as a new connection, but what has been received is still to be carried out.
    pub fn start_again(&mut self) {
        *self = Self {
            input: core::mem::take(&mut self.input),
            line: core::mem::take(&mut self.line),
            state: self.state,
            name: self.name,
            ..Self::default()
        };
    }

    /// The connection of a macro.
    pub(super) fn for_macro(starter: &Self) -> Self {
        Self {
            level: starter.level,
            number: starter.number,
            name: starter.name,
            is_macro: true,
            ..Self::default()
        }
    }

    /// Takes bytes as far as there is room and says how many; the rest is to be offered again after a
    /// [`service`](super::Interpreter::service). A line has to be handled before the bytes far behind it can be taken,
    /// so while a `WAC` or `DEL` holds up more than [`LINE_BYTES`] of lines, a stop behind them reaches the stage only
    /// by another connection.
    pub fn receive(&mut self, bytes: &[u8]) -> usize {
        self.received_bytes |= !bytes.is_empty();
        for (taken, &byte) in bytes.iter().enumerate() {
            if self.input.push_back(byte).is_err() {
                return taken;
            }
        }
        bytes.len()
    }

    /// Bytes have been lost behind those received so far. The line that is cut off there, and what comes up to the next
    /// LF, are thrown away with error 304: pieces of two lines must never make up a third.
    pub fn lose(&mut self) {
        if self.input.is_full() {
            self.input.pop_back();
        }
        // There is room now.
        let _ = self.input.push_back(GAP);
    }

    /// Whether everything received has been carried out: no line, whole or begun, no wait and no answer is left.
    pub fn is_idle(&self) -> bool {
        self.input.is_empty()
            && self.line.is_empty()
            && self.wait.is_none()
            && self.readout.is_none()
            && self.fault_record_readout.is_none()
    }

    /// The error that `ERR?` would answer.
    pub const fn error(&self) -> ErrorCode {
        self.error
    }

    /// The next event; a complete line comes again until [`finish_line`](Self::finish_line).
    pub(super) fn next_item(&mut self) -> Option<InputItem> {
        if self.state == LineState::Complete {
            return Some(InputItem::Line);
        }
        while let Some(byte) = self.input.pop_front() {
            let is_late = self.late_bytes > 0;
            self.late_bytes = self.late_bytes.saturating_sub(1);
            if is_single(byte) {
                return Some(InputItem::Byte(byte));
            }
            if byte == GAP {
                self.skip(ErrorCode::ReceiveOverflow);
            } else if byte == b'\n' {
                if let Some(event) = self.end_line() {
                    return Some(event);
                }
            } else if byte != b'\r' && self.state == LineState::Gathering {
                if self.line.is_empty() {
                    self.line_is_late = is_late;
                }
                self.gather(byte);
            }
        }
        None
    }

    /// The complete line.
    pub(super) fn line(&self) -> &[u8] {
        &self.line
    }

    /// Whether the complete line came before a stop that ended what it waited for.
    pub(super) const fn is_line_late(&self) -> bool {
        self.line_is_late
    }

    /// The complete line has been handled.
    pub(super) fn finish_line(&mut self) {
        self.line.clear();
        self.line_is_late = false;
        self.state = LineState::Gathering;
    }

    fn gather(&mut self, byte: u8) {
        if self.line.push(byte).is_err() {
            self.skip(ErrorCode::LineTooLong);
        }
    }

    fn skip(&mut self, error: ErrorCode) {
        self.line.clear();
        self.state = LineState::Skipping(error);
    }

    fn end_line(&mut self) -> Option<InputItem> {
        match self.state {
            LineState::Skipping(error) => {
                self.state = LineState::Gathering;
                (error != ErrorCode::None).then_some(InputItem::Discarded(error))
            }
            _ if self.line.is_empty() => None,
            _ => {
                self.state = LineState::Complete;
                Some(InputItem::Line)
            }
        }
    }

    /// Takes the first single byte out of the input, over the lines before it, which stay. A stop ends the wait, and of the lines
    /// before it only questions are left.
    pub(super) fn take_single(&mut self) -> Option<u8> {
        let before = self.input.iter().position(|&byte| is_single(byte))?;
        self.rotate(before);
        let single = self.input.pop_front()?;
        self.rotate(self.input.len() - before);
        self.late_bytes = self.late_bytes.min(before);
        if single == STOP {
            self.has_stopped_wait = self.wait.take().is_some();
            self.leave_questions(before);
        }
        Some(single)
    }

    /// Moves the next `count` bytes behind the others.
    fn rotate(&mut self, count: usize) {
        for _ in 0..count {
            if let Some(byte) = self.input.pop_front() {
                // There is the room that it has just left.
                let _ = self.input.push_back(byte);
            }
        }
    }

    /// Ends the wait; of what has been received behind it only questions are left.
    pub(super) fn abandon(&mut self) {
        self.wait = None;
        self.leave_questions(self.input.len());
    }

    /// Of the next `count` bytes, and of a line that they begin, only questions are left.
    fn leave_questions(&mut self, count: usize) {
        self.late_bytes = count;
        self.line_is_late = !self.line.is_empty();
    }
}

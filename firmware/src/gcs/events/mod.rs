//! What has happened to the controller: a ring of typed events, each with its tick. `EVT?` tells them, the oldest first; when
//! it is full the oldest goes. They are numbered from 1 on, so that one sees how many have gone.
//!
//! Each is written into the black box too, if there is one, and those from before a reset are found there: they keep their
//! numbers, and the events after the start go on from there.

mod words;

pub use words::CAUSES;

use super::Panel;
use super::output::{Output, WriteFailed};
use super::reply::ReplyWriter;
use crate::fault::Fault;
use crate::fault_record::{BlackBox, EVENTS};
use crate::mode::Mode;
use crate::queues::Snapshot;
use core::fmt;
use heapless::Deque;

/// Something that happened.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Event {
    /// The controller started; by what, if that is worth telling.
    Start(Option<&'static str>),
    Fault(Fault),
    Acknowledged,
    Referenced,
    ReferenceLost,
    ServoOn,
    ServoOff,
    /// A parameter was set.
    ParameterSet(u32, f64),
    /// `STP` or `#24`.
    Stop,
    /// `HLT`
    Halt,
    /// The tick has refused commands: how many.
    Refused(u32),
    /// No host was heard for so many milliseconds.
    HostSilent(f64),
    /// The encoder of a pivot, counted from 0, has begun to warn, or has stopped.
    Warning(u8, bool),
    /// Settings were written to flash.
    Stored,
    /// They could not be: the error's number.
    StoreFailed(u16),
    /// `RPA`
    Recalled,
    /// So many parameters are kept that this firmware does not know.
    UnknownParameters(u16),
}

/// See the module.
pub(super) struct EventLog {
    entries: Deque<(u64, Event), EVENTS>,
    count: u32,
    /// How many of them the black box has; `None` before it was looked at.
    retained: Option<u32>,
    last: Observed,
}

/// What of the latest snapshot can be an event.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Observed {
    fault: Option<Fault>,
    worse: Option<Fault>,
    referenced: bool,
    on: bool,
    refused: u32,
    warnings: [bool; 3],
}

impl EventLog {
    /// The controller has started.
    pub fn new() -> Self {
        let mut events = Self {
            entries: Deque::new(),
            count: 0,
            retained: None,
            last: Observed::default(),
        };
        events.add(0, Event::Start(None));
        events
    }

    /// Tells by what it started.
    pub fn note_start(&mut self, cause: &'static str) {
        if let Some((_, Event::Start(by))) = self.entries.front_mut() {
            *by = Some(cause);
        }
    }

    pub fn add(&mut self, tick: u64, event: Event) {
        if self.entries.is_full() {
            self.entries.pop_front();
        }
        // There is room now.
        let _ = self.entries.push_back((tick, event));
        self.count = self.count.wrapping_add(1);
    }

    /// Writes what is new into the black box; the first time, takes what is in it from before.
    pub fn retain(&mut self, black_box: &BlackBox) {
        let retained = match self.retained {
            Some(retained) => retained,
            None => self.recall(black_box),
        };
        let first = self.count - self.entries.len() as u32;
        let events = (first.wrapping_add(1)..).zip(&self.entries);
        for (number, (tick, event)) in events.filter(|(number, _)| *number > retained) {
            black_box
                .events
                .write(number, &words::words(number, *tick, event));
        }
        self.retained = Some(self.count);
    }

    /// Puts events from before the start in front of those since; the number of the last of them.
    fn recall(&mut self, black_box: &BlackBox) -> u32 {
        let since = core::mem::take(&mut self.entries);
        let read = |number: u32| {
            let words = black_box.events.read(number)?;
            Some((words[0], words::event(&words)?))
        };
        let last = (0..EVENTS as u32)
            .filter_map(read)
            .map(|(number, _)| number)
            .max();
        let last = last.unwrap_or(0);
        let first = last.saturating_sub(EVENTS as u32 - 1).max(1);
        self.count = first - 1;
        for number in first..=last {
            match read(number) {
                Some((found, (tick, event))) if found == number => self.add(tick, event),
                // Numbers tell places: what is left out must be behind all that is told.
                _ => {
                    self.entries.clear();
                    self.count = number;
                }
            }
        }
        for (tick, event) in &since {
            self.add(*tick, *event);
        }
        last
    }

    /// Finds out what has happened up to a snapshot.
    pub fn update(&mut self, snapshot: &Snapshot) {
        let now = Observed {
            fault: snapshot.fault,
            worse: snapshot.worse,
            referenced: snapshot.referenced,
            on: matches!(snapshot.mode, Mode::Holding | Mode::Moving),
            refused: snapshot.refused,
            warnings: snapshot.encoder_warnings,
        };
        let last = core::mem::replace(&mut self.last, now);
        let tick = snapshot.tick;
        let refused = now.refused.wrapping_sub(last.refused);
        let happened = [
            (refused != 0).then_some(Event::Refused(refused)),
            (last.fault.is_some() && now.fault.is_none()).then_some(Event::Acknowledged),
            (now.referenced && !last.referenced).then_some(Event::Referenced),
            (!now.referenced && last.referenced).then_some(Event::ReferenceLost),
            (now.on && !last.on).then_some(Event::ServoOn),
            // A fault says so itself.
            (!now.on && last.on && now.fault.is_none()).then_some(Event::ServoOff),
        ];
        for event in happened.into_iter().flatten() {
            self.add(tick, event);
        }
        for (pivot, (warns, warned)) in (0..).zip(now.warnings.iter().zip(last.warnings)) {
            if *warns != warned {
                self.add(tick, Event::Warning(pivot, *warns));
            }
        }
        for (now, last) in [(now.fault, last.fault), (now.worse, last.worse)] {
            if let Some(fault) = now.filter(|_| now != last) {
                self.add(fault.tick, Event::Fault(fault));
            }
        }
    }
}

impl fmt::Display for Event {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Start(None) => f.write_str("start"),
            Self::Start(Some(cause)) => write!(f, "start by {cause}"),
            Self::Fault(fault) => write!(f, "fault: {fault}"),
            Self::Acknowledged => f.write_str("fault acknowledged"),
            Self::Referenced => f.write_str("referenced"),
            Self::ReferenceLost => f.write_str("reference lost"),
            Self::ServoOn => f.write_str("servo on"),
            Self::ServoOff => f.write_str("servo off"),
            Self::ParameterSet(id, value) => write!(f, "parameter 0x{id:X} set to {value}"),
            Self::Stop => f.write_str("stopped by command"),
            Self::Halt => f.write_str("halted by command"),
            Self::Refused(count) => write!(f, "{count} commands refused by the loop"),
            Self::Warning(pivot, true) => write!(f, "encoder warns, pivot {}", pivot + 1),
            Self::Warning(pivot, false) => write!(f, "encoder warns no more, pivot {}", pivot + 1),
            Self::HostSilent(ms) => write!(f, "stopped: no host heard for {ms} ms"),
            Self::Stored => f.write_str("settings kept"),
            Self::StoreFailed(number) => {
                write!(f, "settings could not be kept, error {number}")
            }
            Self::Recalled => f.write_str("parameters as they are kept"),
            Self::UnknownParameters(count) => {
                write!(f, "{count} kept parameters are unknown here and ignored")
            }
        }
    }
}

impl Panel {
    /// Answers `EVT?`: number, tick and what has happened.
    pub(super) fn reply_events(&self, out: &mut Output<'_>) -> Result<(), WriteFailed> {
        let mut reply = ReplyWriter::new(out);
        let gone = self.events.count - self.events.entries.len() as u32;
        for (number, (tick, event)) in (gone + 1..).zip(&self.events.entries) {
            reply.line(format_args!("{number} {tick} {event}"))?;
        }
        reply.end()
    }
}

//! The latest events.

use super::encoding::{event, words};
use super::event::Event;
use crate::fault::Fault;
use crate::fault_record::{RETAINED_EVENTS, RetainedMemory};
use crate::mode::Mode;
use crate::queues::Snapshot;
use heapless::Deque;

/// What has happened: the latest events, and how many there were.
pub(in crate::gcs) struct EventLog {
    pub(super) entries: Deque<(u64, Event), RETAINED_EVENTS>,
    /// How many there were.
    pub(super) count: u32,
    /// How many of them the retained memory has; `None` before it was looked at.
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

    /// By what the controller started.
    pub fn set_start_cause(&mut self, cause: &'static str) {
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

    /// Writes what is new into the retained memory; the first time, takes what is in it from before.
    pub fn retain(&mut self, retained_memory: &RetainedMemory) {
        let retained = match self.retained {
            Some(retained) => retained,
            None => self.recall(retained_memory),
        };
        let first = self.count - self.entries.len() as u32;
        let events = (first.wrapping_add(1)..).zip(&self.entries);
        for (number, (tick, event)) in events.filter(|(number, _)| *number > retained) {
            retained_memory
                .events
                .write(number, &words(number, *tick, event));
        }
        self.retained = Some(self.count);
    }

    /// Puts events from before the start in front of those since; the number of the last of them.
    fn recall(&mut self, retained_memory: &RetainedMemory) -> u32 {
        let since = core::mem::take(&mut self.entries);
        let read = |number: u32| {
            let words = retained_memory.events.read(number)?;
            Some((words[0], event(&words)?))
        };
        let last = (0..RETAINED_EVENTS as u32)
            .filter_map(read)
            .map(|(number, _)| number)
            .max();
        let last = last.unwrap_or(0);
        let first = last.saturating_sub(RETAINED_EVENTS as u32 - 1).max(1);
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
            worse: snapshot.stop_ended_by,
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

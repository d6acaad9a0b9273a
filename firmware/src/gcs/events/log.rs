//! The latest events.

use super::encoding::{event, words};
use super::event::Event;
use crate::control::units::UNITS_PER_RAD;
use crate::fault::Fault;
use crate::fault_record::{RETAINED_EVENTS, RETAINED_FAULTS, RetainedMemory};
use crate::mode::Mode;
use crate::queues::Snapshot;
use heapless::Deque;

/// What has happened: the latest events, and how many there were.
pub(in crate::gcs) struct EventLog {
    pub(super) entries: Deque<(u64, Event), RETAINED_EVENTS>,
    /// The latest faults, with their numbers: nothing else takes their places.
    pub(super) faults: Deque<(u32, u64, Event), RETAINED_FAULTS>,
    /// They are not in the retained memory yet.
    faults_changed: bool,
    /// How many there were.
    pub(super) count: u32,
    /// How many of them the retained memory has; `None` before it was looked at.
    retained: Option<u32>,
    last: Observed,
    encoders: [EncoderTold; 3],
}

/// Bridged frames and steps of an encoder as they were told last, and the lower half of the tick of that.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct EncoderTold {
    bridged: u16,
    slipped: i32,
    tick: u32,
}

/// Bridged frames that are worth an event: more than a single disturbance makes.
const BRIDGED_FRAMES: u16 = 12;
/// Ticks from one event of an encoder's line to the next, 10 s.
const AGAIN_TICKS: u32 = 200_000;

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
            faults: Deque::new(),
            faults_changed: false,
            count: 0,
            retained: None,
            last: Observed::default(),
            encoders: [EncoderTold::default(); 3],
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

    /// A stop; one that found nothing to stop is left out where the event before is the same.
    pub fn add_stop(&mut self, tick: u64, stop: Event, has_stopped: bool) {
        if has_stopped {
            self.add(tick, stop);
        } else {
            self.add_once(tick, stop);
        }
    }

    /// Adds it unless the event before is the same.
    pub fn add_once(&mut self, tick: u64, event: Event) {
        if self.entries.back().map(|(_, last)| last) != Some(&event) {
            self.add(tick, event);
        }
    }

    pub fn add(&mut self, tick: u64, event: Event) {
        if matches!(event, Event::Fault(_)) {
            self.add_fault(tick, event);
        }
        if self.entries.is_full() {
            self.entries.pop_front();
        }
        // There is room now.
        let _ = self.entries.push_back((tick, event));
        self.count = self.count.wrapping_add(1);
    }

    fn add_fault(&mut self, tick: u64, event: Event) {
        let number = self.count.wrapping_add(1);
        // Recalled from before the start, where the events come again one by one.
        if self.faults.iter().any(|(known, ..)| *known == number) {
            return;
        }
        if self.faults.is_full() {
            self.faults.pop_front();
        }
        // There is room now.
        let _ = self.faults.push_back((number, tick, event));
        self.faults_changed = true;
    }

    /// Faults that are older than all other events that are known, with their numbers.
    pub fn older_faults(&self) -> impl Iterator<Item = &(u32, u64, Event)> {
        let first = self.count - self.entries.len() as u32 + 1;
        self.faults
            .iter()
            .filter(move |(number, ..)| *number < first)
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
        if core::mem::take(&mut self.faults_changed) {
            for (place, (number, tick, event)) in (0..).zip(&self.faults) {
                let words = words(*number, *tick, event);
                retained_memory.faults.write(place, &words);
            }
        }
    }

    /// Puts events from before the start in front of those since; the number of the last of them.
    fn recall(&mut self, retained_memory: &RetainedMemory) -> u32 {
        let since = core::mem::take(&mut self.entries);
        self.recall_faults(retained_memory);
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

    /// Takes the faults from before the start, the latest of which are among the events too and come again with them.
    fn recall_faults(&mut self, retained_memory: &RetainedMemory) {
        self.faults.clear();
        for place in 0..RETAINED_FAULTS as u32 {
            let words = retained_memory.faults.read(place);
            let fault = words.and_then(|words| Some((words[0], event(&words)?)));
            if let Some((number, (tick, event))) = fault {
                // There are as many places as faults.
                let _ = self.faults.push_back((number, tick, event));
            }
        }
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
        for pivot in 0..3 {
            self.update_encoder(snapshot, pivot);
        }
        for (now, last) in [(now.fault, last.fault), (now.worse, last.worse)] {
            if let Some(fault) = now.filter(|_| now != last) {
                self.add(fault.tick, Event::Fault(fault));
            }
        }
    }

    /// What its line has come to since it was told last.
    fn update_encoder(&mut self, snapshot: &Snapshot, pivot: usize) {
        let tick = snapshot.tick;
        let now = tick as u32;
        let told = &mut self.encoders[pivot];
        if (told.bridged, told.slipped) == (snapshot.bridged_frames[pivot], snapshot.slipped[pivot])
        {
            return;
        }
        let may_tell = told.tick == 0 || now.wrapping_sub(told.tick) >= AGAIN_TICKS;
        let bridged = snapshot.bridged_frames[pivot].wrapping_sub(told.bridged);
        let slipped = snapshot.slipped[pivot].wrapping_sub(told.slipped);
        let tells_bridged = may_tell && bridged >= BRIDGED_FRAMES;
        let tells_slipped = may_tell && slipped != 0;
        if tells_bridged {
            (told.bridged, told.tick) = (snapshot.bridged_frames[pivot], now);
        }
        if tells_slipped {
            (told.slipped, told.tick) = (snapshot.slipped[pivot], now);
        }
        if tells_bridged {
            self.add(tick, Event::FramesBridged(pivot as u8, bridged));
        }
        if tells_slipped {
            let step_rad = (f64::from(slipped) / UNITS_PER_RAD) as f32;
            self.add(tick, Event::EncoderStepped(pivot as u8, step_rad));
        }
    }
}

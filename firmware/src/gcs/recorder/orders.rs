//! From tables and triggers to an order, and the commands that trigger.
//!
//! A command that moves has to be the first that the tick sees of its record. So the tick is told before the command is
//! sent that its count of commands will be the trigger, and the order is taken back when the command is refused:
//! nothing of the record before has been touched by then, unless rows before the trigger were being kept anyway.

use super::channel::words;
use super::scales::Scales;
use super::state::{PendingOrder, Record, RecorderState};
use super::trigger::Trigger;
use crate::gcs::error::ErrorCode;
use crate::parameters::Parameters;
use crate::recorder::{LevelTrigger, Progress, RecordSetup, RecorderReader};

/// What a command that moves has been announced as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::gcs) enum Announced {
    /// Nothing waits for it.
    Nothing,
    /// The trigger of the record that waits.
    Trigger,
    /// The trigger of a record of its own.
    Record,
}

impl RecorderState {
    /// Orders what is wanted, as far as there is room in the queue; later calls go on.
    pub fn send_pending_order(
        &mut self,
        parameters: &Parameters,
        recorder: &mut RecorderReader<'_>,
    ) {
        let done = match self.pending_order {
            PendingOrder::Nothing => return,
            PendingOrder::Stop => {
                self.stopped = true;
                recorder.stop().is_ok()
            }
            PendingOrder::Record => self.order(self.triggered(parameters), parameters, recorder),
        };
        if done {
            self.pending_order = PendingOrder::Nothing;
        }
    }

    /// A record that waits for its trigger is ordered anew, so that a change counts for it too.
    pub fn rearm(&mut self, recorder: &RecorderReader<'_>) {
        if self.is_waiting(recorder) {
            let recorded = self.tables.iter().any(|table| table.channel.is_some());
            self.pending_order = if recorded {
                PendingOrder::Record
            } else {
                PendingOrder::Stop
            };
        }
    }

    /// Rows of the record that was ordered last.
    pub(super) fn progress(&self, recorder: &RecorderReader<'_>) -> Progress {
        let number = self.record.as_ref().map(|record| record.setup.number);
        match (self.pending_order, number) {
            (PendingOrder::Record, _) | (_, None) => Progress::default(),
            (_, Some(number)) => recorder.progress(number),
        }
    }

    /// Whether a record waits for its trigger.
    pub(super) fn is_waiting(&self, recorder: &RecorderReader<'_>) -> bool {
        let armed = self.record.is_some() && !self.stopped;
        match self.pending_order {
            PendingOrder::Record => true,
            PendingOrder::Stop => false,
            PendingOrder::Nothing => armed && self.progress(recorder).rows == 0,
        }
    }

    /// Before a command that moves is sent as the tick's command number `commands`; `step` is `STE`, which is recorded
    /// whatever the triggers say.
    ///
    /// # Errors
    /// Of `STE`: [`ErrorCode::TableOff`] when nothing is to be recorded, [`ErrorCode::Busy`] when the tick can not be
    /// told.
    pub fn announce(
        &mut self,
        step: bool,
        commands: u32,
        parameters: &Parameters,
        recorder: &mut RecorderReader<'_>,
    ) -> Result<Announced, ErrorCode> {
        if step && self.channels().iter().all(Option::is_none) {
            return Err(ErrorCode::TableOff);
        }
        self.send_pending_order(parameters, recorder);
        let every = self.has(|trigger| trigger == Trigger::EveryMove);
        let complete = (self.record.as_ref())
            .is_some_and(|record| self.progress(recorder).rows == record.setup.rows);
        if step || (every && complete) {
            let setup = RecordSetup {
                commands: Some(commands),
                ..self.plain(parameters)
            };
            let ordered = self.order(setup, parameters, recorder);
            return match (ordered, step) {
                (true, _) => Ok(Announced::Record),
                (false, true) => Err(ErrorCode::Busy),
                (false, false) => Ok(Announced::Nothing),
            };
        }
        let waits = self.is_waiting(recorder) && self.has(Trigger::is_by_command);
        if waits && recorder.trigger_at(Some(commands)).is_ok() {
            return Ok(Announced::Trigger);
        }
        Ok(Announced::Nothing)
    }

    /// The command has been refused: what it was announced as is taken back.
    pub fn revoke(&mut self, announced: Announced, recorder: &mut RecorderReader<'_>) {
        match announced {
            Announced::Nothing => {}
            // There is room: the announcement was the last, and at most the second, order in the queue.
            Announced::Trigger => {
                let _ = recorder.trigger_at(None);
            }
            Announced::Record => {
                let _ = recorder.stop();
                self.record = self.before.take();
            }
        }
    }

    /// The command has been accepted; `sent` is the number of the last one that was sent, when it needed none of its
    /// own.
    pub fn confirm(
        &mut self,
        announced: Announced,
        sent: Option<u32>,
        recorder: &mut RecorderReader<'_>,
    ) {
        if announced == Announced::Nothing {
            return;
        }
        if sent.is_some() {
            let _ = recorder.trigger_at(sent);
        }
        for table in &mut self.tables {
            if announced == Announced::Trigger && table.trigger == Trigger::NextMove {
                table.trigger = Trigger::Never;
            }
        }
    }

    fn has(&self, wanted: impl Fn(Trigger) -> bool) -> bool {
        self.tables.iter().any(|table| wanted(table.trigger))
    }

    fn order(
        &mut self,
        setup: RecordSetup,
        parameters: &Parameters,
        recorder: &mut RecorderReader<'_>,
    ) -> bool {
        let ordered = recorder.start(&setup).is_ok();
        if ordered {
            let record = Record {
                setup,
                channels: self.channels(),
                scales: Scales::new(parameters),
            };
            self.before = self.record.replace(record);
            self.stopped = false;
        }
        ordered
    }

    /// The tables' record, without a trigger.
    fn plain(&self, parameters: &Parameters) -> RecordSetup {
        let last = self.record.as_ref().map_or(0, |record| record.setup.number);
        RecordSetup {
            number: last.wrapping_add(1),
            signals: words(&self.channels()),
            every: self.every,
            rows: parameters.recorder.points,
            ..RecordSetup::default()
        }
    }

    /// The tables' record, with their triggers.
    fn triggered(&self, parameters: &Parameters) -> RecordSetup {
        let mut setup = RecordSetup {
            before: parameters.recorder.before,
            now: self.has(|trigger| trigger == Trigger::Now),
            fault: self.has(|trigger| trigger == Trigger::Fault),
            ..self.plain(parameters)
        };
        let scales = Scales::new(parameters);
        for table in &self.tables {
            if let Trigger::Crosses { value, rising } = table.trigger
                && let Some(word) = table.channel.and_then(|channel| channel.trigger_word())
            {
                // As many fit as there are tables.
                let watch = LevelTrigger::new(word, value / scales.factor(word), rising);
                let _ = setup.level_triggers.push(watch);
            }
        }
        setup
    }
}

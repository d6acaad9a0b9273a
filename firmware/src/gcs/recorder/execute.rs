//! What the lines about the recorder do.

use super::channel::Channel;
use super::request::RecordAction;
use super::state::{PendingOrder, RecorderState};
use super::trigger::Trigger;
use crate::gcs::error::ErrorCode;
use crate::parameters::Parameters;
use crate::recorder::{MAX_ROW_PERIOD_TICKS, RECORDER_TABLES, RecorderReader};

impl RecorderState {
    /// Carries out a change; an error means that nothing has changed. Points that fit no longer are fewer then.
    pub fn change(
        &mut self,
        action: &RecordAction,
        parameters: &mut Parameters,
        recorder: &RecorderReader<'_>,
    ) -> Result<(), ErrorCode> {
        match action {
            RecordAction::Channels(changes) => {
                for &(table, channel) in changes.iter().flatten() {
                    self.set_channel(usize::from(table), channel);
                }
                let tuning = &mut parameters.recorder;
                tuning.points = tuning.points.min(self.most_rows(recorder.capacity()));
                tuning.before = tuning.before.min(tuning.points - 1);
                self.rearm(recorder);
            }
            RecordAction::Triggers(changes) => self.set_triggers(changes, recorder)?,
            RecordAction::Rate(ticks) => {
                if !(1.0..=f64::from(MAX_ROW_PERIOD_TICKS)).contains(ticks)
                    || libm::trunc(*ticks) != *ticks
                {
                    return Err(ErrorCode::OutOfRange);
                }
                self.every = *ticks as u32;
                self.rearm(recorder);
            }
        }
        Ok(())
    }

    /// A level that triggers is one of the signal that was there: it goes with it.
    fn set_channel(&mut self, table: usize, channel: Option<Channel>) {
        let table = &mut self.tables[table];
        if table.channel != channel && matches!(table.trigger, Trigger::Crosses { .. }) {
            table.trigger = Trigger::Never;
        }
        table.channel = channel;
    }

    fn set_triggers(
        &mut self,
        changes: &[Option<(u8, Trigger)>; RECORDER_TABLES],
        recorder: &RecorderReader<'_>,
    ) -> Result<(), ErrorCode> {
        let mut tables = self.tables;
        for &(table, trigger) in changes.iter().flatten() {
            let table = &mut tables[usize::from(table)];
            if matches!(trigger, Trigger::Crosses { .. }) {
                let channel = table.channel.ok_or(ErrorCode::TableOff)?;
                channel.trigger_word().ok_or(ErrorCode::OutOfRange)?;
            }
            table.trigger = trigger;
        }
        let armed = tables.iter().any(|table| table.trigger != Trigger::Never);
        if armed && tables.iter().all(|table| table.channel.is_none()) {
            return Err(ErrorCode::TableOff);
        }
        self.tables = tables;
        if armed {
            self.pending_order = PendingOrder::Record;
        } else if self.is_waiting(recorder) {
            self.pending_order = PendingOrder::Stop;
        }
        Ok(())
    }
}

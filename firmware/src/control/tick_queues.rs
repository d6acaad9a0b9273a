//! The tick's ends of the queues to the command side, and of the recorders.

use super::command::Command;
use super::snapshot::{SNAPSHOT_SLOTS, Snapshot};
use crate::fault_record::FaultRecordWriter;
use crate::iterative_learning::TrialTable;
use crate::recorder::RecorderWriter;
use heapless::spsc::{Consumer, Producer};

/// The tick's ends.
pub struct TickQueues<'a> {
    /// Commands to take.
    pub commands: Consumer<'a, Command>,
    /// Where snapshots are sent.
    pub snapshots: Producer<'a, Snapshot>,
    /// The data recorder's end in the tick.
    pub recorder: RecorderWriter<'a>,
    /// The table of a move that is repeated.
    pub trial: TrialTable<'a>,
    /// The fault record's end in the tick, where there is memory for one.
    pub fault_record: Option<FaultRecordWriter<'a>>,
}

impl TickQueues<'_> {
    /// Whether there is room for a snapshot.
    // The queue carries its number of slots with it. Comparing it spares the tick a division by what, for all the
    // compiler knows, could be zero, and the panic behind that.
    #[inline]
    pub fn has_snapshot_room(&self) -> bool {
        self.snapshots.capacity() == SNAPSHOT_SLOTS - 1 && self.snapshots.ready()
    }

    /// Throws away the commands that wait: the controller starts again.
    pub fn clear(&mut self) {
        while self.commands.dequeue().is_some() {}
        if let Some(fault_record) = &mut self.fault_record {
            fault_record.restart();
        }
    }
}

//! The tick's ends of the queues to the command side, and what observes it.

use super::command::Command;
use super::observers::TickObservers;
use super::snapshot::{SNAPSHOT_SLOTS, Snapshot};
use crate::iterative_learning::TrialTable;
use crate::motion::PlanReceiver;
use heapless::spsc::{Consumer, Producer};

/// The tick's ends.
pub struct TickQueues<'a> {
    /// Commands to take.
    pub commands: Consumer<'a, Command>,
    /// Where the plans lie that they hand over.
    pub plans: PlanReceiver<'a>,
    /// Where snapshots are sent.
    pub snapshots: Producer<'a, Snapshot>,
    /// The table of a move that is repeated.
    pub trial: TrialTable<'a>,
    /// The recorders' ends. Whoever hands them the samples later, to spare the tick the time, takes them out.
    pub observers: Option<TickObservers<'a>>,
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
        self.plans.restart();
        let observers = self.observers.as_mut();
        if let Some(fault_record) = observers.and_then(|it| it.fault_record.as_mut()) {
            fault_record.restart();
        }
    }
}

//! Between the tick and the command side: bounded lock-free queues, commands one way and snapshots the other, and the slots that plans
//! are written to.
//!
//! The tick never waits for either: it takes at most one command a tick, and leaves a snapshot only when there is room
//! for one, every fourth tick or when mode or commands have changed, and not when it took a command: that tick is the
//! longest as it is. What goes through is defined in [`crate::control`], which is at the other end.

pub use crate::control::{Command, Snapshot, TickQueues};
pub use crate::recorder::QueueFull;

use crate::control::{SNAPSHOT_SLOTS, TickObservers};
use crate::fault_record::RetainedMemory;
use crate::iterative_learning::{TrialControl, TrialMemory};
use crate::motion::{Plan, PlanSender, PlanSlots};
use crate::recorder::{RECORDER_WORDS, Recorder, RecorderReader};
use heapless::spsc::{Consumer, Producer, Queue};

/// Slots of the command queue (one is lost to the ring).
pub const COMMAND_SLOTS: usize = 2;

/// Storage of both queues, of the data recorder, and of a trial of iterative learning.
pub struct Queues {
    commands: Queue<Command, COMMAND_SLOTS>,
    plans: PlanSlots,
    snapshots: Queue<Snapshot, SNAPSHOT_SLOTS>,
    recorder: Recorder<RECORDER_WORDS>,
    trial: TrialMemory,
}

/// The command side's ends.
pub struct CommandQueues<'a> {
    commands: Producer<'a, Command>,
    plans: PlanSender<'a>,
    snapshots: Consumer<'a, Snapshot>,
    /// The data recorder's end outside the tick.
    pub recorder: RecorderReader<'a>,
    /// The end outside of the tick of a trial of iterative learning.
    pub trial: TrialControl<'a>,
    /// The memory that outlasts a reset, if there is one.
    pub retained_memory: Option<&'a RetainedMemory>,
}

#[allow(clippy::new_without_default)] // A default of 100 KB is nothing to be made in passing.
impl Queues {
    /// Empty queues.
    pub const fn new() -> Self {
        Self {
            commands: Queue::new(),
            plans: PlanSlots::new(),
            snapshots: Queue::new(),
            recorder: Recorder::new(),
            trial: TrialMemory::new(),
        }
    }

    /// The two sides, without retained memory.
    pub fn split(&mut self) -> (TickQueues<'_>, CommandQueues<'_>) {
        self.split_with(None)
    }

    /// The two sides, with retained memory, in which a start is counted.
    pub fn split_with_retained<'a>(
        &'a mut self,
        retained_memory: &'a RetainedMemory,
    ) -> (TickQueues<'a>, CommandQueues<'a>) {
        self.split_with(Some(retained_memory))
    }

    fn split_with<'a>(
        &'a mut self,
        retained_memory: Option<&'a RetainedMemory>,
    ) -> (TickQueues<'a>, CommandQueues<'a>) {
        let (command_in, command_out) = self.commands.split();
        let (plan_sender, plan_receiver) = self.plans.split();
        let (snapshot_in, snapshot_out) = self.snapshots.split();
        let (recorder_writer, recorder_reader) = self.recorder.split();
        let (trial_control, trial_table) = self.trial.split();
        (
            TickQueues {
                commands: command_out,
                plans: plan_receiver,
                snapshots: snapshot_in,
                trial: trial_table,
                observers: Some(TickObservers {
                    recorder: recorder_writer,
                    fault_record: retained_memory.map(RetainedMemory::begin),
                }),
            },
            CommandQueues {
                commands: command_in,
                plans: plan_sender,
                snapshots: snapshot_out,
                recorder: recorder_reader,
                trial: trial_control,
                retained_memory,
            },
        )
    }
}

impl CommandQueues<'_> {
    /// Throws away the snapshots that wait: the controller starts again.
    pub fn clear(&mut self) {
        self.trial.cancel();
        self.trial.hold_model(false);
        while self.snapshots.dequeue().is_some() {}
    }

    /// Queues a command.
    pub fn send(&mut self, command: Command) -> Result<(), QueueFull> {
        self.commands.enqueue(command).map_err(|_| QueueFull)
    }

    /// Hands a plan over, and queues the command to move by it. One at a time: until it is taken or refused there is no room for
    /// another.
    pub fn send_plan(&mut self, plan: &Plan) -> Result<(), QueueFull> {
        if !self.commands.ready() {
            return Err(QueueFull);
        }
        let command = self.hand_over(plan)?;
        self.send(command)
    }

    /// Hands a plan over. The command to move by it is to be sent.
    pub fn hand_over(&mut self, plan: &Plan) -> Result<Command, QueueFull> {
        self.plans
            .hand_over(plan)
            .map(Command::Move)
            .ok_or(QueueFull)
    }

    /// The oldest snapshot waiting, if any. The tick refills the slot within four; a caller that wants the present
    /// and not the past empties the slot first and comes back.
    pub fn snapshot(&mut self) -> Option<Snapshot> {
        self.snapshots.dequeue()
    }
}

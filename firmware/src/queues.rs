//! Between the tick and the command side: bounded lock-free queues, commands one way and snapshots the other.
//!
//! The tick never waits for either: it takes at most one command a tick, and leaves a snapshot only when there is room
//! for one, every fourth tick or when there is news, and not when it took a command: that tick is the longest as it is.
//! [`CommandQueues::snapshot`] throws away a snapshot that has been waiting, so that what it returns is new.

use crate::control::config::Config;
use crate::control::loop_counters::LoopCounters;
use crate::drivers::bridge::Duty;
use crate::fault::Fault;
use crate::fault_record::{FaultRecordWriter, RetainedMemory};
use crate::mode::Mode;
use crate::motion::{Plan, Position, RotationCentre};
use crate::recorder::{RECORDER_WORDS, Recorder, RecorderReader, RecorderWriter};
use heapless::spsc::{Consumer, Producer, Queue};
use kinematics::Angle;

/// Slots of the command queue (one is lost to the ring).
pub const COMMAND_SLOTS: usize = 5;
/// Slots of the snapshot queue: one snapshot waiting.
pub const SNAPSHOT_SLOTS: usize = 2;

/// What the command side asks of the tick.
#[derive(Clone, Debug, PartialEq)]
// A plan is by far the largest command and the most frequent; there is no heap to box it in.
#[allow(clippy::large_enum_variant)]
pub enum Command {
    /// Take theta and the pivots' turns from the absolute encoders and hold the pose found there.
    Reference,
    /// Hold the measured pose, or switch the drives off (the stage coasts).
    Servo(bool),
    /// Execute a plan. Refused by the tick (and counted) when its start is no longer where the motion is.
    Move(Plan),
    /// Move another point of the platform from now on, and turn about it. Refused unless the stage is at rest, held or not;
    /// the platform does not move.
    Centre(RotationCentre),
    /// Compute with these constants from now on. Refused in motion, and with the servo on where it changes what the encoders'
    /// readings mean; such a change takes the reference.
    Configure(Config),
    /// Acknowledge the latched fault.
    Acknowledge,
}

// Constants are copied in the tick that takes them, as a plan is: no larger one, so no longer a tick.
const _: () = assert!(size_of::<Config>() <= size_of::<Plan>());

/// What is known at a tick.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Snapshot {
    /// The tick, counted from start.
    pub tick: u64,
    /// State of the supervisor.
    pub mode: Mode,
    /// The latched fault.
    pub fault: Option<Fault>,
    /// The fault that has ended its controlled stop, if one has.
    pub stop_ended_by: Option<Fault>,
    /// Whether theta and the turns are known.
    pub referenced: bool,
    /// Whether all three encoders answer well, and, for those that do not, why (index: pivot).
    pub encoder_faults: [Option<crate::fault::FaultKind>; 3],
    /// Whether an encoder warns.
    pub encoder_warnings: [bool; 3],
    /// Measured pivot angles; valid once referenced.
    pub pivots: [Angle; 3],
    /// Measured minus setpoint of each pivot, 2^-32 turns; 0 while the servo is off.
    pub pivot_errors: [i32; 3],
    /// Duties.
    pub duty: [Duty; 3],
    /// Setpoint of the point that is moved.
    pub setpoint: Position,
    /// That point.
    pub centre: RotationCentre,
    /// Identity of the plan under way, or of the last one.
    pub plan: u32,
    /// Ticks of it that are done.
    pub plan_tick: u64,
    /// Settled: at rest, and every pivot within the window for the dwell time.
    pub settled: bool,
    /// Commands taken so far, refused ones included.
    pub commands: u32,
    /// Plans refused by the tick so far.
    pub refused: u32,
    /// Largest following error of a pivot since the last start of a motion, rad.
    pub peak_following_error_rad: f32,
    /// What the loop has counted since the snapshot before.
    pub loop_counters: LoopCounters,
}

/// Storage of both queues, and of the data recorder.
pub struct Queues {
    commands: Queue<Command, COMMAND_SLOTS>,
    snapshots: Queue<Snapshot, SNAPSHOT_SLOTS>,
    recorder: Recorder<RECORDER_WORDS>,
}

/// The tick's ends.
pub struct TickQueues<'a> {
    /// Commands to take.
    pub commands: Consumer<'a, Command>,
    /// Where snapshots are left.
    pub snapshots: Producer<'a, Snapshot>,
    /// The data recorder's end in the tick.
    pub recorder: RecorderWriter<'a>,
    /// The fault record's, where there is memory for one.
    pub fault_record: Option<FaultRecordWriter<'a>>,
}

/// The command side's ends.
pub struct CommandQueues<'a> {
    commands: Producer<'a, Command>,
    snapshots: Consumer<'a, Snapshot>,
    /// The data recorder's end outside the tick.
    pub recorder: RecorderReader<'a>,
    /// The black box, if there is one.
    pub retained_memory: Option<&'a RetainedMemory>,
}

/// The command queue is full: nothing was queued.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct QueueFull;

#[allow(clippy::new_without_default)] // A default of 100 KB is nothing to be made in passing.
impl Queues {
    /// Empty queues.
    pub const fn new() -> Self {
        Self {
            commands: Queue::new(),
            snapshots: Queue::new(),
            recorder: Recorder::new(),
        }
    }

    /// The two sides, without a black box.
    pub fn split(&mut self) -> (TickQueues<'_>, CommandQueues<'_>) {
        self.split_with(None)
    }

    /// The two sides, with this black box, in which a start is noted.
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
        let (snapshot_in, snapshot_out) = self.snapshots.split();
        let (tick_recorder, panel_recorder) = self.recorder.split();
        (
            TickQueues {
                commands: command_out,
                snapshots: snapshot_in,
                recorder: tick_recorder,
                fault_record: retained_memory.map(RetainedMemory::begin),
            },
            CommandQueues {
                commands: command_in,
                snapshots: snapshot_out,
                recorder: panel_recorder,
                retained_memory: retained_memory,
            },
        )
    }
}

impl TickQueues<'_> {
    /// Whether there is room for a snapshot.
    // The queue carries its number of slots with it. To be told it spares the tick a division by what, for all the compiler
    // knows, could be zero, and the panic behind that.
    #[inline]
    pub fn has_snapshot_room(&self) -> bool {
        self.snapshots.capacity() == SNAPSHOT_SLOTS - 1 && self.snapshots.ready()
    }

    /// Throws away the commands that wait: the controller starts again.
    pub fn clear(&mut self) {
        while self.commands.dequeue().is_some() {}
        if let Some(history) = &mut self.fault_record {
            history.restart();
        }
    }
}

impl CommandQueues<'_> {
    /// Throws away the snapshots that wait: the controller starts again.
    pub fn clear(&mut self) {
        while self.snapshots.dequeue().is_some() {}
    }

    /// Queues a command.
    pub fn send(&mut self, command: Command) -> Result<(), QueueFull> {
        self.commands.enqueue(command).map_err(|_| QueueFull)
    }

    /// The oldest snapshot waiting, if any. The tick refills the slot within four; a caller that wants the present
    /// and not the past empties the slot first and comes back.
    pub fn snapshot(&mut self) -> Option<Snapshot> {
        self.snapshots.dequeue()
    }
}

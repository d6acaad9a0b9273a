//! Between the tick and the command side: bounded lock-free queues, commands one way and snapshots the other.
//!
//! The tick never waits for either: it takes at most one command a tick, and leaves a snapshot only when there is room
//! for one and it took no command: that tick is the longest as it is. [`PanelLink::snapshot`] throws away a snapshot that
//! has been waiting, so that what it returns is new.

use crate::fault::Fault;
use crate::motion::{Plan, Position};
use heapless::spsc::{Consumer, Producer, Queue};
use kinematics::Angle;

/// Slots of the command queue (one is lost to the ring).
pub const COMMANDS: usize = 5;
/// Slots of the snapshot queue: one snapshot waiting.
pub const SNAPSHOTS: usize = 2;

/// What the command side asks of the tick.
#[derive(Clone, Debug, PartialEq)]
// A plan is by far the largest command and the most frequent; there is no heap to box it in.
#[allow(clippy::large_enum_variant)]
pub enum Command {
    /// Take theta and the pivots' turns from the absolute encoders and hold the pose found there.
    Reference,
    /// Hold the measured pose, or let go (the bridges brake).
    Servo(bool),
    /// Execute a plan. Refused by the tick (and counted) when its start is no longer where the motion is.
    Move(Plan),
    /// Acknowledge the latched fault.
    Acknowledge,
}

/// State of the supervisor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Servo off, the bridges brake.
    #[default]
    Off,
    /// Servo on, at rest.
    Holding,
    /// Servo on, a plan is being executed.
    Moving,
    /// A fault is latched, the motors are in the safe state.
    Fault,
}

/// What is known at a tick.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Snapshot {
    /// The tick, counted from start.
    pub tick: u64,
    /// State of the supervisor.
    pub mode: Mode,
    /// The latched fault.
    pub fault: Option<Fault>,
    /// Whether theta and the turns are known.
    pub referenced: bool,
    /// Whether all three encoders answer well, and, for those that do not, why (index: pivot).
    pub encoder_faults: [Option<crate::fault::FaultKind>; 3],
    /// Measured pivot angles; valid once referenced.
    pub pivots: [Angle; 3],
    /// Setpoint of the pose.
    pub setpoint: Position,
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
}

/// Storage of both queues.
#[derive(Default)]
pub struct Link {
    commands: Queue<Command, COMMANDS>,
    snapshots: Queue<Snapshot, SNAPSHOTS>,
}

/// The tick's ends.
pub struct TickLink<'a> {
    /// Commands to take.
    pub commands: Consumer<'a, Command>,
    /// Where snapshots are left.
    pub snapshots: Producer<'a, Snapshot>,
}

/// The command side's ends.
pub struct PanelLink<'a> {
    commands: Producer<'a, Command>,
    snapshots: Consumer<'a, Snapshot>,
}

/// The command queue is full: nothing was queued.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct QueueFull;

impl Link {
    /// Empty queues.
    pub const fn new() -> Self {
        Self {
            commands: Queue::new(),
            snapshots: Queue::new(),
        }
    }

    /// The two sides.
    pub fn split(&mut self) -> (TickLink<'_>, PanelLink<'_>) {
        let (command_in, command_out) = self.commands.split();
        let (snapshot_in, snapshot_out) = self.snapshots.split();
        (
            TickLink {
                commands: command_out,
                snapshots: snapshot_in,
            },
            PanelLink {
                commands: command_in,
                snapshots: snapshot_out,
            },
        )
    }
}

impl PanelLink<'_> {
    /// Queues a command.
    pub fn send(&mut self, command: Command) -> Result<(), QueueFull> {
        self.commands.enqueue(command).map_err(|_| QueueFull)
    }

    /// The oldest snapshot waiting, if any. The tick refills the slot at its next run; a caller that wants the present
    /// and not the past empties the slot first and comes back a tick later.
    pub fn snapshot(&mut self) -> Option<Snapshot> {
        self.snapshots.dequeue()
    }
}

//! What a line or a single byte asks for.

use super::calibration::CalibrationAction;
use super::excitation::ExcitationRequest;
use super::frames::FrameQuery;
use super::iterative_learning::LearnAction;
use super::macros::MacroRequest;
use super::parameter::{Addresses, Settings};
use super::recorder::{RecordAction, RecordQuery};
use super::text::Name;
use super::variables::VariableRequest;
use super::wave::WaveQuery;
use crate::commander::Quantity;
use crate::commander::axis::{Axis, AxisSet, AxisValues};
use crate::commander::frames::FrameChange;
use crate::commander::wave::WaveChange;

/// Longest time that a line can ask for: a day.
pub(super) const MAX_DELAY_MS: f64 = 86_400_000.0;

/// A command, understood but not yet carried out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Request {
    /// An empty line.
    Nothing,
    /// A question about the controller as a whole.
    Query(Query),
    /// A question about axes, answered in a line each.
    Quantity(Quantity, AxisSet),
    /// A question about axes that is answered in words.
    Property(Property, AxisSet),
    /// `SPA?`
    Parameters(Addresses),
    /// `VMO?`: whether this target can be moved to.
    Reachable(AxisValues),
    /// `TRA?`: how far one can go in this direction.
    FurthestTarget(AxisValues),
    /// Something about macros.
    Macro(MacroRequest),
    /// Something about variables.
    Variables(VariableRequest),
    /// A question about the data recorder.
    Record(RecordQuery),
    /// A question about frames.
    Frames(FrameQuery),
    /// A question about waveforms.
    Waveforms(WaveQuery),
    /// Something to be done; no answer.
    Act(Action),
}

/// A question about the controller as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Query {
    /// `*IDN?`
    Identity,
    /// `CSV?`: version of the command set.
    Syntax,
    /// `VER?`
    Version,
    /// `SSN?`
    Serial,
    /// `HLP?`
    Help,
    /// `SAI?`
    Axes,
    /// `ERR?`: answers and clears.
    Error,
    /// `SCT?`
    CycleTime,
    /// `VLS?`
    Velocity,
    /// `HPA?`
    ParameterHelp,
    /// `CCL?`: command level.
    Level,
    /// `FLT?`
    Fault,
    /// `MON?`
    Monitor,
    /// `CMS?`
    Commissioned,
    /// `TST?`
    SelfTest,
    /// `HBT?`
    Heartbeat,
    /// `JTM?`
    JogTime,
    /// `OWN?`
    Ownership,
    /// `RCV?`
    Recovery,
    /// `TPC?`: piezo channels, of which there are none.
    PiezoChannels,
    /// `JON?`: these joysticks, a bit each.
    Joysticks(u8),
    /// `EVT?`
    Events,
    /// `LST?`
    Statistics,
    /// `ILC?`
    RepeatedMoves,
    /// `EXC?`
    Excitation,
    /// `CAL?`
    Calibration,
    /// `CAL POS?`
    PositionAsDrawn,
    /// `TMP?`
    Temperature,
    /// `APP?`: um.
    Approach,
    /// `#4`
    Status,
    /// `#5`
    Moving,
    /// `#6`: axes whose position has changed since it was asked for.
    Changed,
    /// `#7`
    Ready,
}

/// What is told of each axis in words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Property {
    /// `CST?`: the stage's type.
    Stage,
    /// `PUN?`: unit of its positions.
    Unit,
}

/// Something to be done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// `SVO`: 0 or 1.
    Servo(AxisValues),
    /// `FRF`
    Reference(AxisSet),
    /// `MOV`
    Move(AxisValues),
    /// `MVR`, `MRW`
    MoveRelative(AxisValues),
    /// `STE`: relative to the last target, recorded from its start.
    Step(AxisValues),
    /// About the data recorder.
    Record(RecordAction),
    /// `MRT`: along the axes of the tool as it is turned.
    MoveInTool(AxisValues),
    /// `JOG`: mm/s and deg/s.
    Jog(AxisValues),
    /// `SCT`, ms.
    CycleTime(f64),
    /// `VEL`: mm/s and deg/s.
    AxisVelocity(AxisValues),
    /// Tables and generators of waveforms.
    Wave(WaveChange),
    /// Tables of moves that are repeated.
    Repeat(LearnAction),
    /// `CAL BEG`, `CAL SET`, `CAL END`, `CAL ON`, `CAL OFF`, `CAL DEL`, `TMP`.
    Calibrate(CalibrationAction),
    /// A known voltage on a motor.
    Excite(ExcitationRequest),
    /// Frames and the centre of rotation.
    Frame(FrameChange),
    /// `NLM`: mm and deg.
    SoftLowest(AxisValues),
    /// `PLM`: mm and deg.
    SoftHighest(AxisValues),
    /// `SSL`: 0 or 1.
    SoftActive(AxisValues),
    /// `SPA`
    Set(Settings),
    /// `WPA`: these parameters, or all.
    Store(Addresses),
    /// `RPA`: these parameters, or all.
    Recall(Addresses),
    /// `CCL`: level, and whether the password is right.
    Level(f64, bool),
    /// `APP`, um.
    Approach(f64),
    /// `VLS`, mm/s.
    Velocity(f64),
    /// `STP`, `#24`: stop at the highest deceleration, and every script with it.
    Stop,
    /// `HLT`: stop smoothly.
    Halt(AxisSet),
    /// `FLC`
    Acknowledge,
    /// `CMS`: 0 or 1.
    Commission(f64),
    /// `HBT`, ms.
    Heartbeat(f64),
    /// `JTM`, ms.
    JogTime(f64),
    /// `RCV`: 0 or 1.
    Recover(f64),
    /// `OWN`: 0 or 1, and a name for the connection.
    Own(f64, Option<Name>),
    /// `LST`
    RestartStatistics,
    /// `RBT`
    Restart,
    /// `DEL`, ms.
    Delay(f64),
    /// `WAC`
    Wait(Condition),
    /// `JRC`: so many lines on in the macro, if the condition holds.
    Jump(i32, Condition),
    /// `MEX`: the macro ends, if the condition holds.
    Leave(Condition),
}

/// What `WAC` waits for, and `JRC` and `MEX` ask: two values compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    /// Left of the operator.
    pub left: Operand,
    /// How they compare.
    pub operator: Operator,
    /// Right of the operator.
    pub value: f64,
}

/// A value that can be asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operand {
    /// Of an axis.
    Axis(Quantity, Axis),
    /// `VAR?`: of a variable that is a number.
    Variable(Name),
}

/// A comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// `=`
    Equal,
    /// `!=`
    Unequal,
    /// `<`
    Less,
    /// `<=`
    AtMost,
    /// `>`
    Greater,
    /// `>=`
    AtLeast,
}

impl Operator {
    /// The operator written so.
    pub fn named(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"=" | b"==" => Self::Equal,
            b"!=" => Self::Unequal,
            b"<" => Self::Less,
            b"<=" => Self::AtMost,
            b">" => Self::Greater,
            b">=" => Self::AtLeast,
            _ => return None,
        })
    }

    /// Whether `left` and `right` compare so.
    pub fn holds(self, left: f64, right: f64) -> bool {
        match self {
            Self::Equal => left == right,
            Self::Unequal => left != right,
            Self::Less => left < right,
            Self::AtMost => left <= right,
            Self::Greater => left > right,
            Self::AtLeast => left >= right,
        }
    }
}

impl Action {
    /// Whether it begins a motion, or another one: what the recorder's triggers mean by a command that moves.
    pub(super) const fn starts_motion(&self) -> bool {
        matches!(
            self,
            Self::Move(_)
                | Self::MoveRelative(_)
                | Self::MoveInTool(_)
                | Self::Step(_)
                | Self::Jog(_)
                | Self::Excite(_)
                | Self::Wave(WaveChange::Switch(_))
        )
    }
}

impl Request {
    /// Whether it asks for an answer and changes nothing.
    pub(super) const fn is_question(&self) -> bool {
        match self {
            Self::Nothing | Self::Act(_) => false,
            Self::Macro(request) => matches!(
                request,
                MacroRequest::Error
                    | MacroRequest::Free
                    | MacroRequest::List(_)
                    | MacroRequest::Running
                    | MacroRequest::IsRunning
            ),
            Self::Variables(request) => matches!(request, VariableRequest::Query(_)),
            _ => true,
        }
    }

    /// Whether carrying it out needs to know what became of the command that the tick has not taken yet. Stopping never
    /// does, and what is constant does not either.
    pub(super) const fn needs_current_snapshot(&self) -> bool {
        match self {
            Self::Nothing | Self::Property(..) | Self::Parameters(_) => false,
            Self::Macro(_) | Self::Variables(_) | Self::Record(_) => false,
            Self::Waveforms(query) => matches!(query, WaveQuery::Running(_) | WaveQuery::Mask),
            Self::Frames(_) => true,
            Self::Quantity(..) | Self::Reachable(_) | Self::FurthestTarget(_) => true,
            Self::Query(query) => matches!(query, Query::Error | Query::Fault | Query::Monitor),
            Self::Act(action) => !matches!(
                action,
                Action::Stop | Action::Halt(_) | Action::Velocity(_) | Action::Recover(0.0)
            ),
        }
    }
}

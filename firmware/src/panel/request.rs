//! What a line or a single byte asks for.

use super::axis::{Axis, AxisSet, AxisValues};
use super::parameter::{Addresses, Settings};

/// A command, understood but not yet carried out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Request {
    /// An empty line.
    Nothing,
    /// A question about the controller as a whole.
    Ask(Query),
    /// A question about axes, answered in a line each.
    Read(Quantity, AxisSet),
    /// A question about axes that is answered in words.
    Tell(Property, AxisSet),
    /// `SPA?`
    Parameters(Addresses),
    /// `VMO?`: whether this target can be moved to.
    Reachable(AxisValues),
    /// `TRA?`: how far one can go in this direction.
    Reach(AxisValues),
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
    /// `VLS?`
    Velocity,
    /// `HPA?`
    ParameterHelp,
    /// `CCL?`: command level.
    Level,
    /// `FLT?`
    Fault,
    /// `#4`
    Status,
    /// `#5`
    Moving,
    /// `#7`
    Ready,
}

/// What can be read of each axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// `POS?`: measured, mm and deg.
    Position,
    /// `MOV?`: commanded, mm and deg.
    Target,
    /// `ONT?`: 1 when settled.
    OnTarget,
    /// `SVO?`: 1 when on.
    Servo,
    /// `FRF?`: 1 when referenced.
    Referenced,
    /// `TMN?`: mm and deg.
    Lowest,
    /// `TMX?`: mm and deg.
    Highest,
    /// `NLM?`: mm and deg.
    SoftLowest,
    /// `PLM?`: mm and deg.
    SoftHighest,
    /// `SSL?`: 1 when soft limits count.
    SoftActive,
    /// `LIM?`: 0, there are no limit switches.
    LimitSwitch,
    /// `TRS?`: 0, there are no reference switches; the encoders are absolute.
    ReferenceSwitch,
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
    /// `MVR`
    MoveRelative(AxisValues),
    /// `NLM`: mm and deg.
    SoftLowest(AxisValues),
    /// `PLM`: mm and deg.
    SoftHighest(AxisValues),
    /// `SSL`: 0 or 1.
    SoftActive(AxisValues),
    /// `SPA`
    Set(Settings),
    /// `VLS`, mm/s.
    Velocity(f64),
    /// `STP`, `#24`: stop at the highest deceleration, and every script with it.
    Stop,
    /// `HLT`: stop smoothly.
    Halt(AxisSet),
    /// `FLC`
    Acknowledge,
    /// `DEL`, ms.
    Delay(f64),
    /// `WAC`
    Wait(Condition),
}

/// What `WAC` waits for: `quantity` of `axis`, compared with `value`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    /// Left of the operator.
    pub quantity: Quantity,
    /// Of this axis.
    pub axis: Axis,
    /// How they compare.
    pub operator: Operator,
    /// Right of the operator.
    pub value: f64,
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

impl Request {
    /// Whether carrying it out needs to know what became of the command that the tick has not taken yet. Stopping never
    /// does, and what is constant does not either.
    pub(super) const fn needs_present(&self) -> bool {
        match self {
            Self::Nothing | Self::Tell(..) | Self::Parameters(_) => false,
            Self::Read(Quantity::Lowest | Quantity::Highest, _) => false,
            Self::Read(..) | Self::Reachable(_) | Self::Reach(_) => true,
            Self::Ask(query) => matches!(query, Query::Error | Query::Fault),
            Self::Act(action) => {
                !matches!(action, Action::Stop | Action::Halt(_) | Action::Velocity(_))
            }
        }
    }
}

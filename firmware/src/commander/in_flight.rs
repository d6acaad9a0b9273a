//! The command that the tick has not counted yet.

use super::frames::{ActiveFrames, FrameSelection};
use super::sent_plan::{Goal, SentPlan};

/// What was sent last, as long as it is not known what became of it.
// There is no heap to box the plan in, and there is one command in flight.
#[allow(clippy::large_enum_variant)]
pub(super) enum InFlight {
    /// A plan; and the goal that it is the way to: the tick may refuse it, then it is planned anew.
    Plan(SentPlan, Option<Goal>),
    /// Referencing.
    Reference,
    /// An excitation.
    Excitation,
    /// Other constants for the tick.
    Configure,
    /// Frames with another centre of rotation: in force when the tick has that centre.
    SelectFrames(FrameSelection, ActiveFrames),
    /// Nothing that is needed when it is acknowledged.
    Other,
}

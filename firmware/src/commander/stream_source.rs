//! A stream of targets, and who makes them.

use super::wave::GeneratorRun;
use crate::motion::{Position, Stream};

/// A stream under way, or about to be.
pub(super) struct Streaming {
    /// `None` until the stage stands where the waves begin.
    pub stream: Option<Stream>,
    /// The generators that make its targets; none: targets come one by one.
    pub run: Option<GeneratorRun>,
    /// The last target, and the tick when it came.
    pub last: (Position, u64),
    /// Whether a plan of it has been sent.
    pub started: bool,
}

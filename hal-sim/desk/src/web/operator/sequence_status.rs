//! What a sequence is told, and what it tells.

use serde::Serialize;

/// The page that an order comes from.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::web) struct Orderer {
    pub page: u64,
    /// That of its way to the controller; empty: it has not told it.
    pub key: String,
}

/// What an operator wants of the sequence.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::web) enum Order {
    /// Begins this script; `steps`: pauses after its first line.
    Run {
        name: String,
        text: String,
        steps: bool,
        by: Orderer,
    },
    /// The next line, and no more.
    Step { by: Orderer },
    /// No further line.
    Pause,
    /// On from where it is.
    Continue { by: Orderer },
    /// Ends it, and brings the stage to rest smoothly.
    Stop,
    /// A page has stopped the stage.
    Stopped { who: String },
    /// A page is gone.
    Gone { page: u64 },
}

#[derive(Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum State {
    Idle,
    Running,
    Pausing,
    Paused,
    Ended,
}

/// An answer that the script asked for.
#[derive(Clone, Serialize)]
pub(super) struct Answered {
    pub number: usize,
    pub line: String,
    pub reply: String,
}

/// What pages are told.
#[derive(Clone, Serialize)]
#[serde(tag = "kind", rename = "sequence")]
pub(super) struct Status {
    pub state: State,
    pub name: String,
    pub text: String,
    /// Number of the line under way, or that is next; from 1.
    pub line: Option<usize>,
    pub done: usize,
    pub total: usize,
    /// Whether it ended as it was meant to, or pauses because it was told to.
    pub good: bool,
    pub said: String,
    pub answers: Vec<Answered>,
}

//! How far a recovery has come, and how it has ended.

/// How far a recovery has come.
#[derive(Clone, Copy, Debug)]
pub(in crate::commander) struct Recovery {
    pub step: Step,
    /// It is to end where it is.
    pub is_given_up: bool,
}

/// See the table of the folder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::commander) enum Step {
    Limit,
    Hold,
    Drive,
    Restore,
}

/// How a recovery has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecoveryEnd {
    /// In reach, held.
    InReach,
    /// Given up, refused, or ended by a fault; the servo is off.
    GivenUp,
}

//! What lines about repeated moves ask for.

use crate::gcs::text::Name;

/// What lines about repeated moves ask for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LearnAction {
    /// `ILC LEARN`: the next move gets a table of this name, or the one that has it goes on learning.
    Learn(Name),
    /// `ILC FREEZE`: it stays as it is at its best.
    Freeze(Name),
    /// `ILC KEEP`: it is kept over a restart.
    Keep(Name),
    /// `ILC FORGET`: this one, or all.
    Forget(Option<Name>),
}

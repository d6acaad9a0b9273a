//! Which parameters a line names.

use crate::commander::axis::Axis;
use core::fmt;

/// What a parameter belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Item {
    /// `1`: the controller as a whole.
    System,
    /// An axis.
    Axis(Axis),
}

/// A parameter of an item.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Address {
    /// Whose.
    pub item: Item,
    /// Which.
    pub id: u32,
}

/// Parameters that a line can name.
pub const MAX_ADDRESSES: usize = 8;
/// The parameters that `SPA?` names, from the left; none stands for all.
pub type Addresses = [Option<Address>; MAX_ADDRESSES];
/// The parameters that `SPA` sets, from the left.
pub type Settings = [Option<(Address, f64)>; MAX_ADDRESSES];

impl fmt::Display for Item {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::System => f.write_str("1"),
            Self::Axis(axis) => write!(f, "{}", axis.letter()),
        }
    }
}

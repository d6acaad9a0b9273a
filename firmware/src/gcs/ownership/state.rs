//! Who owns, and since when.

use crate::gcs::connection_number::ConnectionNumber;
use crate::gcs::text::Text;

/// The connection that owns.
#[derive(Clone, Copy, Debug)]
pub(in crate::gcs) struct Owner {
    pub connection: ConnectionNumber,
    pub name: Text,
    /// The tick at which it began to.
    pub since_tick: u64,
}

/// Who owns, if anybody does.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::gcs) struct Ownership {
    pub owner: Option<Owner>,
}

impl Ownership {
    /// Whether a connection owns.
    pub fn is_of(&self, connection: Option<ConnectionNumber>) -> bool {
        let owner = self.owner.map(|owner| owner.connection);
        owner.is_some() && owner == connection
    }

    /// Whether another connection owns.
    pub fn excludes(&self, connection: Option<ConnectionNumber>) -> bool {
        self.owner.is_some() && !self.is_of(connection)
    }

    /// A connection owns no more, if it did.
    pub fn release(&mut self, connection: ConnectionNumber) {
        self.owner = self.owner.filter(|owner| owner.connection != connection);
    }
}

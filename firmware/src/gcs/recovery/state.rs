//! Whose the recovery under way is, and until when.

use crate::gcs::connection_number::ConnectionNumber;

/// Whose the recovery under way is, or was the last.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::gcs) struct RecoveryOwner {
    pub connection: Option<ConnectionNumber>,
    /// The tick at which it ends; `None`: with its connection.
    pub end_tick: Option<u64>,
}

impl RecoveryOwner {
    /// A connection has ended: so does its recovery.
    pub fn connection_ended(&mut self, number: ConnectionNumber) {
        if self.connection == Some(number) {
            self.end_tick = Some(0);
        }
    }
}

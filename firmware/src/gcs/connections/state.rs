//! What is known of all connections together.

use crate::gcs::connection_number::ConnectionNumber;
use crate::gcs::text::Text;

/// What is known of all connections together.
#[derive(Default)]
pub(in crate::gcs) struct Connections {
    /// Connections so far.
    pub count: u32,
    /// Whose motion is under way, or was the last.
    pub mover: Option<ConnectionNumber>,
    /// Who is to be told that its motion was ended by another connection.
    pub stopped_mover: Option<ConnectionNumber>,
    /// Who changed something of the stage last, and at which tick.
    pub last_command: Option<(Text, u64)>,
}

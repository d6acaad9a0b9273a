//! Number of a connection.

/// Number of a connection, counted from 1 since the start.
pub(super) type ConnectionNumber = u32;

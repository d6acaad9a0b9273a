//! Words that stand between a slip and what it would change.

/// What `CCL 1` asks for: against accidents, not against intruders. The same for all controllers of this family.
pub(super) const LEVEL_PASSWORD: &[u8] = b"ADVANCED";

/// What `WPA` has to be given, so that nothing is overwritten by a slip.
pub(super) const STORE_PASSWORD: &[u8] = b"100";

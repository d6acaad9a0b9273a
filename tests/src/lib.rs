//! What crosses crates: long scenarios, real clients, target runs.

//! Chips on the board, written against embedded-hal.

pub mod biss;
pub mod bridge;

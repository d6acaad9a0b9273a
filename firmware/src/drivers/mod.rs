//! Chips on the board, written against embedded-hal.
//!
//! | file | idea |
//! |---|---|
//! | `biss` | absolute encoder: 64 bits to a position |
//! | `bridge` | H-bridge: a signed duty to PWM and pins |

pub mod biss;
pub mod bridge;

//! Chips on the board, written against embedded-hal.
//!
//! | file | idea |
//! |---|---|
//! | `biss` | absolute encoder: 64 bits to a position |
//! | `bridge` | H-bridge: a signed duty to PWM and pins |
//! | `latch` | when each encoder latches |
//! | `power_stage` | the parts of the power stage, and what follows from them |

pub mod biss;
pub mod bridge;
pub mod latch;
pub mod power_stage;

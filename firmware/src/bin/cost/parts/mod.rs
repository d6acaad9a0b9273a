//! The parts that are counted, and the random states they are counted over. No part is inlined into another, so that only one
//! at a time lies on the stack.

mod asked;
pub mod control;
pub mod following;
pub mod kinematics;
pub mod known;
pub mod motion;
pub mod plain;
mod states;
mod streaming;

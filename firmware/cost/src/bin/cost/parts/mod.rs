//! The parts that are counted, over the random states of the library beside. No part is inlined into another, so that
//! only one at a time lies on the stack.

pub mod control;
pub mod following;
pub mod kinematics;
pub mod known;
pub mod motion;

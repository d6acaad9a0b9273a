//! Jerk-limited profiles: how long each segment lasts, and the whole ticks that the tick plays.

pub(crate) mod any_state;
pub(crate) mod hats;
pub(crate) mod rest_to_rest;
pub(crate) mod shape;
pub(crate) mod tracks;
pub(crate) mod whole_ticks;

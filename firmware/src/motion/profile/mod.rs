//! Jerk-limited profiles: how long each segment lasts, and the whole ticks that the tick plays.
//!
//! | file | idea |
//! |---|---|
//! | `rest_to_rest` | seven segments in closed form, as three moving averages |
//! | `any_state` | the fastest motion of one axis from any state to rest at a target |
//! | `shape`, `hats`, `whole_ticks` | such a motion in whole ticks, exact in integers |
//! | `tracks` | three axes that arrive together, as one list of pieces |

pub(super) mod any_state;
pub(super) mod hats;
pub(super) mod rest_to_rest;
pub(crate) mod shape;
pub(super) mod tracks;
pub(super) mod whole_ticks;

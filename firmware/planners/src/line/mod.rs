//! Planning a straight line from rest to rest.
//!
//! First the fastest motion under the limits of the line alone, in closed form. If the pivots can follow it, as most
//! short and slow lines, that is it. Otherwise the demands on the pivots are laid out along the line, the fastest speed
//! that they allow at every place is found, replaced by a few segments of constant acceleration and limited in jerk.
//! What roundings and corners still leave over a limit is taken off the whole motion. The profile, slowed down until
//! the pivots follow, competes: the shorter of the two is taken.
//!
//! | file | idea |
//! |---|---|
//! | `planner` | the steps above, and which profile is taken |
//! | `path` | the line as the pivots see it: derivatives of their angles by the path parameter |
//! | `disk` | whether the line stays inside the usable disk |
//! | `pivot_demand` | the pivots' demands on a grid of places along the line |
//! | `topp` | the largest squared speed at every place: time-optimal path parametrisation |
//! | `segments` | that curve as a few segments of constant acceleration |
//! | `jerk_ramps` | the steps of acceleration between them as ramps of limited jerk |
//! | `rounded_ramps` | the ramps in whole numbers, at rest to the bit at the end |

pub(crate) mod disk;
pub(super) mod jerk_ramps;
pub(crate) mod path;
pub(super) mod pivot_demand;
pub(crate) mod planner;
pub(super) mod rounded_ramps;
pub(crate) mod segments;
pub(super) mod topp;

pub use planner::plan_line;

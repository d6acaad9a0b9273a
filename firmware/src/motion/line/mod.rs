//! Planning a straight line from rest to rest.
//!
//! First the fastest motion under the limits of the line alone, in closed form ([`RestToRestProfile`]). If the pivots can follow it, as
//! most short and slow lines, that is it. Otherwise the demands on the pivots are laid out along the line ([`DemandGrid`]), the
//! fastest speed that they allow at every place is found ([`velocity_limit_squared`]), replaced by a few stretches of constant acceleration
//! ([`fit_segments_below`]) and limited in jerk ([`write_path_profile`]). What roundings and corners still leave over a limit is taken off the whole
//! motion. The profile, slowed down until the pivots follow, competes: the shorter of the two is taken.

pub(crate) mod disk;
pub(crate) mod jerk_ramps;
pub(crate) mod path;
pub(crate) mod path_profile;
pub(crate) mod pivot_demand;
pub(crate) mod planner;
pub(crate) mod ramp;
pub(crate) mod rounded_ramps;
pub(crate) mod segments;
pub(crate) mod topp;

pub use planner::plan_line;

//! Jogging: from any state to a constant velocity, held until somebody changes it, or up to the workspace's edge.
//!
//! ```text
//! speed of    ________________________                 The velocity is changed (see `profile/velocity`), held, and given up in time:
//! the point  /                        \                a plan that ends at rest like any other, exactly where it can stop.
//!          _/                          \______         Theta alone never meets an edge: its plan ends at a thousand million
//! of theta   ______________________________..          turns, 30 years away at a turn a second.
//!          _/
//! ```
//!
//! The edge is that of the disk in which the pivots can follow this velocity at any orientation (`check/pivot_bounds`):
//! the faster the jog, the smaller it may be. Who jogs outwards stops there; who stands outside of it is told that it
//! is too fast. Bounds of the moved point and of theta end a jog in the same way. When the platform turns about a point
//! beside its centre, its centre goes in circles: the point then stays where every orientation is possible, or, where
//! it is not, point and theta stop together before the centre meets the edge.
//!
//! Near an edge there may be no room to reach the velocity and to stop again: from rest a lower one is taken.
//!
//! | file | idea |
//! |---|---|
//! | `planner` | velocities tried until one can be reached and given up again |
//! | `request` | the velocity wanted, the limits, the state that is left |
//! | `travel_time` | how long a steady motion can go before the edge or a bound |
//! | `trajectory` | the way to the velocity, the velocity held, the way to rest |
//! | `hold_time` | how long it is held, and how much slower it has to be |

mod hold_time;
mod planner;
mod request;
mod trajectory;
mod travel_time;

pub use planner::plan_jog;

//! Jerk-limited profiles: how long each segment lasts.
//!
//! | file | idea |
//! |---|---|
//! | `rest_to_rest` | seven segments in closed form, as three moving averages |
//! | `velocity` | three segments from any velocity and acceleration to a wanted velocity |

pub mod rest_to_rest;
pub mod velocity;

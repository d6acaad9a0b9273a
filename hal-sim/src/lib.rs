//! One simulated stage in front of the firmware library, and what drives it.
//!
//! | module | idea |
//! |---|---|
//! | [`machine`] | bodies, drives and devices |
//! | [`front`] | the firmware's loop and drivers between its encoders and bridges |
//! | [`rig`] | controller and machine together, under a script or a client |
//! | [`campaign`] | many runs in each of which something breaks |
//! | [`report`] | what a run leaves behind |
//! | [`random`] | random numbers from a seed |

pub mod campaign;
pub mod front;
pub mod machine;
pub mod random;
pub mod report;
pub mod rig;

//! Scripts of GCS lines through the real command side, every tick of the setpoint held against the limits of motion.
//!
//! | file | idea |
//! |---|---|
//! | `quantities` | speed, acceleration and jerk of a setpoint |
//! | `rule` | what is held at every tick, and by how much it was broken |
//! | `limits_in_force` | limits that a script can change |
//! | `allowance` | what a plan may do, by what it is for |
//! | `commanded` | what the plans are for that the tick takes |
//! | `watch` | holds every tick against what is allowed in it |
//! | `counts` | what has been under the watch |
//! | `script` | a script, as it is written |
//! | `run` | runs a script under the watch |
//! | `random_script` | random scripts |
//! | `shrink` | leaves out lines as long as a rule stays broken |
//! | `survey` | many random scripts, and what came of them |

pub mod allowance;
pub mod commanded;
pub mod counts;
pub mod limits_in_force;
pub mod quantities;
pub mod random_script;
pub mod rule;
pub mod run;
pub mod script;
pub mod shrink;
pub mod survey;
pub mod watch;

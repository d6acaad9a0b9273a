//! From pivot setpoints and measured pivots to duties.
//!
//! ```text
//!  setpoint --> feedforward: torque model, back-EMF, friction; scaled by what has been learnt ----+
//!      |                                                                                          v
//!      +--(-)--> e --> r = e' + Kp e --> Kv r + Ki integral(r) ------------------------------(+)--> volts --> current limit --> duty
//!      measured                    \--> learning
//! ```
//!
//! Feedforward carries the motion; feedback only sees what the model has wrong. What it has wrong is mostly a few
//! constants a drive (motor constant, moved inertia, friction), and it shows in the very same signal r that the
//! integral collects. So the integral gets company: `w_k' = g_k f_k r` for a few signals f_k of the setpoint (rate,
//! torque, friction, each scaled to about 1, and led by what the drive takes to follow), and `sum w_k f_k` is added to
//! the voltage. The integral itself is the case f = 1. This is the desired compensation adaptation law of Sadegh and
//! Horowitz (1990), stable as long as the loop has phase for all the integral gains together, `1 + sum g_k f_k^2` of
//! the integral's own: so what they add is bounded, whatever the setpoint asks for. At rest all f_k but friction's vanish and nothing is
//! learnt.
//!
//! | file | idea |
//! |---|---|
//! | `pivot` | the servo of one pivot: feedback, feedforward, learning, saturation with anti-windup, whole counts |
//! | `config` | its constants, derived from the parameters |
//! | `filter` | notches and lead of the feedback |
//! | `inertia` | what a pivot moves, for the gains' schedule |
//! | `drive_limits` | rate and acceleration of the pivots, and stop of a fault, that the drives bear |
//! | `ripple` | compensation of torque ripple |
//! | `gear_error` | compensation of the gears' cyclic error |
//! | `learnt` | what is learnt, as it is told and kept |
//! | `current_limit` | the limit of the motors' currents |
//! | `dead_time` | compensation of the bridges' dead time |
//! | `presliding` | friction before a ring slides |
//! | `platform_torque` | torque that platform, payload and guides ask of the pivots |

mod config;
mod current_limit;
mod dead_time;
mod drive_limits;
mod filter;
mod gear_error;
mod inertia;
mod learnt;
mod pivot;
mod platform_torque;
mod presliding;
mod ripple;

pub use config::{PivotServoConfig, ServoConfig};
pub(in crate::control) use dead_time::compensate_dead_time;
pub use drive_limits::{BorneLimits, ask_the_same, largest_limits};
pub use filter::{FilterConfig, Filters};
pub use gear_error::GearErrorConfig;
pub use inertia::carried_inertia;
pub use learnt::Learnt;
pub use pivot::{LoopSetpoint, PivotFeedback, PivotServo, PivotSetpoint};
pub use platform_torque::{Body, friction_torques, platform_torques};
pub use presliding::Presliding;
pub use ripple::RippleConfig;

//! Excitation: a known voltage on one motor, or a step of one ring under a soft servo, to see what the machine is.
//!
//! With the servo off it has the motors to itself ([`Mode::Exciting`](crate::mode::Mode)): no kinematics, no reference, no knowledge of
//! the machine but the guards, which [`ExcitationGuards`] has. With the servo on a voltage is added to what a servo asks for; the
//! supervisor watches then as ever. It ends by itself, by a guard, by a stop, or by a fault; then the motors brake, and let go.
//!
//! | file | idea |
//! |---|---|
//! | `request` | what is asked for |
//! | `multisine` | a sum of sines, by one multiplication each in a tick |
//! | `run` | the one under way: its volts, its guards, its end |

mod multisine;
mod request;
mod run;

pub use multisine::{MAX_LINES, Multisine, PERIOD_TICKS, line_harmonics};
pub use request::{Excitation, ExcitationGuards, ExcitationSignal, ExcitationUntil};
pub(super) use run::GuardBroken;
pub use run::{ExcitationEnd, ExcitationReport, ExcitationRun};

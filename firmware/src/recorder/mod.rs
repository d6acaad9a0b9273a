//! Recording: what a tick knows, offered at its end, and who keeps it.
//!
//! A [`Recorder`] is a store of 32-bit words with two ends. The [`TickRecorder`] writes into it inside the tick; the
//! [`PanelRecorder`] orders records and reads them at low priority. Neither waits for the other, and there is no lock:
//!
//! - Orders go to the tick by value, through a queue. A [`Setup`] is copied out of it once, so that the tick works on its own.
//! - The words are atomics, each written and read in one access. The tick publishes how many rows of the record are complete
//!   with release, the panel reads that with acquire, so it sees those rows whole; and they stay as they are until the panel
//!   itself orders another record, since rows are overwritten only before the trigger.
//!
//! What is written are [`Word`]s, integers or floats as the tick has them, finer than the encoder; what they are in mm and deg
//! is worked out by whoever reads them.
//!
//! | file | idea |
//! |---|---|
//! | `word` | what can be recorded |
//! | `setup` | what a record is to be |
//! | `store` | the memory, and its two ends |
//! | `tick` | the end in the tick: triggers, rows |
//! | `panel` | the end outside of it: orders, reading, turns put back |
//! | `hash` | a hash of every tick |

mod hash;
mod panel;
mod setup;
mod store;
mod tick;
mod word;

pub use hash::RunningHash;
pub use panel::{Cursor, PanelRecorder, Progress};
pub use setup::{MOST_BETWEEN, Setup, TABLES, WIDEST, Watch};
pub use store::Recorder;
pub use tick::TickRecorder;
pub use word::{Kind, Word};

use crate::drivers::bridge::Duty;
use crate::fault::FaultKind;
use crate::link::Mode;
use crate::motion::Setpoint;
use kinematics::Angle;

/// All that a tick computed.
#[derive(Clone, Debug)]
pub struct Sample {
    /// The tick.
    pub tick: u64,
    /// State of the supervisor.
    pub mode: Mode,
    /// The latched fault.
    pub fault: Option<FaultKind>,
    /// Setpoint of the platform.
    pub setpoint: Setpoint,
    /// Setpoint of the point that is moved: the platform's unless a centre of rotation has been chosen.
    pub point: Setpoint,
    /// Setpoint of the pivots; the measured angles while the servo is off.
    pub pivot_setpoints: [Angle; 3],
    /// Their rates, rad/s.
    pub pivot_rates: [f32; 3],
    /// Measured pivots.
    pub pivots: [Angle; 3],
    /// Duties.
    pub duty: [Duty; 3],
    /// Motor currents, ADC counts.
    pub current_counts: [u16; 3],
    /// Supply, ADC counts.
    pub supply_counts: u16,
    /// What the tick before cost, cycles.
    pub tick_cycles: u32,
    /// Commands taken so far.
    pub commands: u32,
}

/// Somebody who looks at every tick. Runs inside it: no allocation, no blocking, no unbounded work.
pub trait Record {
    /// Takes the sample of one tick.
    fn record(&mut self, sample: &Sample);
}

impl Record for () {
    #[inline]
    fn record(&mut self, _: &Sample) {}
}

//! The bench: the unmodified image `stage` on an emulated STM32F427 that has the simulated stage on its pins.
//!
//! The emulator is `rigless`. Its time is virtual: 168 million instructions a second, one for each cycle of the real
//! clock, so that an instruction count is what the cycle counter would show without wait states.
//!
//! ```text
//!  stop k (latch - 1 us)                     tick k                    stop k+1
//!  |--- latch, SPI by DMA ---|--- control task ---|---------------------|
//!   plant runs from tick k-1 to tick k, with the        PWM, phase and sleep pins as they stand now
//!   pins as they stand; frames and ADC inputs are        have acted since the middle of the period
//!   handed over, then the caller looks
//! ```
//!
//! The stage is stepped once a control period, by the same call and on the same grid as on the host
//! ([`Stage::advance_period`]), so a run here and one there are the same to the bit. That the plant runs ahead by the
//! 15 us from latch to tick changes nothing: no pin moves in them.
//!
//! | file | idea |
//! |---|---|
//! | `bench`, `driver`, `period` | the bench, its clock, and what a caller sees once a period |
//! | `board`, `encoder`, `line` | what lies around the chip |
//! | `run`, `serve`, `exercise/` | a script; clients over TCP; motion from a seed |
//! | `uses` | everything that the tick is used for, followed |
//! | `pins` | what goes over the pins, tick by tick, for another emulator |
//! | `timeline` | when ticks, latches and stops come |
//! | `twin` | the same controller on the host |
//! | `load`, `busy`, `circle` | the tick under all the load there is; all that a slow chip has to do at once; what streams follow |
//! | `cost`, `follow`, `way`, `estimate` | what ticks take; their instructions; one tick's by where they are written; `llvm-mca` on it |
//! | `upset` | bits of the RAM that flip, and what comes of it |
//! | `gaps` | what the emulator does not model |
//! | `elf_file` | where the images lie |
//!
//! [`Stage::advance_period`]: hal_sim::machine::devices::Stage::advance_period

mod bench;
pub(crate) mod board;
mod busy;
mod circle;
mod cost;
mod driver;
pub mod elf_file;
mod encoder;
mod estimate;
mod exercise;
mod follow;
pub(crate) mod gaps;
mod line;
mod load;
mod period;
mod pins;
mod run;
mod serve;
mod timeline;
mod twin;
mod upset;
mod uses;
mod way;

pub use bench::{Bench, BenchError, Outcome};
pub use board::BoardKind;
pub use busy::{BUSY_CHIPS, Busy, BusyOptions, busy};
pub use cost::TickCost;
pub use estimate::{Estimate, estimate};
pub use exercise::{Cost, Doing, Exercise, ExerciseOptions, Tally, Worst, exercise};
pub use follow::Step;
pub use gaps::{Allowed, GAPS};
pub use load::{Load, load};
pub use period::{Action, Period, Reset, Service, Trace};
pub use pins::pins;
pub use rigless::device::ResetCause;
pub use run::{ChipError, ChipOutcome, run};
pub use serve::{LineNotice, LineServer};
pub use twin::{Agreed, Divergence, Twin};
pub use upset::{Consequence, REGIONS, Upset, UpsetRun, upset, upsets};
pub use uses::{Use, Used, UsedTick, uses};
pub use way::follow;

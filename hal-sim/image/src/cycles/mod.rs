//! Cycles of the tick, not instructions: each tick's instructions, as the emulated chip ran them, through a model of the core and of
//! the flash behind it.
//!
//! No board was measured. What the manuals leave open is guessed three times, [`Setting`]; beyond that the model may be some 6 % off.
//!
//! | file | idea |
//! |---|---|
//! | `registers`, `instruction` | sets of registers; what an instruction needs, writes, and takes by ARM's table |
//! | `setting` | what is not known of the chip, guessed three times |
//! | `core`, `fetch` | the core; how it fetches instructions |
//! | `program` | the instructions of the image's tick, by address |
//! | `flash` | the flash and its accelerator |
//! | `tally`, `print` | ticks of each use through the model, and how they are printed |
//! | `limits` | what a tick may take |

mod core;
mod fetch;
mod flash;
mod instruction;
mod limits;
mod print;
mod program;
mod registers;
mod setting;
mod tally;

pub use self::core::{Bus, Core, Cycles, Ran};
pub use instruction::{Instruction, Kind, Place, address};
pub use limits::{
    Deadlines, GOAL, Limit, LimitsError, late, limits, over, read_limits, write_limits,
};
pub use print::{Tallies, print_cycles, print_kinds, print_places};
pub use program::Program;
pub use registers::Registers;
pub use setting::Setting;
pub use tally::{Row, Tally, modelled_by_schedule};

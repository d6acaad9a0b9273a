//! What parts of the library cost on the chip: the image `cost` on the emulated one, and its table; and what the image
//! `stage` takes of flash and RAM.
//!
//! The image does the counting (the head of its source says what is counted and what is not); this side gives the order,
//! waits, reads the table by symbol, and compares with the figures that the repository keeps.
//!
//! | file | idea |
//! |---|---|
//! | `run`, `driver` | a run of the image, and the emulator through it |
//! | `part`, `print` | a row of the table, and how it is printed |
//! | `figures` | the figures that the repository keeps |
//! | `goal` | what a part may cost |
//! | `size` | flash and RAM by part |

mod driver;
mod figures;
mod goal;
mod part;
mod print;
mod run;
mod size;

pub use driver::Order;
pub use figures::{Figure, Figures, FiguresError, Growth};
pub use part::Part;
pub use print::{print, print_sizes};
pub use run::{CostError, Counted, count};
pub use size::{Bytes, Sizes};

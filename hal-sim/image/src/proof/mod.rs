//! What can be proven of the image `stage` without running it, from its machine code: that the tick cannot fail, and how deep
//! the stack gets.
//!
//! The image is taken apart instruction by instruction ([`Code`]); every call, tail call and jump out of a function is an edge.
//! What cannot be understood (bytes that are no instruction, an unknown change of the stack pointer) fails the proof, it is
//! never skipped.
//!
//! - **No panic.** From the handlers of the control loop no path leads to the panic machinery, to a trap instruction, to a call
//!   through a pointer, back to itself, or to arithmetic in f64 ([`faults`]). In the whole image nothing is a fused
//!   multiply-add, which the desktop would round otherwise.
//! - **No flash.** No function that those handlers lead to lies in flash, and none comes by an address of the flash: by two
//!   instructions that put it together, or as a word of the code. An address that lies in a variable is not found so; `cargo
//!   chip-cycles` fails when a tick that it follows has loaded from flash.
//! - **Stack.** The frame of a function is everything it ever pushes, summed, as if it did so at once; its depth that of its
//!   deepest callee on top ([`Depths`]). A call through a pointer may reach every function whose address stands anywhere in
//!   the image; such calls nest [`NESTING`] deep at most.
//! - **Vectors.** Every exception ends in a handler of the image's own, and the one for what nobody expects touches no stack
//!   ([`vector_faults`]).
//! - **Masks.** Where interrupts are held back ([`Code::masks`]).
//!
//! | file | idea |
//! |---|---|
//! | `elf`, `code`, `listing`, `step` | the file; functions and calls; instructions; what one of them means |
//! | `safe` | nothing in the control loop can fail, nothing of it is in flash |
//! | `stack` | the deepest stack |
//! | `vectors` | where exceptions end |
//! | `print` | the proofs as they are printed |

mod code;
mod elf;
mod error;
mod listing;
mod print;
mod safe;
mod stack;
mod step;
mod vectors;

pub use code::{Code, Edge, Function};
pub use error::ProofError;
pub use listing::listing;
pub use print::{print_proof, print_stack};
pub use safe::{Fault, faults};
pub use stack::{CONTROL_LOOP, Depth, Depths, LEVELS, Level, NESTING, STACK_LEFT, Stack};
pub use step::{Decoded, Engine, Step};
pub use vectors::vector_faults;

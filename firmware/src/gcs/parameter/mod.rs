//! The parameters that `SPA?`, `SPA` and `HPA?` know: one line each in [`PARAMETERS`], from which all three come, and
//! the page `PARAMETERS.md` with them.
//!
//! Ids that clients ask for by themselves are those of the hexapod profile; the others begin with 0x5450.
//!
//! | file | idea |
//! |---|---|
//! | `descriptor` | what a parameter is |
//! | `table` | which there are |
//! | `address` | which of them a line names |
//! | `passwords` | what has to be given with some lines |
//! | `parse` | what lines mean |
//! | `looseness` | supervision that is looser than the reference |
//! | `execute` | when one may be set, and how it reaches the tick |
//! | `replies` | what queries answer |

mod address;
mod descriptor;
mod execute;
mod looseness;
pub(super) mod parse;
mod passwords;
mod replies;
mod table;

pub use address::{Address, Addresses, Item, MAX_ADDRESSES, Settings};
pub use descriptor::{Kind, Parameter, When};
pub(super) use looseness::loosened;
pub(super) use replies::parameter_help;
pub use table::PARAMETERS;

//! Variables: names for texts, put in for `$name` or `${name}` anywhere in a line before it is understood.
//!
//! Names of one digit are local to the macro that runs: 0 is how many arguments it was started with, 1 and 2 are those,
//! the others are free. All other variables belong to their connection, until it starts a macro: then they are those of
//! macros, which all macros and connections share. A connection's own stand before those. A name goes as far as letters,
//! digits and underscores go; `${name}` ends it where one of those follows.
//!
//! | file | idea |
//! |---|---|
//! | `state` | the variables of one owner, and their places in a line |
//! | `scope` | whose variable a name means |
//! | `request` | what lines ask for |
//! | `parse` | what lines mean |
//! | `execute` | what lines do |

mod execute;
pub(super) mod parse;
mod request;
mod scope;
mod state;

pub use request::{MAX_NAMED_VARIABLES, VariableRequest};
pub use state::MAX_VARIABLES;
pub(super) use state::{Locals, Variables, expand, number_text};

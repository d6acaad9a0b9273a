//! Variables: names for texts, put in for `$name` or `${name}` anywhere in a line before it is understood.
//!
//! Names of one digit are local to the macro that runs: 0 is how many arguments it was started with, 1 and 2 are those,
//! the others are free. All other variables are the controller's, the same for every connection and macro. A name goes
//! as far as letters, digits and underscores go; `${name}` ends it where one of those follows.
//!
//! | file | idea |
//! |---|---|
//! | `state` | the variables there are, and their places in a line |
//! | `request` | what lines ask for |
//! | `parse` | what lines mean |
//! | `execute` | what lines do |

mod execute;
pub(super) mod parse;
mod request;
mod state;

pub use request::{MAX_NAMED_VARIABLES, VariableRequest};
pub use state::MAX_VARIABLES;
pub(super) use state::{Locals, Variables, number_text};

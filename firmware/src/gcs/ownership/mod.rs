//! `OWN`: a connection makes itself the only one that may start motion and change modes, parameters and everything else that motion
//! depends on, until it says `OWN 0` or ends. Everybody may look, and everybody may stop. At first nobody owns and everybody may do
//! everything.
//!
//! | file | idea |
//! |---|---|
//! | `state` | who owns, and since when |
//! | `parse` | `OWN` |
//! | `execute` | `OWN`, and what others may do meanwhile |
//! | `replies` | `OWN?` |

mod execute;
pub(super) mod parse;
mod replies;
mod state;

pub(super) use state::Ownership;

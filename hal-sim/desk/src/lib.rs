//! What an operator uses in front of a controller, be it a simulated one or a board: nothing here knows a machine.
//!
//! | module | idea |
//! |---|---|
//! | `serve` | a controller in this process, for clients over TCP and a pseudo-terminal |
//! | `web` | the page, in front of any controller |
//! | `record` | a record of a controller's data recorder |
//! | `settings` | a controller's settings to a file and back |
//! | [`error_words`] | error numbers in words |

#[cfg(unix)]
mod assets;
pub mod error_words;
#[cfg(unix)]
pub mod record;
#[cfg(unix)]
pub mod serve;
#[cfg(unix)]
pub mod settings;
#[cfg(unix)]
pub mod web;

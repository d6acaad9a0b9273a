//! `ILC`: moves that are repeated, and the tables that are learnt for them.
//!
//! | file | idea |
//! |---|---|
//! | `request` | what lines ask for |
//! | `parse` | what lines mean |
//! | `execute` | what they do |
//! | `replies` | `ILC?` |

mod execute;
pub(super) mod parse;
mod replies;
mod request;

pub(super) use request::LearnAction;

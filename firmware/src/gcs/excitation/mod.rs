//! `EXC`: a known voltage on a motor, to see what the machine is.
//!
//! | file | idea |
//! |---|---|
//! | `request` | what lines ask for |
//! | `parse` | what lines mean |
//! | `execute` | what they do |
//! | `replies` | `EXC?` |

mod execute;
pub(super) mod parse;
mod replies;
mod request;

pub(super) use request::ExcitationRequest;

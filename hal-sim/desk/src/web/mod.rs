//! The page: the stage drawn live in a browser, and driven from there. One more client of the command interface: whatever
//! a page asks for goes over a GCS connection, to the simulated stage or to a controller on a serial line, as a line that any
//! other client could have sent. Over TCP each page has a connection of its own, and one more tells all of them the status; over
//! a serial line they share one.
//!
//! ```text
//! browser -- HTTP: page, scripts, token
//!         \- WebSocket: {"line": "MOV X 1"} -> Viewer -> OwnLine, or queue -> Bridge -> Line -> controller
//!                       status, answers     <- Viewer <-------- Bridge <- Line <----/
//! ```
//!
//! | file | idea |
//! |---|---|
//! | `watch` | which questions are asked over and over |
//! | `bridge` | the thread that owns the line: the status as often as a screen shows it, requests of viewers that share it in between |
//! | `own_line` | over TCP: a viewer's own connection |
//! | `arbiter` | over a serial line: what viewers that share it have for themselves |
//! | `request` | what viewers may send |
//! | `stops` | what was asked for before a stop and waits for its turn |
//! | `guard` | who may look and who may drive |
//! | `password` | the password, where others than this machine may reach the page |
//! | `login` | asking for it |
//! | `http` | connections of browsers, bounded in number and patience |
//! | `viewer` | one browser: status and answers out, requests in |
//! | `life` | whether a page is still there |
//! | `operator` | sequences, commissioning and calibration that run here, and the log of who did what |
//! | `lesson` | the mechanism's three movements, for the page's explanation |
//! | `server`, `shared` | the page's files, the token, the WebSockets; what their handlers share |
//!
//! Nobody is waited for: a viewer that does not read loses status messages and is told how many; a stop from any viewer
//! goes out at once, ahead of everything else.

mod arbiter;
mod bridge;
mod guard;
mod http;
mod lesson;
mod life;
mod login;
mod operator;
mod own_line;
mod password;
mod request;
mod server;
mod shared;
mod stops;
mod viewer;
mod watch;

use std::io;

pub use operator::calibration::{Instruments, SetUp};
pub use operator::runs::Person;
pub use password::new_password;
pub use server::{Page, PageOptions};
pub use watch::questions;

/// Why there is no page.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    /// The address cannot be listened at.
    #[error("cannot serve the page at {address}: {error}")]
    Listen {
        /// As it was asked for.
        address: String,
        /// What the system says.
        error: io::Error,
    },
    /// What is at the other end cannot be a controller.
    #[error("{place}: {reason}")]
    NoController {
        /// Where it was looked for.
        place: String,
        /// What it does that a controller does not.
        reason: String,
    },
    /// A thread or its runtime cannot be started, or there is no randomness to be had.
    #[error("cannot serve the page: {0}")]
    Start(io::Error),
}

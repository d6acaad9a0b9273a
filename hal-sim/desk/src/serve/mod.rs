//! `tripivot serve`: a controller in this process in real time, for any client that speaks GCS, over TCP and a pseudo-terminal.
//!
//! One thread does everything, in turns: the ticks that the wall clock says are due, in small batches, and what has come in
//! meanwhile. It waits for nothing but the clock and the connections together, so no client holds up the stage or another
//! client: sockets never block, every buffer is bounded, a turn carries out so many lines of a client, and no further one of
//! anybody but a stop after half a millisecond; who does not read is disconnected. Who speaks another protocol, a browser
//! above all, is cut off before anything of it is carried out.
//!
//! ```text
//! clock -> Pace -> due ticks -> Controller::tick
//!                               Controller::service, for each Connection: input -> Session -> Output
//! poll(listener, connections) -> accept, read, write
//! ```
//!
//! | file | idea |
//! |---|---|
//! | `controller` | what can be served |
//! | `server` | the turns |
//! | `pace` | ticks from the wall clock |
//! | `connection` | a client: its session, and bytes in and out |
//! | `protocol_check` | whether what comes in is the command language |
//! | `keepalive` | ends of clients that were never told |
//! | `remote` | addresses that other machines can reach |
//! | `output` | replies that wait to be read, bounded |
//! | `terminal` | the pseudo-terminal, on Unix |
//! | `no_terminal` | in its place elsewhere |
//! | `notice` | what is told meanwhile |
//! | `printer` | printing it without waiting for a terminal |

mod connection;
mod controller;
mod keepalive;
mod notice;
mod output;
mod pace;
mod printer;
mod protocol_check;
mod remote;
mod server;
#[cfg(unix)]
mod terminal;
#[cfg(not(unix))]
#[path = "no_terminal.rs"]
mod terminal;

use std::io;

pub use controller::Controller;
pub use keepalive::keep_alive;
pub use notice::Notice;
pub use pace::Pacing;
pub use printer::Printer;
pub use protocol_check::ProtocolCheck;
pub use remote::{REMOTE_MEANS, REMOTE_PAGE_MEANS, check_address, is_remote};
pub use server::Server;

/// What to serve, and where.
#[derive(Clone, Debug)]
pub struct ServeOptions {
    /// Address and port of the TCP server, as text; port 0 takes a free one.
    pub listen: String,
    /// Simulated seconds in a second.
    pub speed: f64,
    /// A pseudo-terminal besides; only Unix has any.
    pub terminal: bool,
}

/// Why nothing can be served.
#[derive(Debug, thiserror::Error)]
pub enum ServeError {
    /// The address cannot be listened at.
    #[error("cannot listen at {listen}: {error}")]
    Listen {
        /// As it was asked for.
        listen: String,
        /// What the system says.
        error: io::Error,
    },
    /// Other machines can reach the address, and nobody has allowed that.
    #[error(
        "{0}: other machines can reach this address, and the command language knows no password; if that is meant, say --allow-remote"
    )]
    Remote(String),
    /// There is no pseudo-terminal to be had.
    #[error("cannot open a pseudo-terminal: {0}")]
    Terminal(io::Error),
    /// Ctrl-C cannot be caught.
    #[error("cannot handle signals: {0}")]
    Signals(io::Error),
    /// Waiting for the connections fails: nothing can be served any more.
    #[error("cannot wait for connections: {0}")]
    Wait(io::Error),
}

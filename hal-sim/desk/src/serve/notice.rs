//! What a server has to tell whoever runs it.

use std::fmt;

use firmware::fault::Fault;

/// Something that happened.
#[derive(Clone, Debug, PartialEq)]
pub enum Notice {
    /// A client connected.
    Connected(String),
    /// A client left.
    Left(String),
    /// As many clients as can be are connected already; a stop is all that is taken from this one.
    TurnedAway(String),
    /// What came is no line of a client but a browser's request, or another protocol: nothing of it was carried out.
    NoClient(String),
    /// What a client sent was refused, or its error was set by a stop or a fault.
    Refused {
        /// The client.
        name: String,
        /// What `ERR?` will answer.
        error: u16,
        /// The last line that it sent, shortened.
        line: String,
    },
    /// A client does not read its replies: it is disconnected, or, on the terminal, they are thrown away.
    Unread(String),
    /// The system accepts no connection.
    NotAccepted(String),
    /// The stage faulted.
    Fault(Fault),
    /// The controller was started again by command.
    Restarted,
    /// The simulation is slower than asked: so many seconds of the wall clock were lost, all in all.
    Behind(f64),
}

impl Notice {
    /// Whether clients can cause it as often as they like.
    pub(super) const fn is_of_clients(&self) -> bool {
        !matches!(self, Self::Fault(_) | Self::Restarted | Self::Behind(_))
    }
}

impl fmt::Display for Notice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Connected(name) => write!(f, "{name}: connected"),
            Self::Left(name) => write!(f, "{name}: left"),
            Self::TurnedAway(name) => {
                write!(f, "{name}: turned away but for a stop, too many clients")
            }
            Self::NoClient(name) => write!(
                f,
                "{name}: sent HTTP or another protocol, cut off; nothing of it was carried out"
            ),
            Self::Refused { name, error, line } if line.is_empty() => {
                write!(f, "{name}: error {error}")
            }
            Self::Refused { name, error, line } => write!(f, "{name}: error {error} after {line}"),
            Self::Unread(name) => write!(f, "{name}: does not read its replies, cut off"),
            Self::NotAccepted(reason) => write!(f, "a connection was not accepted: {reason}"),
            Self::Fault(fault) => write!(f, "fault: {fault}"),
            Self::Restarted => write!(f, "the controller starts again"),
            Self::Behind(lost_s) => {
                write!(
                    f,
                    "the simulation cannot keep up: {lost_s:.1} s lost so far"
                )
            }
        }
    }
}

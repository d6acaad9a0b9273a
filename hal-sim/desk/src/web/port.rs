//! The way to the controller: TCP, or a serial line or pseudo-terminal, opened as a file that is read with patience.

use std::fmt;
use std::fs::File;
use std::io;
use std::net::TcpStream;
use std::os::fd::OwnedFd;
use std::path::PathBuf;

use rustix::fs::{Mode, OFlags, open};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};

/// Where the controller is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Endpoint {
    /// Host and port.
    Tcp(String),
    /// A serial line or a pseudo-terminal.
    Serial {
        /// The device.
        device: PathBuf,
        /// Bits a second.
        baud: u32,
    },
}

impl fmt::Display for Endpoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Tcp(address) => f.write_str(address),
            Self::Serial { device, .. } => write!(f, "{}", device.display()),
        }
    }
}

impl Endpoint {
    /// Opens it.
    pub(super) fn open(&self) -> io::Result<File> {
        match self {
            Self::Tcp(address) => {
                let stream = TcpStream::connect(address)?;
                stream.set_nodelay(true)?;
                Ok(OwnedFd::from(stream).into())
            }
            Self::Serial { device, baud } => {
                let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC;
                let port = open(device, flags, Mode::empty())?;
                let mut settings = tcgetattr(&port)?;
                settings.make_raw();
                settings.set_speed(*baud)?;
                // What came before anybody listened belongs to nobody.
                tcsetattr(&port, OptionalActions::Flush, &settings)?;
                Ok(port.into())
            }
        }
    }
}

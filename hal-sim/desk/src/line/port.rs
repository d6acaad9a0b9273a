//! The way to the controller: TCP, or a serial line or pseudo-terminal.

use std::fmt;
use std::io::{self, Read, Write};
use std::net::TcpStream;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use serialport::{ClearBuffer, SerialPort};

/// How long the other end may take nothing of what is written.
const PATIENCE: Duration = Duration::from_secs(5);
/// Longest single wait for a byte on a serial line. Windows lets nobody write meanwhile, and a stop must go out soon.
const SLICE: Duration = Duration::from_millis(20);

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
    /// Whether everybody there may have a connection of his own.
    pub(crate) const fn is_tcp(&self) -> bool {
        matches!(self, Self::Tcp(_))
    }

    /// Opens it.
    pub(crate) fn open(&self) -> io::Result<Port> {
        match self {
            Self::Tcp(address) => {
                let stream = TcpStream::connect(address)?;
                stream.set_nodelay(true)?;
                Ok(Port::Tcp(stream))
            }
            Self::Serial { device, baud } => {
                let line = serialport::new(device.to_string_lossy(), *baud);
                // A client that is killed would leave its lock on a pseudo-terminal, which its server keeps open.
                #[cfg(unix)]
                let line = line.exclusive(false);
                let port = line.open()?;
                // What came before anybody listened belongs to nobody.
                port.clear(ClearBuffer::Input)?;
                Ok(Port::Serial(port))
            }
        }
    }
}

/// An open way.
pub(crate) enum Port {
    Tcp(TcpStream),
    Serial(Box<dyn SerialPort>),
}

impl Port {
    /// The same way once more, for another thread to write to.
    pub fn try_clone(&self) -> io::Result<Self> {
        Ok(match self {
            Self::Tcp(stream) => Self::Tcp(stream.try_clone()?),
            Self::Serial(port) => Self::Serial(port.try_clone()?),
        })
    }

    /// Reads what has come, or comes within this time; `None` if nothing does, 0 bytes at the end.
    pub fn read_within(&mut self, bytes: &mut [u8], time: Duration) -> io::Result<Option<usize>> {
        let end = Instant::now() + time;
        loop {
            // Zero would be no limit to a socket.
            let left = end
                .saturating_duration_since(Instant::now())
                .max(Duration::from_millis(1));
            let read = match self {
                Self::Tcp(stream) => {
                    stream.set_read_timeout(Some(left))?;
                    stream.read(bytes)
                }
                Self::Serial(port) => {
                    port.set_timeout(left.min(SLICE))?;
                    port.read(bytes)
                }
            };
            match read {
                Err(error) if !is_passing(&error) => return Err(error),
                Err(_) if Instant::now() >= end => return Ok(None),
                Err(_) => {}
                Ok(count) => return Ok(Some(count)),
            }
        }
    }
}

impl Write for Port {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Tcp(stream) => stream.write(bytes),
            Self::Serial(port) => {
                port.set_timeout(PATIENCE)?;
                port.write(bytes)
            }
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Tcp(stream) => stream.flush(),
            Self::Serial(port) => port.flush(),
        }
    }
}

/// Nothing has come yet: systems have two words for that, and a signal may interrupt the wait.
fn is_passing(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut | io::ErrorKind::Interrupted
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::TcpListener;

    /// Nothing, then something, then the end.
    fn check_reading(port: &mut Port, other: &mut impl Write) {
        let mut bytes = [0; 8];
        let (start, time) = (Instant::now(), Duration::from_millis(60));
        assert_eq!(port.read_within(&mut bytes, time).unwrap(), None);
        assert!(start.elapsed() >= time);
        other.write_all(b"0\n").unwrap();
        let long = Duration::from_secs(60);
        assert_eq!(port.read_within(&mut bytes, long).unwrap(), Some(2));
        assert_eq!(&bytes[..2], b"0\n");
    }

    #[test]
    fn a_socket() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap().to_string();
        let mut port = Endpoint::Tcp(address).open().unwrap();
        let (mut other, _) = listener.accept().unwrap();
        check_reading(&mut port, &mut other);
        port.try_clone().unwrap().write_all(b"?").unwrap();
        let mut bytes = [0];
        other.read_exact(&mut bytes).unwrap();
        assert_eq!(&bytes, b"?");
        drop(other);
        let end = port.read_within(&mut bytes, Duration::from_secs(60));
        assert_eq!(end.unwrap(), Some(0));
    }

    #[cfg(unix)]
    #[test]
    fn a_pseudo_terminal_takes_any_rate_and_several_clients() {
        use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
        use std::fs::File;

        let controller = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
        grantpt(&controller).unwrap();
        unlockpt(&controller).unwrap();
        let name = ptsname(&controller, Vec::new()).unwrap();
        let name = name.to_str().unwrap();
        let mut other = File::from(controller);
        let open = |baud| {
            let device = name.into();
            Endpoint::Serial { device, baud }.open().unwrap()
        };
        let mut port = open(921_600);
        check_reading(&mut port, &mut other);
        let mut second = open(123_456);
        second.write_all(b"?").unwrap();
        port.try_clone().unwrap().write_all(b"!").unwrap();
        let mut bytes = [0; 2];
        other.read_exact(&mut bytes).unwrap();
        assert_eq!(&bytes, b"?!");
        drop(other);
        let mut end = |_| port.read_within(&mut bytes, Duration::from_millis(20));
        assert!((0..2).map(&mut end).any(|read| read.is_err()));
    }
}

//! A pseudo-terminal that stands for the controller's serial line.

use std::fs::File;
use std::io::{self, Read, Write};
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::path::{Path, PathBuf};

use rustix::fs::{Mode, OFlags, open};
use rustix::io::ioctl_fionbio;
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};

use super::connection::Port;

/// A pseudo-terminal. Read and written it is the controller's end.
pub(super) struct Terminal {
    /// Does not block.
    controller: File,
    /// Where clients find their end.
    path: PathBuf,
    /// A client's end, kept open: without one the controller's end reads errors between two clients, and a client's settings
    /// are lost.
    _client: OwnedFd,
}

impl Terminal {
    /// A new one, which passes all bytes as they are.
    pub fn open() -> io::Result<Self> {
        let controller = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY)?;
        grantpt(&controller)?;
        unlockpt(&controller)?;
        let name = ptsname(&controller, Vec::new())?;
        let path = PathBuf::from(name.to_string_lossy().into_owned());
        let client = open(&path, OFlags::RDWR | OFlags::NOCTTY, Mode::empty())?;
        let mut settings = tcgetattr(&client)?;
        settings.make_raw();
        tcsetattr(&client, OptionalActions::Now, &settings)?;
        ioctl_fionbio(&controller, true)?;
        Ok(Self {
            controller: controller.into(),
            path,
            _client: client,
        })
    }

    /// Where clients find their end.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The controller's end.
    pub fn into_port(self) -> Box<dyn Port> {
        Box::new(self)
    }
}

impl Read for Terminal {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        self.controller.read(bytes)
    }
}

impl Write for Terminal {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.controller.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.controller.flush()
    }
}

impl AsFd for Terminal {
    fn as_fd(&self) -> BorrowedFd<'_> {
        self.controller.as_fd()
    }
}

//! A pseudo-terminal that stands for the controller's serial line.

use std::fs::File;
use std::io;
use std::os::fd::OwnedFd;
use std::path::PathBuf;

use rustix::fs::{Mode, OFlags, open};
use rustix::io::ioctl_fionbio;
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};

/// A pseudo-terminal.
pub(super) struct Terminal {
    /// The controller's end; does not block.
    pub controller: File,
    /// Where clients find theirs.
    pub path: PathBuf,
    /// A client's end, kept open: without one the controller's end reads errors between two clients, and a client's settings
    /// are lost.
    pub client: OwnedFd,
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
            client,
        })
    }
}

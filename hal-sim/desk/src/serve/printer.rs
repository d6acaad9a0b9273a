//! Prints notices from a thread of its own: a terminal that does not take them must not hold up the stage.

use std::io::{self, Write};
use std::sync::mpsc::{self, Receiver, SyncSender};
use std::thread;
use std::time::Duration;

use super::Notice;

/// Notices that may wait; those that find no room are counted instead.
const WAITING: usize = 1024;
/// How long the end waits for what is still to be printed.
const LAST_WORDS: Duration = Duration::from_secs(1);

/// Prints notices to standard output.
pub struct Printer {
    notices: SyncSender<String>,
    done: Receiver<()>,
    lost: u64,
}

impl Printer {
    /// Starts the thread.
    #[must_use]
    pub fn start() -> Self {
        let (notices, incoming) = mpsc::sync_channel::<String>(WAITING);
        let (finished, done) = mpsc::channel();
        thread::spawn(move || {
            for line in incoming {
                // Nobody needs to listen.
                let _ = writeln!(io::stdout(), "{line}");
            }
            let _ = finished.send(());
        });
        Self {
            notices,
            done,
            lost: 0,
        }
    }

    /// Has it printed; never waits.
    pub fn print(&mut self, notice: &Notice) {
        if self.lost > 0 {
            let line = format!("({} notices could not be printed)", self.lost);
            if self.notices.try_send(line).is_ok() {
                self.lost = 0;
            }
        }
        if self.notices.try_send(notice.to_string()).is_err() {
            self.lost += 1;
        }
    }

    /// Waits a moment until everything is printed.
    pub fn finish(self) {
        drop(self.notices);
        // A terminal that takes nothing is not waited for.
        let _ = self.done.recv_timeout(LAST_WORDS);
    }
}

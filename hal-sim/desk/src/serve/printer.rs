//! Prints notices from a thread of its own: a terminal that does not take them must not hold up the stage.

use std::io::{self, Write};
use std::sync::mpsc::{self, Receiver, SyncSender};
use std::thread;
use std::time::{Duration, Instant};

use super::Notice;

/// Notices that may wait; those that find no room are counted instead.
const WAITING: usize = 1024;
/// Notices in a second that clients can cause; more are counted, so that no client fills a disk.
const PER_SECOND: u32 = 20;
/// How long the end waits for what is still to be printed.
const LAST_WORDS: Duration = Duration::from_secs(1);

/// Prints notices to standard output.
pub struct Printer {
    notices: SyncSender<String>,
    done: Receiver<()>,
    /// Notices that were left out since the last one.
    lost: u64,
    /// When the second began in which so many notices were printed.
    second: Instant,
    printed: u32,
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
            second: Instant::now(),
            printed: 0,
        }
    }

    /// Has it printed, unless there are too many; never waits.
    pub fn print(&mut self, notice: &Notice) {
        if notice.is_of_clients() && !self.has_room(Instant::now()) {
            self.lost += 1;
            return;
        }
        self.tell_lost();
        if self.notices.try_send(notice.to_string()).is_err() {
            self.lost += 1;
        }
    }

    fn has_room(&mut self, now: Instant) -> bool {
        if now.duration_since(self.second) >= Duration::from_secs(1) {
            (self.second, self.printed) = (now, 0);
        }
        self.printed = self.printed.saturating_add(1);
        self.printed <= PER_SECOND
    }

    fn tell_lost(&mut self) {
        let line = format!("({} notices left out)", self.lost);
        if self.lost > 0 && self.notices.try_send(line).is_ok() {
            self.lost = 0;
        }
    }

    /// Waits a moment until everything is printed.
    pub fn finish(mut self) {
        self.tell_lost();
        drop(self.notices);
        // A terminal that takes nothing is not waited for.
        let _ = self.done.recv_timeout(LAST_WORDS);
    }
}

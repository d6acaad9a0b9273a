//! The server, its page, and what it tells meanwhile.

use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::thread::{self, JoinHandle};

use desk::line::Endpoint;
use desk::serve::{Notice, Pacing, ServeOptions, Server};
use desk::web::{Page, PageOptions};
use hal_sim::machine::devices::SettingsFlash;
use hal_sim::rig::ControllerMemory;
use hal_sim::rig::run::RunOptions;
use tripivot::simulated::Simulated;

/// A simulated stage that is served.
pub struct Stage {
    pub address: SocketAddr,
    pub page: Page,
    stop: Arc<AtomicBool>,
    bad_news: Receiver<Notice>,
    thread: JoinHandle<Pacing>,
}

impl Stage {
    pub fn start() -> Self {
        let server = Server::bind(ServeOptions {
            listen: "127.0.0.1:0".into(),
            speed: 1.0,
            terminal: false,
        })
        .expect("a free port");
        let address = server.address().expect("the port");
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = Arc::clone(&stop);
        let (say, bad_news) = channel();
        let thread = thread::spawn(move || {
            let mut memory = ControllerMemory::new();
            let options = RunOptions::default();
            let mut stage = Simulated::new(&mut memory, &options, SettingsFlash::in_memory());
            // Everything else is of clients that do not behave, without end.
            let mut tell = |notice| {
                if matches!(
                    notice,
                    Notice::Fault(_) | Notice::TurnedAway(_) | Notice::NotAccepted(_)
                ) {
                    let _ = say.send(notice);
                }
            };
            server
                .run(&mut stage, &stopped, &mut tell)
                .expect("a server")
        });
        let endpoint = Endpoint::Tcp(address.to_string());
        let page = Page::start(&PageOptions::local("127.0.0.1:0"), endpoint).expect("a free port");
        Self {
            address,
            page,
            stop,
            bad_news,
            thread,
        }
    }

    /// Ends it.
    pub fn end(self, problems: &mut Vec<String>) -> Pacing {
        drop(self.page);
        self.stop.store(true, Ordering::Relaxed);
        let pacing = self.thread.join().expect("the server");
        problems.extend(self.bad_news.iter().map(|notice| notice.to_string()));
        pacing
    }
}

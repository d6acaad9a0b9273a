//! What looking costs the loop of the simulated stage in real time, as a table: `cargo bench -p tripivot --bench viewers`.
//!
//! Viewers are WebSockets as browsers have them, which read as fast as they can; a client moves the stage meanwhile. That looking
//! changes no bit of any tick is a test (`who_looks_changes_no_bit_of_any_tick`); here it is about the wall clock.

#[cfg(unix)]
fn main() {
    table::print();
}

#[cfg(not(unix))]
fn main() {}

#[cfg(unix)]
mod table {
    use std::io::{BufRead, BufReader, Write};
    use std::net::{SocketAddr, TcpStream};
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::thread;
    use std::time::{Duration, Instant};

    use desk::line::Endpoint;
    use desk::serve::{Pacing, ServeOptions, Server};
    use desk::web::{Page, PageOptions};
    use hal_sim::machine::devices::SettingsFlash;
    use hal_sim::rig::ControllerMemory;
    use hal_sim::rig::run::RunOptions;
    use tripivot::simulated::Simulated;
    use tungstenite::client;
    use tungstenite::client::IntoClientRequest;

    /// How long each line of the table takes.
    const TIME: Duration = Duration::from_secs(10);
    /// How long a socket may be silent.
    const PATIENCE: Duration = Duration::from_secs(30);

    pub fn print() {
        println!(
            "{:>8} {:>12} {:>12} {:>12} {:>12} {:>20}",
            "viewers", "ticks", "late, mean", "latest", "lost", "pictures a second"
        );
        for viewers in [0, 1, 4, 16] {
            let (pacing, slowest_hz) = measure(viewers);
            let pictures = slowest_hz.map_or_else(|| "-".to_owned(), |rate| format!("{rate:.1}"));
            println!(
                "{viewers:>8} {:>12} {:>9.2} ms {:>9.2} ms {:>9.0} ms {pictures:>20}",
                pacing.ticks,
                1e3 * pacing.late_s / pacing.ticks as f64,
                1e3 * pacing.latest.as_secs_f64(),
                1e3 * pacing.lost.as_secs_f64(),
            );
        }
    }

    /// How the loop keeps to the clock with so many viewers, and how many status messages a second the slowest of them gets.
    fn measure(viewers: usize) -> (Pacing, Option<f64>) {
        let options = RunOptions::default();
        let server = Server::bind(ServeOptions {
            listen: "127.0.0.1:0".into(),
            speed: 1.0,
            terminal: false,
        })
        .expect("a free port");
        let address = server.address().expect("the port");
        let stop = AtomicBool::new(false);
        let done = Arc::new(AtomicBool::new(false));
        thread::scope(|scope| {
            let served = scope.spawn(|| {
                let mut memory = ControllerMemory::new();
                let mut stage = Simulated::new(&mut memory, &options, SettingsFlash::in_memory());
                server
                    .run(&mut stage, &stop, &mut |_| {})
                    .expect("a server")
            });
            let page = (viewers > 0).then(|| {
                let endpoint = Endpoint::Tcp(address.to_string());
                Page::start(&PageOptions::local("127.0.0.1:0"), endpoint).expect("a free port")
            });
            let looking: Vec<_> = (0..viewers)
                .filter_map(|_| Some(page.as_ref()?.address()))
                .map(|page| {
                    scope.spawn({
                        let done = Arc::clone(&done);
                        move || look(page, &done)
                    })
                })
                .collect();
            drive(address);
            done.store(true, Ordering::Relaxed);
            let rates = looking
                .into_iter()
                .map(|viewer| viewer.join().expect("a viewer"));
            let slowest = rates.min_by(f64::total_cmp);
            drop(page);
            stop.store(true, Ordering::Relaxed);
            (served.join().expect("the server"), slowest)
        })
    }

    /// Moves to and fro.
    fn drive(address: SocketAddr) {
        let mut stage = TcpStream::connect(address).expect("the server");
        stage.set_read_timeout(Some(PATIENCE)).expect("a socket");
        let mut replies = BufReader::new(stage.try_clone().expect("a socket"));
        let start = Instant::now();
        stage.write_all(b"FRF\n").expect("the server");
        for number in 0_u32.. {
            if start.elapsed() > TIME {
                return;
            }
            let target = if number.is_multiple_of(2) { 40 } else { -40 };
            let lines = format!("MOV X {target} W {target}\nWAC ONT? X = 1\nERR?\n");
            stage.write_all(lines.as_bytes()).expect("the server");
            let mut error = String::new();
            replies.read_line(&mut error).expect("an answer");
            assert_eq!(error, "0\n");
        }
    }

    /// Reads status messages until `done`; how many a second.
    fn look(page: SocketAddr, done: &AtomicBool) -> f64 {
        let stream = TcpStream::connect(page).expect("the page");
        stream.set_read_timeout(Some(PATIENCE)).expect("a socket");
        let mut request = format!("ws://{page}/live")
            .into_client_request()
            .expect("an address");
        let origin = format!("http://{page}").parse().expect("an address");
        request.headers_mut().insert("Origin", origin);
        let (mut socket, _) = client(request, stream).expect("a WebSocket");
        let (start, mut messages) = (Instant::now(), 0);
        while !done.load(Ordering::Relaxed) {
            let message = socket.read().expect("a message");
            messages += u32::from(
                message
                    .to_text()
                    .is_ok_and(|text| text.contains("\"status\"")),
            );
        }
        f64::from(messages) / start.elapsed().as_secs_f64()
    }
}

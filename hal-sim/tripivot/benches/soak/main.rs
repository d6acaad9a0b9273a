//! The served stage under everybody at once: `cargo bench -p tripivot --bench soak`, a minute; `SECONDS=600` for ten.
//!
//! Twenty honest clients and an honest page ask and move; four clients flood, pages die in the middle of a request, others read hardly
//! anything. Nothing honest may be lost or refused, the stage may not fault, and the memory of the process may not grow: that fails the
//! run. How long answers take is told, and means something on a quiet machine only.
//!
//! | file | idea |
//! |---|---|
//! | `stage` | the server, its page, and what it tells meanwhile |
//! | `honest` | who waits for answers, and counts what is wrong |
//! | `hostile` | who does not |
//! | `latency` | how long answers take, in a memory that does not grow |

#[cfg(unix)]
mod honest;
#[cfg(unix)]
mod hostile;
#[cfg(unix)]
mod latency;
#[cfg(unix)]
mod stage;

#[cfg(not(unix))]
fn main() {}

#[cfg(unix)]
fn main() {
    let seconds = std::env::var("SECONDS").map_or(60, |text| text.parse().expect("seconds"));
    let problems = soak::run(std::time::Duration::from_secs(seconds));
    for problem in &problems {
        println!("problem: {problem}");
    }
    assert!(problems.is_empty());
}

#[cfg(unix)]
mod soak {
    use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
    use std::thread;
    use std::time::{Duration, Instant};

    use crate::honest::{self, Tally};
    use crate::hostile;
    use crate::stage::Stage;

    const CLIENTS: usize = 20;
    /// Growth of the process after the first third of the run, with all of its clients in it.
    const GROWTH_BYTES: u64 = 8 << 20;
    /// An address space that is told page by page.
    const PAGE_BYTES: u64 = 4096;

    /// Prints the table; what is not as it should be.
    pub fn run(time: Duration) -> Vec<String> {
        let stage = Stage::start();
        let done = AtomicBool::new(false);
        let deaths = AtomicU64::new(0);
        let (address, page) = (stage.address, stage.page.address());
        let mut problems = Vec::new();
        let (clients, viewer) = thread::scope(|scope| {
            let done = &done;
            let honest: Vec<_> = (0..CLIENTS)
                .map(|number| scope.spawn(move || honest::client(address, number == 0, done)))
                .collect();
            let viewer = scope.spawn(move || honest::page(page, done));
            for flood in hostile::FLOODS {
                scope.spawn(move || hostile::flood(address, flood, done));
            }
            for _ in 0..2 {
                scope.spawn(move || hostile::deaf_client(address, done));
                scope.spawn(move || hostile::slow_page(page, done));
            }
            let deaths = &deaths;
            scope.spawn(move || hostile::dying_pages(page, deaths, done));
            thread::sleep(time / 3);
            let before = resident_bytes();
            let begun = Instant::now();
            while begun.elapsed() < time - time / 3 {
                thread::sleep(Duration::from_millis(100));
            }
            let grown = (resident_bytes().zip(before)).map(|(now, then)| now.saturating_sub(then));
            match grown {
                None => println!("this system does not tell the memory of a process"),
                Some(grown) if grown > GROWTH_BYTES => {
                    problems.push(format!("the process grew by {grown} bytes"));
                }
                Some(_) => {}
            }
            done.store(true, Ordering::Relaxed);
            let mut clients = Tally::default();
            for one in honest {
                clients.add(&one.join().expect("a client"));
            }
            (clients, viewer.join().expect("a page"))
        });
        let pacing = stage.end(&mut problems);
        println!(
            "{:<24}{:>10}{:>10}{:>10}{:>10}",
            "", "answers", "half", "99 %", "longest"
        );
        for (name, tally) in [("20 clients", &clients), ("a page", &viewer)] {
            println!("{name:<24}{tally}");
            problems.extend(
                tally
                    .problems
                    .iter()
                    .map(|problem| format!("{name}: {problem}")),
            );
        }
        let deaths = deaths.load(Ordering::Relaxed);
        println!(
            "beside 4 floods, 2 clients and 2 pages that hardly read, {deaths} pages that died"
        );
        println!(
            "{} ticks, {:.1} s of the wall clock lost",
            pacing.ticks,
            pacing.lost.as_secs_f64()
        );
        if deaths == 0 {
            problems.push("no page died".to_owned());
        }
        problems
    }

    /// Memory of the process, where the system tells it so.
    fn resident_bytes() -> Option<u64> {
        let told = std::fs::read_to_string("/proc/self/statm").ok()?;
        let pages = told.split(' ').nth(1)?.parse::<u64>().ok()?;
        Some(pages * PAGE_BYTES)
    }
}

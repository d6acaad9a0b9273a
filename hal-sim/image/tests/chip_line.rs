//! The serial line of the image on the emulated chip, flooded: what is lost is lost by whole lines. Needs `cargo stage` first.
//!
//! The emulator has no noise on its lines: that damaged bytes take their line with them is for a real one to show.

use hal_sim::machine::devices::{Stage, StageParameters};
use hal_sim::rig::run::RunOptions;
use image::chip::{Bench, LineServer, elf_file};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::ops::ControlFlow::{Break, Continue};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, mpsc};
use std::thread;

/// No line of these is a command, but the beginning of any with the end of any other is one that moves the stage.
const FLOOD: &[u8] = b"MOV X 5               BAD               \n";
/// Answered by 20 KB: 0.2 s in which the command side waits for the line and takes nothing.
const LONG: &[u8] = b"HPA?\n";
const QUESTIONS: &[u8] = b"\nERR?\nMOV? X\n";

/// Ticks of the flood: it ends while a long answer is under way, so that its last line is lost.
const FLOODED: std::ops::Range<u64> = 1_000..5_000;
/// Ticks from one to the next.
const LONG_EVERY: u64 = 3_000;
/// By then the last long answer is through.
const ASK: u64 = 11_000;
const END: u64 = 12_000;

#[test]
fn pieces_of_lines_never_make_up_one() {
    let path = elf_file::find().expect("the image: build it with `cargo stage`");
    let bench = Bench::load(&path, Stage::new(&StageParameters::REFERENCE)).expect("an image");
    let (tell, told) = mpsc::channel();
    let mut answers = Vec::new();
    let run = bench.run(move |period| {
        match period.tick {
            20 => period.send(b"FRF X\n"),
            tick if FLOODED.contains(&tick) => {
                if tick.is_multiple_of(LONG_EVERY) {
                    period.send(LONG);
                }
                while period.unsent() < 64 {
                    period.send(FLOOD);
                }
            }
            ASK => {
                period.received();
                period.send(QUESTIONS);
            }
            tick if tick > ASK => answers.extend(period.received()),
            _ => drop(period.received()),
        }
        if period.tick < END {
            return Continue(());
        }
        tell.send(String::from_utf8_lossy(&answers).into_owned())
            .expect("the test waits");
        Break(())
    });
    assert_eq!(run.expect("a run").gaps, Vec::<String>::new());
    let answers = told.recv().expect("the last period");
    // It stands where it was found.
    let place_mm = answers
        .strip_prefix("304\nX=")
        .and_then(|x| x.trim_end().parse::<f64>().ok());
    assert!(place_mm.is_some_and(|x| x.abs() < 1e-4), "{answers}");
}

/// The first line of the answer to a client that comes and goes.
fn asked(address: SocketAddr, lines: &str) -> String {
    let mut client = TcpStream::connect(address).expect("a connection");
    client.write_all(lines.as_bytes()).expect("sent");
    let mut answer = String::new();
    BufReader::new(client)
        .read_line(&mut answer)
        .expect("an answer");
    answer
}

/// Over TCP, for clients that have no serial line: a browser is none of them.
#[test]
fn what_a_browser_sends_is_cut_off_before_the_chip_hears_it() {
    let server = LineServer::bind("127.0.0.1:0").expect("a free port");
    let address = server.address().expect("its place");
    let stop = Arc::new(AtomicBool::new(false));
    let stopped = Arc::clone(&stop);
    let serving =
        thread::spawn(move || server.run(&RunOptions::default(), stopped, |_| {}).is_ok());
    let mut browser = TcpStream::connect(address).expect("a connection");
    browser
        .write_all(b"POST / HTTP/1.1\r\nHost: stage\r\n\r\nFRF X\n")
        .expect("sent");
    let mut heard = Vec::new();
    // Closed with what it sent unread, the connection may end in a reset.
    let _ = browser.read_to_end(&mut heard);
    assert_eq!(heard, b"");
    assert_eq!(asked(address, "FRF? X\n"), "X=0\n");
    // The line does not tell the chip that its client is gone; its constant velocity ends all the same.
    assert_eq!(asked(address, "FRF X\nJOG W 20\nJOG? W\n"), "W=20\n");
    assert_eq!(asked(address, "JTM?\n"), "0\n");
    assert_eq!(asked(address, "JOG? W\n"), "W=0\n");
    stop.store(true, Ordering::Relaxed);
    assert!(serving.join().expect("no panic"));
}

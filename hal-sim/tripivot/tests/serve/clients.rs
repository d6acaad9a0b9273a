//! `tripivot serve` as its clients meet it: over TCP and the pseudo-terminal, several at once, some of them badly behaved.

use std::fs::OpenOptions;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{Shutdown, SocketAddr};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::served::{Client, PATIENCE, Served, connect};
use desk::serve::Notice;

#[test]
fn every_client_has_its_own_errors_and_drives_the_same_stage() {
    let served = Served::start(1.0, false);
    let (mut one, mut other) = (served.ready(), served.connect());
    let name = one.port.local_addr().unwrap().to_string();
    one.send("MOV X 500\n");
    let refused = served.notice(|notice| matches!(notice, Notice::Refused { .. }));
    assert_eq!(
        refused.to_string(),
        format!("{name}: error 7 after MOV X 500")
    );
    assert_eq!(other.ask("ERR?\n"), "0\n");
    assert_eq!(one.ask("ERR?\n"), "7\n");
    assert_eq!(other.ask("MOV X 2 W 4\nERR?\n"), "0\n");
    assert_eq!(one.ask("WAC ONT? X = 1\nERR?\n"), "0\n");
    assert!((one.value("POS? X\n") - 2.0).abs() < 1e-3);
    assert!((other.value("POS? W\n") - 4.0).abs() < 1e-3);
    drop(other);
    served.notice(|notice| matches!(notice, Notice::Left(_)));
}

#[test]
fn the_terminal_is_one_more_client_and_stays() {
    let served = Served::start(1.0, true);
    let path = served.terminal.clone().unwrap();
    for _ in 0..2 {
        let port = (OpenOptions::new().read(true).write(true))
            .open(&path)
            .unwrap();
        let mut client = Client {
            port,
            received: Vec::new(),
        };
        // Bytes pass as they are: no echo, no CR, no signal.
        assert_eq!(client.ask("CSV?\r\n"), "2.0\n");
        assert_eq!(client.ask("\x05"), "0\n");
        // An echo would come back as a command that nobody knows.
        assert_eq!(client.ask("ERR?\n"), "0\n");
    }
    assert_eq!(served.connect().ask("CSV?\n"), "2.0\n");
}

#[test]
fn a_client_that_only_sends_is_carried_out_and_answered() {
    let served = Served::start(1.0, false);
    let mut client = served.connect();
    client.send("FRF\nWAC ONT? X = 1\nFRF? X\nDEL 100\nSVO? X\n");
    client.port.shutdown(Shutdown::Write).unwrap();
    let mut all = String::new();
    client.port.read_to_string(&mut all).unwrap();
    assert_eq!(all, "X=1\nX=1\n");
}

#[test]
fn a_client_that_does_not_read_is_cut_off_and_holds_nobody_up() {
    let served = Served::start(1.0, false);
    let mut deaf = served.connect();
    let name = deaf.port.local_addr().unwrap().to_string();
    let flood = thread::spawn(move || {
        let lines = "POS?\n".repeat(1000);
        while deaf.port.write_all(lines.as_bytes()).is_ok() {}
    });
    let mut client = served.ready();
    let mut replies = 0;
    loop {
        assert_eq!(client.ask("ERR?\n"), "0\n");
        replies += 1;
        match served.notices.try_recv() {
            Ok(Notice::Unread(who)) => break assert_eq!(who, name),
            Ok(Notice::Fault(fault)) => panic!("{fault}"),
            _ => {}
        }
    }
    flood.join().unwrap();
    assert!(replies > 100, "{replies}");
}

#[test]
fn more_clients_than_there_is_room_for_are_turned_away() {
    let served = Served::start(1.0, false);
    let mut clients: Vec<_> = (0..64).map(|_| served.connect()).collect();
    assert_eq!(clients[63].ask("CSV?\n"), "2.0\n");
    let mut late = served.connect();
    served.notice(|notice| matches!(notice, Notice::TurnedAway(_)));
    // Reset or closed, as the system has it.
    assert_eq!(late.port.read(&mut [0]).unwrap_or(0), 0);
    drop(clients.pop());
    served.notice(|notice| matches!(notice, Notice::Left(_)));
    assert_eq!(served.connect().ask("CSV?\n"), "2.0\n");
}

#[test]
fn time_passes_as_fast_as_asked() {
    for (speed, slowest_s) in [(1.0, 1.0), (0.25, 4.0)] {
        let served = Served::start(speed, false);
        let mut client = served.connect();
        client.ask("CSV?\n");
        let start = Instant::now();
        client.ask("DEL 1000\nERR?\n");
        let wall_s = start.elapsed().as_secs_f64();
        // A machine that is too slow for the simulation may take longer, and says so.
        let behind = (served.notices.try_iter()).any(|n| matches!(n, Notice::Behind(_)));
        assert!(wall_s > slowest_s - 0.05, "{speed}: {wall_s} s");
        assert!(wall_s < slowest_s + 0.5 || behind, "{speed}: {wall_s} s");
    }
}

/// Clients of the load test.
const CLIENTS: usize = 20;
/// Requests of each.
const REQUESTS: usize = 2_000;

/// Polls as fast as it can; the slowest reply.
fn poll(address: SocketAddr) -> Duration {
    let mut client = connect(address);
    let mut slowest = Duration::ZERO;
    for _ in 0..REQUESTS {
        let start = Instant::now();
        let reply = client.ask("POS?\n");
        slowest = slowest.max(start.elapsed());
        assert_eq!(reply.matches('=').count(), 6, "{reply}");
    }
    assert_eq!(client.ask("ERR?\n"), "0\n");
    slowest
}

#[test]
fn load() {
    let served = Served::start(1.0, false);
    let mut driver = served.ready();
    let start = Instant::now();
    let address = served.address;
    let clients: Vec<_> = (0..CLIENTS)
        .map(|_| thread::spawn(move || poll(address)))
        .collect();
    let mut moves = 0;
    while clients.iter().any(|client| !client.is_finished()) {
        let target = if moves % 2 == 0 { 40 } else { -40 };
        let go = format!("MOV X {target} W {target}\nWAC ONT? X = 1\nERR?\n");
        assert_eq!(driver.ask(&go), "0\n");
        moves += 1;
    }
    let wall_s = start.elapsed().as_secs_f64();
    let slowest = (clients.into_iter().map(|client| client.join().unwrap()))
        .max()
        .unwrap();
    assert!(moves > 0);
    served.assert_no_fault();
    // The loop counts what it calls late itself; what the machine the test runs on makes of it is told.
    let statistics = driver.ask("LST?\n");
    assert!(statistics.contains("LATE=0 \n"), "{statistics}");
    let pacing = served.end();
    println!(
        "{} replies to {CLIENTS} clients in {wall_s:.2} s beside {moves} moves, the slowest in {:.1} ms; {} ticks, {:.2} ms late on average and {:.1} ms at most, {:.0} ms lost",
        CLIENTS * REQUESTS,
        slowest.as_secs_f64() * 1e3,
        pacing.ticks,
        pacing.late_s * 1e3 / pacing.ticks as f64,
        pacing.latest.as_secs_f64() * 1e3,
        pacing.lost.as_secs_f64() * 1e3,
    );
}

/// The process, and its first line.
fn tripivot(arguments: &[&str]) -> (Child, String, BufReader<std::process::ChildStdout>) {
    let mut child = Command::new(env!("CARGO_BIN_EXE_tripivot"))
        .arg("serve")
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut out = BufReader::new(child.stdout.take().unwrap());
    let mut line = String::new();
    out.read_line(&mut line).unwrap();
    (child, line, out)
}

#[test]
fn control_c_ends_it_cleanly() {
    let (mut child, line, mut out) =
        tripivot(&["--listen", "127.0.0.1:0", "--web", "off", "--seed", "3"]);
    let address: SocketAddr = line
        .trim()
        .strip_prefix("listening at ")
        .unwrap()
        .parse()
        .unwrap();
    let mut client = connect(address);
    assert_eq!(client.ask("QQQ\nERR?\n"), "2\n");
    let name = client.port.local_addr().unwrap();
    let killed = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(killed.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(0));
    let mut rest = String::new();
    out.read_to_string(&mut rest).unwrap();
    assert_eq!(
        rest,
        format!(
            "settings: those that the simulated machine comes with; kept until it ends\nCtrl-C ends it\n{name}: connected\n{name}: error 2 after QQQ\n"
        )
    );
    // Nothing is left of the connection.
    assert_eq!(client.port.read(&mut [0]).unwrap_or(0), 0);
}

#[test]
fn an_address_that_is_taken_is_said_in_one_line() {
    let served = Served::start(1.0, false);
    let taken = served.address.to_string();
    for arguments in [
        ["--listen", &taken],
        ["--listen", "nowhere"],
        ["--speed", "0"],
    ] {
        let (child, _, _) = tripivot(&arguments);
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(text.lines().count(), 1, "{text}");
    }
}

#[test]
fn a_macro_goes_on_with_nobody_connected() {
    let served = Served::start(20.0, false);
    let mut client = served.ready();
    client.ask(
        "MAC BEG go\nDEL 200\nMOV X 5\nWAC ONT? X = 1\nVAR DONE 1\nMAC END\nMAC START go\nERR?\n",
    );
    drop(client);
    served.notice(|notice| matches!(notice, Notice::Left(_)));
    let mut client = served.connect();
    let end = Instant::now() + PATIENCE;
    while client.ask("RMC?\n") != "\n" {
        assert!(Instant::now() < end, "the macro does not end");
    }
    assert_eq!(client.ask("VAR? DONE\n"), "DONE=1\n");
    assert_eq!(client.ask("MOV? X\n"), "X=5\n");
    served.assert_no_fault();
}

#[test]
fn a_restart_forgets_settings_and_keeps_clients() {
    let served = Served::start(20.0, false);
    let mut client = served.ready();
    assert_eq!(
        client.ask("SPA 1 0x54500100 100\nVAR A 1\nRBT\nERR?\n"),
        "0\n"
    );
    served.notice(|notice| matches!(notice, Notice::Restarted));
    assert_eq!(client.ask("SPA? 1 0x54500100\n"), "1 0x54500100=200\n");
    assert_eq!(client.ask("VAR?\n"), "\n");
    assert_eq!(client.ask("FRF? X\n"), "X=0\n");
    assert_eq!(client.ask("FRF\nWAC ONT? X = 1\nERR?\n"), "0\n");
    served.assert_no_fault();
}

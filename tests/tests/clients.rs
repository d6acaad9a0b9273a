//! What four client programs send, recorded once, and what they are answered. `UPDATE=1 cargo test -p tests --test clients` writes the
//! answers into `tests/clients/`, to be read against what the clients wait for.
//!
//! Time is not recorded, and of the questions whether something still moves most were left out. So a client gets its answer in a
//! millisecond here, waits for a while after such a question, and for rest before it commands anything but a stop. After
//! each command it asks `ERR?`, which were left out too: their answers stand behind `!`.

use firmware::mode::Mode;
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;
use tests::ideal::{Connection, Ideal};

/// Ticks to an answer, and to the next question whether something moves.
const ANSWER_TICKS: u32 = 20;
const POLL_TICKS: u32 = 4_000;
/// Ticks to the answer to `ERR?`, after a reference too.
const ERROR_TICKS: u32 = 100;
/// Longest wait for rest, which a slow move takes.
const PATIENCE_TICKS: u32 = 2_000_000;
/// Questions whether something moves.
const POLLS: [&str; 3] = ["\\x05", "ONT?", "WAC"];
/// How far off numbers of an answer may be.
const CLOSE: f64 = 2e-3;
/// Longest answer that is kept whole: the rest is help.
const LONG: usize = 400;

/// A line of a recording: connection, and the bytes as text.
fn sent(line: &str) -> Option<(usize, &str)> {
    let (number, text) = line.split_once(" > ")?;
    Some((number.parse().ok()?, text))
}

fn bytes(text: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut rest = text.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        rest = match (first, after) {
            (b'\\', [b'n', after @ ..]) => {
                bytes.push(b'\n');
                after
            }
            (b'\\', [b'x', high, low, after @ ..]) => {
                let digits = [*high, *low];
                let digits = std::str::from_utf8(&digits).expect("two digits");
                bytes.push(u8::from_str_radix(digits, 16).expect("two digits"));
                after
            }
            _ => {
                bytes.push(first);
                after
            }
        };
    }
    bytes
}

fn text(bytes: &[u8]) -> String {
    let mut text = String::new();
    for &byte in bytes {
        let written = match byte {
            b'\n' => write!(text, "\\n"),
            b' '..=b'~' => write!(text, "{}", char::from(byte)),
            _ => write!(text, "\\x{byte:02x}"),
        };
        written.expect("a string takes all");
    }
    if text.len() > LONG {
        let end = text.len() - 60;
        text = format!("{} ... {}", &text[..60], &text[end..]);
    }
    text
}

/// Whether a client sends this only once the stage has come to rest: anything but questions and stops.
fn waits(input: &[u8]) -> bool {
    let word = input
        .trim_ascii_start()
        .split(u8::is_ascii_whitespace)
        .next();
    let word = word.unwrap_or_default();
    let is_single = word.first().is_none_or(|byte| *byte < b' ');
    !(is_single || word.ends_with(b"?") || [&b"STP"[..], b"HLT"].contains(&word))
}

fn run_to_rest(stage: &mut Ideal) {
    let moves = |stage: &Ideal| {
        stage
            .sample()
            .is_some_and(|sample| sample.mode == Mode::Moving)
    };
    for _ in 0..PATIENCE_TICKS {
        if !moves(stage) {
            return;
        }
        stage.tick();
    }
}

/// The recording with today's answers.
fn replayed(recording: &str) -> String {
    let mut stage = Ideal::new(0);
    stage.flicker = true;
    stage.run(100);
    let mut numbers = Vec::new();
    let mut replayed = String::new();
    for line in recording.lines() {
        let Some((number, sent)) = sent(line) else {
            if line.starts_with('#') {
                writeln!(replayed, "{line}").expect("a string takes all");
            }
            continue;
        };
        let place = numbers.iter().position(|known| *known == number);
        let place = place.unwrap_or_else(|| {
            numbers.push(number);
            stage.connections.push(Connection::default());
            numbers.len() - 1
        });
        let mut input = bytes(sent);
        if waits(&input) {
            run_to_rest(&mut stage);
        }
        // The rest of a line came in a segment of its own.
        let is_cut = input.last().is_some_and(|byte| *byte > b' ');
        stage.connections[place].input.append(&mut input);
        stage.run(ANSWER_TICKS);
        if is_cut {
            stage.connections[place].input.push(b'\n');
            stage.run(ANSWER_TICKS);
        }
        writeln!(replayed, "{number} > {sent}").expect("a string takes all");
        let answer = std::mem::take(&mut stage.connections[place].output);
        if !answer.is_empty() {
            writeln!(replayed, "{number} < {}", text(&answer)).expect("a string takes all");
        }
        if !sent.contains('?') && !sent.starts_with("\\x") {
            stage.connections[place].input.extend_from_slice(b"ERR?\n");
            stage.run(ERROR_TICKS);
            let error = std::mem::take(&mut stage.connections[place].output);
            let error = String::from_utf8_lossy(&error);
            writeln!(replayed, "{number} ! {}", error.trim_end()).expect("a string takes all");
        }
        if POLLS.iter().any(|poll| sent.contains(poll)) {
            stage.run(POLL_TICKS);
        }
    }
    replayed
}

/// Whether two answers are the same but for digits that noise makes.
fn is_close(one: &str, other: &str) -> bool {
    let words = |text: &str| -> Vec<String> {
        text.split([' ', '='])
            .flat_map(|word| word.split("\\n"))
            .map(str::to_owned)
            .collect()
    };
    let (one, other) = (words(one), words(other));
    one.len() == other.len()
        && one.iter().zip(&other).all(|(one, other)| {
            let numbers = one.parse::<f64>().ok().zip(other.parse::<f64>().ok());
            one == other || numbers.is_some_and(|(one, other)| (one - other).abs() < CLOSE)
        })
}

/// Whether today's answers are those recorded; they.
fn assert_as_recorded(name: &str) -> String {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("clients/{name}.txt"));
    let kept = fs::read_to_string(&path).expect("a recording");
    let replayed = replayed(&kept);
    if std::env::var_os("UPDATE").is_some() {
        fs::write(&path, &replayed).expect("a file");
        return replayed;
    }
    assert_eq!(
        kept.lines().count(),
        replayed.lines().count(),
        "{name}: answers more, or fewer"
    );
    for (number, (kept, now)) in (1..).zip(kept.lines().zip(replayed.lines())) {
        assert!(
            is_close(kept, now),
            "{name}, line {number}: {kept:?}, now {now:?}"
        );
    }
    replayed
}

#[test]
fn bliss_is_answered() {
    assert_as_recorded("bliss");
}

#[test]
fn epics_is_answered() {
    let replayed = assert_as_recorded("epics");
    // Whatever was recorded: the centre of rotation is taken, but for T.
    let lines: Vec<_> = replayed.lines().collect();
    let centres = lines.windows(2).filter(|pair| pair[0].contains(" > SPI "));
    let mut taken = 0;
    for pair in centres.filter(|pair| !pair[0].contains('?')) {
        assert!(pair[1].ends_with(" ! 0"), "{pair:?}");
        taken += 1;
    }
    assert_eq!(taken, 5);
}

#[test]
fn micro_manager_is_answered() {
    assert_as_recorded("micro-manager");
}

#[test]
fn pipython_is_answered() {
    assert_as_recorded("pipython");
}

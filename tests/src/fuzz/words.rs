//! Lines to send: some that mean something, some nearly, some nothing at all.

use firmware::gcs::PARAMETERS;
use hal_sim::random::Random;

/// Lines that mean something; `{x}` a length, `{w}` an angle, `{n}` any number, `{p}` a parameter, `{v}` a variable, `{m}` a
/// macro, `{a}` an axis, `{c}` a condition, `{i}` a small whole number.
const LINES: &[&str] = &[
    "MOV X {x}",
    "MOV X {x} Y {x}",
    "MOV X {x} Y {x} W {w}",
    "MOV W {w}",
    "MVR X {x} W {w}",
    "MVR {a} {n}",
    "MOV {a} {n}",
    "SVO {a} {i}",
    "FRF",
    "FRF",
    "FRF",
    "FLC\nFRF",
    "HLT",
    "STP",
    "VLS {n}",
    "VLS 150",
    "NLM {a} {n}",
    "PLM {a} {n}",
    "SSL {a} {i}",
    "SPA 1 {p} {n}",
    "SPA 1 {p}",
    "SPA 1 {p} 1 {p}",
    "SPA? 1 {p}",
    "CCL 1 ADVANCED",
    "CCL {i}",
    "DEL {i}",
    "WAC ONT? {a} = 1",
    "WAC {c}",
    "VAR {v} {n}",
    "VAR {v}",
    "ADD {v} ${v} {n}",
    "MOV X ${v}",
    "MAC BEG {m}\nMOV X {x}\nWAC ONT? X = 1\nADD {v} ${v} 1\nJRC -3 VAR? {v} < 5\nMAC END",
    "MAC BEG {m}\nDEL {i}\nMAC START {m} {n}\nMEX {c}\nJRC {i} {c}\nMAC END",
    "MAC BEG {m}\nMOV X $1\nMAC END",
    "MAC BEG {m}",
    "MAC END",
    "MAC START {m} {n}",
    "MAC NSTART {m} {i}",
    "MAC STOP",
    "MAC DEL {m}",
    "JRC {i} {c}",
    "MEX {c}",
    "HBT {n}",
    "HBT 0",
    "TRA? X {n} W {n}",
    "VMO? X {x} Y {x}",
    "LST",
    "WPA 100",
    "WPA 100 1 {p}",
    "RPA",
    "RPA 1 {p}",
    "RBT",
];

const NUMBERS: &[&str] = &[
    "0",
    "1",
    "-1",
    "0.5",
    "79.9",
    "80",
    "80.1",
    "1e-9",
    "1e9",
    "-1e300",
    "1e400",
    "nan",
    "inf",
    "",
    "1e",
    "--1",
    "0x10",
    "3600000",
    "4294967296",
    "20",
    "200",
    "0.001",
];
const AXES: &[&str] = &["X", "Y", "Z", "U", "V", "W", "x", "Q", "ALL", ""];
const NAMES: &[&str] = &[
    "A",
    "b",
    "COUNT",
    "1",
    "2",
    "0",
    "a_rather_long_one",
    "",
    "-",
];
const QUERIES: &[&str] = &[
    "ONT? X",
    "POS? W",
    "VAR? A",
    "VAR? COUNT",
    "SVO? X",
    "CSV?",
    "MOV? Q",
];
const OPERATORS: &[&str] = &["=", "!=", "<", "<=", ">", ">=", "=>", ""];
const BYTES: &[u8] = b"\x03\x04\x05\x06\x07\x08\x09\x18\n\r \t$={}\x00\xFF";

/// The next line or lines, LF and all; `names` are the names of all commands.
pub fn line(random: &mut Random, names: &[String]) -> Vec<u8> {
    let text = if random.once_in(4) {
        jumble(random, names)
    } else {
        let template = *random.pick(LINES);
        filled(random, template)
    };
    let mut bytes = text.into_bytes();
    bytes.push(b'\n');
    if random.once_in(5) {
        mutate(random, &mut bytes);
    }
    bytes
}

/// Any command with anything behind it.
fn jumble(random: &mut Random, names: &[String]) -> String {
    let mut text = random.pick(names).clone();
    for _ in 0..random.index(6) {
        let pattern = *random.pick(&[
            "{a}", "{n}", "{x}", "{p}", "{v}", "{m}", "{i}", "{c}", "${v}",
        ]);
        text.push(' ');
        text += &filled(random, pattern);
    }
    text
}

fn filled(random: &mut Random, template: &str) -> String {
    let mut text = String::new();
    let mut rest = template;
    while let Some(at) = rest.find('{') {
        text += &rest[..at];
        text += &value(random, &rest[at + 1..at + 2]);
        rest = &rest[at + 3..];
    }
    text + rest
}

fn value(random: &mut Random, kind: &str) -> String {
    match kind {
        "x" => format!("{:.3}", random.between(-60.0, 60.0)),
        "w" => format!("{:.2}", random.between(-720.0, 720.0)),
        "i" => format!("{}", random.index(8) as i32 - 2),
        "a" => (*random.pick(AXES)).to_owned(),
        "v" | "m" => (*random.pick(NAMES)).to_owned(),
        "p" => parameter(random),
        "c" => {
            let (query, operator) = (random.pick(QUERIES), random.pick(OPERATORS));
            format!("{query} {operator} {}", random.pick(NUMBERS))
        }
        _ => (*random.pick(NUMBERS)).to_owned(),
    }
}

/// A parameter, and a value somewhere in its range or a little beyond.
fn parameter(random: &mut Random) -> String {
    let parameter = random.pick(PARAMETERS);
    let [lowest, highest] = parameter.range;
    let mut value = random.between(lowest, lowest + (highest - lowest) * 1.05);
    if random.once_in(2) {
        value = value.round();
    }
    format!("0x{:X} {value}", parameter.id)
}

fn mutate(random: &mut Random, bytes: &mut Vec<u8>) {
    for _ in 0..=random.index(4) {
        let at = random.index(bytes.len() + 1);
        match random.index(5) {
            0 => bytes.insert(at, *random.pick(BYTES)),
            1 => bytes.insert(at, random.bits() as u8),
            2 => bytes.truncate(at),
            3 => drop(bytes.drain(at.saturating_sub(random.index(6))..at)),
            _ => {
                let piece = bytes[..at].to_vec();
                bytes.extend(piece);
            }
        }
    }
}

//! What viewers may send: a line for the controller, with the token that came with the page.

use firmware::gcs::LINE_BYTES;
use serde::Deserialize;

/// Longest message, bytes.
pub(super) const MESSAGE_BYTES: usize = 4096;

/// A message of a viewer.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Request {
    /// Comes back with the answer.
    pub id: u64,
    /// Served with the page.
    pub token: String,
    /// For the controller.
    pub line: String,
    /// Whoever uses the page, for the log.
    #[serde(default)]
    pub who: String,
}

/// A request that goes to the controller.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Wanted {
    /// At once, ahead of everything.
    Stop,
    /// In its turn.
    Line(String),
}

/// Why a request does not go to the controller.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub(super) enum Refusal {
    #[error("not a request: {0}")]
    Malformed(String),
    #[error("the token is wrong: reload the page")]
    Token,
    #[error("an empty line")]
    Empty,
    #[error("a line of more than {LINE_BYTES} bytes")]
    Long,
    #[error("a character that is not printable ASCII")]
    Character,
    #[error(
        "{0} would change what other pages say, which share this serial line: use a connection of your own"
    )]
    Shared(String),
    #[error("too many requests at once")]
    TooMany,
    #[error("not sent: a stop came before its turn")]
    Stopped,
    #[error("not connected to the controller")]
    Offline,
    #[error(
        "the connection to the controller broke: whether the line was carried out is not known"
    )]
    Broken,
}

/// Words that hold up the lines behind them, make them part of a macro, change what they mean, or promise to be heard.
const OWN_CONNECTION: [&str; 6] = ["WAC", "DEL", "VAR", "ADD", "HBT", "JTM"];

/// The request in a message.
pub(super) fn read(message: &str) -> Result<Request, Refusal> {
    serde_json::from_str(message).map_err(|error| Refusal::Malformed(error.to_string()))
}

/// What a line asks for, if it may be asked for here: over a line that viewers share, nothing that changes what others say.
pub(super) fn check(line: &str, is_shared: bool) -> Result<Wanted, Refusal> {
    let line = line.trim();
    if line.is_empty() {
        return Err(Refusal::Empty);
    }
    if line.len() > LINE_BYTES {
        return Err(Refusal::Long);
    }
    if !line.bytes().all(|byte| (b' '..=b'~').contains(&byte)) {
        return Err(Refusal::Character);
    }
    let line_upper = line.to_ascii_uppercase();
    let mut words = line_upper.split_whitespace();
    let (word, next) = (words.next().unwrap_or_default(), words.next());
    if word == "STP" || word == "#24" {
        return Ok(Wanted::Stop);
    }
    if is_shared && line.contains('$') {
        return Err(Refusal::Shared("$".to_owned()));
    }
    let records = word == "MAC" && matches!(next, Some("BEG" | "END"));
    if is_shared && (OWN_CONNECTION.contains(&word) || records) {
        return Err(Refusal::Shared(word.to_owned()));
    }
    Ok(Wanted::Line(line.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_stop_is_a_stop_however_it_is_written() {
        for line in ["STP", " stp ", "#24"] {
            assert_eq!(check(line, true), Ok(Wanted::Stop), "{line}");
            assert_eq!(check(line, false), Ok(Wanted::Stop), "{line}");
        }
        assert_eq!(check("STPX", true), Ok(Wanted::Line("STPX".into())));
    }

    #[test]
    fn what_would_hold_up_the_others_is_refused() {
        for line in [
            "WAC ONT? X = 1",
            "del 100",
            "MAC BEG TOUR",
            "mac end",
            "VAR Q MAC",
            "$Q BEG TRAP",
            "MOV X $1",
            "add A 1 2",
            "HBT 0",
            "JTM 0",
        ] {
            assert!(
                matches!(check(line, true), Err(Refusal::Shared(_))),
                "{line}"
            );
            assert!(check(line, false).is_ok(), "{line}");
        }
        assert!(check("MAC START TOUR", true).is_ok());
    }

    #[test]
    fn lines_are_single_and_not_too_long() {
        assert_eq!(check("  ", false), Err(Refusal::Empty));
        assert_eq!(check("MOV X 1\nMOV Y 1", false), Err(Refusal::Character));
        assert_eq!(check("MOV X 1\u{18}", false), Err(Refusal::Character));
        assert_eq!(check("MOV X \u{b5}", false), Err(Refusal::Character));
        assert!(check(&"X".repeat(LINE_BYTES), false).is_ok());
        assert_eq!(
            check(&"X".repeat(LINE_BYTES + 1), false),
            Err(Refusal::Long)
        );
    }

    #[test]
    fn a_message_is_all_of_it_or_nothing() {
        assert!(read(r#"{"id":1,"token":"t","line":"MOV X 1"}"#).is_ok());
        for message in [
            "",
            "MOV X 1",
            "[]",
            r#"{"id":1,"line":"MOV X 1"}"#,
            r#"{"id":-1,"token":"t","line":"MOV X 1"}"#,
            r#"{"id":1,"token":"t","line":"MOV X 1","more":1}"#,
        ] {
            let refusal = read(message).unwrap_err();
            assert!(
                refusal.to_string().starts_with("not a request: "),
                "{refusal}"
            );
        }
    }

    proptest! {
        #[test]
        fn no_text_smuggles_a_second_line_or_a_byte_command(line in any::<String>()) {
            if let Ok(Wanted::Line(line)) = check(&line, true) {
                prop_assert!(line.bytes().all(|byte| (b' '..=b'~').contains(&byte)));
                prop_assert!((1..=LINE_BYTES).contains(&line.len()));
            }
        }
    }
}

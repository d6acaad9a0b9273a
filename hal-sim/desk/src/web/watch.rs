//! Which questions are asked over and over, for all viewers together.

/// For every status message: what moves.
pub(super) const FAST: &[&str] = &["MON?"];

/// Every so many status messages these are asked besides.
pub(super) const SLOW_EVERY: u32 = 6;

/// What changes seldom. The error is asked for last, so that a fault's or a stop's is not taken for that of the next line
/// of a viewer.
const SLOW: &[&str] = &[
    "POS? X Y W",
    "MOV? X Y W",
    "ONT? X",
    "SVO? X",
    "FRF? X",
    "VLS?",
    "FLT?",
    "CMS?",
    "LST?",
    "JOG? X Y W",
    "SPI?",
    "KEN?",
    "OWN?",
    "ERR?",
];

/// All of them, line by line.
pub fn questions() -> impl Iterator<Item = &'static str> {
    FAST.iter().chain(SLOW).copied()
}

/// Those of the seldom asked that a controller with this `HLP?` answers.
pub(super) fn slow(help: &str) -> Vec<&'static str> {
    let known = |question: &&&str| {
        let word = question.split(' ').next().unwrap_or_default();
        help.lines()
            .any(|line| line.split(' ').next() == Some(word))
    };
    SLOW.iter().filter(known).copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_asked_that_would_not_be_answered() {
        let help = "The following commands are available:\nERR? get error\nPOS? [{<axis>}] get position\nVLS? get\nend of help";
        assert_eq!(slow(help), ["POS? X Y W", "VLS?", "ERR?"]);
    }
}

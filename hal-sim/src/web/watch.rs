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
    "LST?",
    "JOG? X Y W",
    "SPI?",
    "KEN?",
    "ERR?",
];

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
    use crate::host::Host;
    use crate::run::{IDENTITY, RunOptions, controller_parameters, stage_parameters};
    use firmware::gcs::{Interpreter, Session};
    use firmware::queues::Queues;
    use firmware::recorder::RunningHash;

    /// Ticks between two looks: 60 times a second.
    const LOOK_EVERY: u64 = 333;
    /// Ticks of a run: half a second.
    const TICKS: u64 = 10_000;
    /// Lines of a client, and the ticks after which it sends them.
    const DRIVEN: &[(u64, &str)] = &[
        (0, "FRF"),
        (1_000, "MOV X 30 Y -20 W 45"),
        (2_500, "MOV X -10 W -60"),
        (7_000, "JOG W 90"),
        (9_000, "STP"),
    ];

    #[test]
    fn nothing_is_asked_that_would_not_be_answered() {
        let help = "The following commands are available:\nERR? get error\nPOS? [{<axis>}] get position\nVLS? get\nend of help";
        assert_eq!(slow(help), ["POS? X Y W", "VLS?", "ERR?"]);
    }

    /// Running hash over state, setpoints, measured pivots and duties of every tick of a driven stage, and how many bytes
    /// were answered to those who look, each of whom sends `lines`.
    fn run(viewers: usize, lines: &str) -> (RunningHash, usize) {
        let options = RunOptions::default();
        let parameters = controller_parameters(&options);
        let mut host = Host::new(&stage_parameters(&options), &parameters);
        let mut queues = Queues::new();
        let (mut tick_queues, mut command_queues) = queues.split();
        let mut panel = Interpreter::new(&parameters, IDENTITY);
        let mut client = Session::new();
        let mut looking: Vec<_> = (0..viewers).map(|_| Session::new()).collect();
        let (mut hash, mut replies, mut seen) = (RunningHash::default(), Vec::new(), Vec::new());
        for tick in 0..TICKS {
            host.tick(&mut tick_queues, &mut hash);
            for (_, line) in DRIVEN.iter().filter(|(at, _)| *at == tick) {
                client.receive(format!("{line}\n").as_bytes());
            }
            // Those who look are served first, so that whatever they could hold up they would.
            for (number, session) in (0..).zip(&mut looking) {
                if (tick + number) % LOOK_EVERY == 0 {
                    assert_eq!(session.receive(lines.as_bytes()), lines.len(), "no room");
                }
                (panel.service(session, &mut command_queues, &mut seen)).expect("a vector");
            }
            (panel.service(&mut client, &mut command_queues, &mut replies)).expect("a vector");
        }
        assert_eq!(host.fault(), None);
        (hash, seen.len())
    }

    #[test]
    fn who_looks_changes_no_bit_of_any_tick() {
        let questions: String = [FAST, SLOW]
            .concat()
            .iter()
            .flat_map(|line| [line, "\n"])
            .collect();
        let (alone, _) = run(0, "");
        for viewers in [1, 4] {
            let (watched, bytes) = run(viewers, &questions);
            assert_eq!(watched, alone, "{viewers} viewers");
            let looks = viewers * (TICKS / LOOK_EVERY) as usize;
            assert!(bytes > 500 * looks, "{bytes} bytes for {looks} looks");
        }
        // A hand on it would be noticed.
        let (pushed, _) = run(1, "VLS 100\n");
        assert_ne!(pushed, alone);
    }
}

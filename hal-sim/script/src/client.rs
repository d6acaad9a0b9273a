//! A client that runs a script over the command interface, as any client would: a line, then `ERR?`, then the next line.

use crate::disturbance::Disturbance;
use crate::script::{Line, Script};

/// Runs a script. The same on the host, where bytes go straight to the interpreter, and on the emulated chip, where they go
/// over its USART.
#[derive(Debug)]
pub struct Client {
    lines: Vec<Line>,
    next: usize,
    pending: Option<Pending>,
    received: Vec<u8>,
    idle_polls: u32,
}

/// Polls, one a tick, after which a `WAC` at rest is given up: a minute at 20 kHz.
const PATIENCE: u32 = 1_200_000;

/// A line that was sent, and what of its answer is here.
#[derive(Debug)]
struct Pending {
    line: Line,
    answers: Vec<String>,
    /// Answers still to come, that of `ERR?` included.
    missing: usize,
}

/// What has become of a line.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// A line was carried out; its answer, if it asked for one.
    Done(Line, Option<String>),
    /// A disturbance begins: whoever has the stage carries it out.
    Disturbed(Disturbance),
    /// A line was refused with this error.
    Refused(Line, String),
    /// A `WAC` has waited for a minute in which nothing moved: what it waits for will not come.
    Stuck(Line),
    /// All lines are done.
    Finished,
}

impl Client {
    /// For a script.
    #[must_use]
    pub fn new(script: &Script) -> Self {
        Self {
            lines: script.lines.clone(),
            next: 0,
            pending: None,
            received: Vec::new(),
            idle_polls: 0,
        }
    }

    /// Lines carried out.
    #[must_use]
    pub fn done(&self) -> usize {
        self.next - usize::from(self.pending.is_some())
    }

    /// The line that is being carried out.
    #[must_use]
    pub fn current(&self) -> Option<&Line> {
        self.pending.as_ref().map(|pending| &pending.line)
    }

    /// Takes what the controller has sent, and whether the stage moves; gives what to send and what has happened. To be
    /// called once a tick.
    pub fn poll(&mut self, received: &[u8], moving: bool) -> (Vec<u8>, Option<Event>) {
        self.received.extend_from_slice(received);
        let Some(pending) = &mut self.pending else {
            return self.send_next();
        };
        while pending.missing > 0
            && let Some(answer) = take_answer(&mut self.received)
        {
            pending.answers.push(answer);
            pending.missing -= 1;
        }
        if pending.missing > 0 {
            let waits = pending.line.word() == "WAC";
            self.idle_polls = if waits && !moving {
                self.idle_polls + 1
            } else {
                0
            };
            let stuck = self.idle_polls > PATIENCE;
            return (
                Vec::new(),
                stuck.then(|| Event::Stuck(pending.line.clone())),
            );
        }
        self.idle_polls = 0;
        let Some(Pending {
            line, mut answers, ..
        }) = self.pending.take()
        else {
            return (Vec::new(), None);
        };
        let error = answers.pop().unwrap_or_default();
        let is_done = (error.parse()).is_ok_and(|number| line.is_done_with(number));
        let event = if is_done {
            Event::Done(line, answers.pop())
        } else {
            Event::Refused(line, error)
        };
        (Vec::new(), Some(event))
    }

    fn send_next(&mut self) -> (Vec<u8>, Option<Event>) {
        let Some(line) = self.lines.get(self.next).cloned() else {
            return (Vec::new(), Some(Event::Finished));
        };
        self.next += 1;
        if let Some(disturbance) = line.disturbance {
            return (Vec::new(), Some(Event::Disturbed(disturbance)));
        }
        let mut bytes = match line.single_byte() {
            Some(byte) => vec![byte],
            None => line.text.clone().into_bytes(),
        };
        bytes.extend(b"\nERR?\n");
        let missing = 1 + usize::from(line.asks());
        self.pending = Some(Pending {
            line,
            answers: Vec::new(),
            missing,
        });
        (bytes, None)
    }
}

/// The next whole answer: lines that end in a space go on.
fn take_answer(received: &mut Vec<u8>) -> Option<String> {
    let end = (0..received.len())
        .find(|&i| received[i] == b'\n' && (i == 0 || received[i - 1] != b' '))?;
    let answer: Vec<u8> = received.drain(..=end).collect();
    Some(String::from_utf8_lossy(&answer).trim_end().to_owned())
}

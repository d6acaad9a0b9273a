//! Questions and answers over a GCS connection, be it TCP or a serial line (`port`).
//!
//! A line that is refused may answer or not, so that an answer cannot be told from what follows it. After a line of a
//! viewer come `ERR?` and `*IDN?`, whose answer is known: what came before it is the error, and before that the answer.
//! Another `ERR?` goes before the line, so that the error of a stop or a fault is not taken for the line's own.

mod port;

use std::io::{self, Write};
use std::time::{Duration, Instant};

pub use port::Endpoint;
pub(crate) use port::Port;

/// How long the controller may be silent in the middle of an answer, unless it is known to be slow.
pub(crate) const PATIENCE: Duration = Duration::from_secs(5);
/// How long the line has to be silent before it is taken for empty.
const SILENCE: Duration = Duration::from_millis(50);
/// How long it may go on talking unasked.
const TALK: Duration = Duration::from_secs(3);
/// How long a second connection may take to answer.
const ANOTHER: Duration = Duration::from_secs(1);
/// How often it is asked who it is, where answers to somebody who is gone may come first.
const MEETINGS: usize = 5;
/// Who made it, what it is, its serial number and its version.
const IDENTITY_FIELDS: usize = 4;
/// Longest answer: more than the recorder of any controller holds.
const ANSWER_BYTES: usize = 16 << 20;

/// An open connection.
pub(crate) struct Line {
    port: Port,
    patience: Duration,
    received: Vec<u8>,
    /// How far it was searched for the end of an answer.
    searched: usize,
    identity: String,
}

/// What a line came to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Answer {
    /// Its answer, if it had one: lines without the space at their end.
    pub reply: Option<String>,
    /// What `ERR?` said.
    pub error: u16,
}

impl Line {
    /// Opens it, throws away what is still on its way, and asks who is there; it may be silent for `patience` in the middle of
    /// an answer.
    ///
    /// # Errors
    /// What the port says; `InvalidData` when what is there cannot be a controller.
    pub fn open(endpoint: &Endpoint, patience: Duration) -> io::Result<Self> {
        let mut line = Self {
            port: endpoint.open()?,
            patience,
            received: Vec::new(),
            searched: 0,
            identity: String::new(),
        };
        // Ends a line that somebody left unfinished.
        line.port.write_all(b"\n")?;
        for _ in 0..MEETINGS {
            line.wait_for_silence()?;
            if line.meet()? {
                return Ok(line);
            }
        }
        Err(line.no_controller())
    }

    /// Asks who is there; whether that is what it answers, and nothing else comes. A slow controller may still answer what
    /// somebody asked who has gone since.
    fn meet(&mut self) -> io::Result<bool> {
        self.port.write_all(b"*IDN?\nERR?\n")?;
        self.identity = self.answer()?;
        let is_identity = self.identity.split(',').count() >= IDENTITY_FIELDS;
        let error = self.answer().map_err(|error| {
            if error.kind() == io::ErrorKind::TimedOut && !is_identity {
                self.no_controller()
            } else {
                error
            }
        })?;
        Ok(is_identity && error.parse::<u16>().is_ok() && !self.receive(SILENCE)?)
    }

    fn no_controller(&self) -> io::Error {
        let said = self.identity.escape_debug();
        io::Error::new(
            io::ErrorKind::InvalidData,
            format!(
                "asked who it is it says “{said}”: this is no controller, or the line has another rate"
            ),
        )
    }

    /// Whether a second connection is answered beside the first. Behind a TCP port may lie one serial line, whose next client waits
    /// until the first is gone.
    pub(crate) fn has_another(endpoint: &Endpoint) -> bool {
        let Ok(mut port) = endpoint.open() else {
            return false;
        };
        let asked = port.write_all(b"\n*IDN?\n").is_ok();
        asked && matches!(port.read_within(&mut [0; 1], ANOTHER), Ok(Some(1)))
    }

    fn wait_for_silence(&mut self) -> io::Result<()> {
        let end = Instant::now() + TALK;
        while self.receive(SILENCE)? {
            self.forget();
            if Instant::now() > end {
                return Err(io::Error::new(
                    io::ErrorKind::InvalidData,
                    "it never stops sending: this is no controller that waits for commands, or the line has another rate",
                ));
            }
        }
        self.forget();
        Ok(())
    }

    /// Who answers.
    pub fn identity(&self) -> &str {
        &self.identity
    }

    /// The same connection, to be written to past what is under way: single bytes may stand anywhere.
    pub(crate) fn bypass(&self) -> io::Result<Port> {
        self.port.try_clone()
    }

    /// How long the controller may be silent in the middle of an answer from now on.
    pub(crate) const fn set_patience(&mut self, patience: Duration) {
        self.patience = patience;
    }

    /// Sends questions that are always answered, and gives their answers.
    pub fn ask_known(&mut self, questions: &[&str]) -> io::Result<Vec<String>> {
        let text: String = questions.iter().flat_map(|line| [line, "\n"]).collect();
        self.port.write_all(text.as_bytes())?;
        questions.iter().map(|_| self.answer()).collect()
    }

    /// Sends a line that may be answered or not, or be refused.
    pub fn ask(&mut self, line: &str) -> io::Result<Answer> {
        self.send(line)?;
        self.take_answer()
    }

    /// Sends such a line; [`Line::take_answer`] follows.
    pub(crate) fn send(&mut self, line: &str) -> io::Result<()> {
        (self.port).write_all(format!("ERR?\n{line}\nERR?\n*IDN?\n").as_bytes())
    }

    /// What became of the line that was sent last.
    pub(crate) fn take_answer(&mut self) -> io::Result<Answer> {
        self.answer()?;
        let mut answers = Vec::new();
        while answers.len() < 2 || answers.last() != Some(&self.identity) {
            if answers.len() == 3 {
                return Err(io::Error::other(
                    "the controller answers what was not asked",
                ));
            }
            answers.push(self.answer()?);
        }
        answers.pop();
        let error = answers.pop().and_then(|error| error.parse().ok());
        Ok(Answer {
            reply: answers.pop(),
            error: error.ok_or_else(|| io::Error::other("the controller tells no error number"))?,
        })
    }

    /// The next whole answer: lines that end in a space go on.
    fn answer(&mut self) -> io::Result<String> {
        loop {
            while let Some(end) = self.next_end() {
                let ends_here = end == 0 || self.received[end - 1] != b' ';
                self.searched = end + 1;
                if ends_here {
                    let bytes: Vec<u8> = self.received.drain(..=end).collect();
                    self.searched = 0;
                    return Ok(text(&bytes));
                }
            }
            if self.received.len() > ANSWER_BYTES {
                return Err(io::Error::other("the controller's answer has no end"));
            }
            if !self.receive(self.patience)? {
                let message = "the controller does not answer";
                return Err(io::Error::new(io::ErrorKind::TimedOut, message));
            }
        }
    }

    fn next_end(&self) -> Option<usize> {
        let rest = &self.received[self.searched..];
        let at = rest.iter().position(|&byte| byte == b'\n')?;
        Some(self.searched + at)
    }

    /// Takes what has come, or comes within this time; whether anything has.
    fn receive(&mut self, time: Duration) -> io::Result<bool> {
        let mut bytes = [0; 16 << 10];
        match self.port.read_within(&mut bytes, time)? {
            None => Ok(false),
            Some(0) => Err(io::Error::new(
                io::ErrorKind::UnexpectedEof,
                "the controller has closed the connection",
            )),
            Some(count) => {
                self.received.extend_from_slice(&bytes[..count]);
                Ok(true)
            }
        }
    }

    fn forget(&mut self) {
        self.received.clear();
        self.searched = 0;
    }
}

/// An answer as text, its lines without the space at their end.
fn text(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    let lines: Vec<&str> = text.trim_end().split('\n').map(str::trim_end).collect();
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{BufRead, BufReader};
    use std::net::TcpListener;
    use std::thread;

    const IDENTITY: &str = "Tripivot,XYT-1,7,0.1.0";

    /// A controller whose first answer comes behind these, and whose every one takes so long.
    fn controller(mut late: Vec<&'static str>, pause: Duration) -> Endpoint {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap().to_string();
        thread::spawn(move || {
            let (stream, _) = listener.accept().unwrap();
            let mut replies = stream.try_clone().unwrap();
            for line in BufReader::new(stream).lines().map_while(Result::ok) {
                let reply = match line.as_str() {
                    "*IDN?" => IDENTITY,
                    "ERR?" => "0",
                    "POS? X" => "X=1",
                    _ => continue,
                };
                thread::sleep(pause);
                for reply in late.drain(..).chain([reply]) {
                    replies.write_all(format!("{reply}\n").as_bytes()).unwrap();
                }
            }
        });
        Endpoint::Tcp(address)
    }

    #[test]
    fn late_answers_to_somebody_else_are_not_taken_for_ones_own() {
        let pause = Duration::from_millis(5);
        for late in [
            vec![],
            vec!["0"],
            vec![IDENTITY],
            vec!["0", IDENTITY, "0", "temperature 21.5"],
        ] {
            let mut line = Line::open(&controller(late, pause), PATIENCE).unwrap();
            assert_eq!(line.identity(), IDENTITY);
            let reply = line.ask("POS? X").unwrap().reply;
            assert_eq!(reply.as_deref(), Some("X=1"));
        }
    }

    #[test]
    fn a_slow_controller_needs_patience() {
        let pause = Duration::from_millis(300);
        let hurried = Line::open(&controller(vec![], pause), Duration::from_millis(100));
        assert_eq!(hurried.err().unwrap().kind(), io::ErrorKind::TimedOut);
        let mut line = Line::open(&controller(vec![], pause), PATIENCE).unwrap();
        assert_eq!(line.ask_known(&["POS? X"]).unwrap(), ["X=1"]);
    }
}

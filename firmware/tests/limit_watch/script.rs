//! A script of GCS lines, as a client would send it one by one.
//!
//! `DEL` is the time in which nothing is sent, in ms. `WAC ONT? X = 1` waits until the stage has settled. What stands
//! behind a `#` is no part of a line.

use std::fmt;
use std::ops::Range;

#[derive(Clone, Debug, Default, PartialEq)]
pub struct Script(pub Vec<String>);

/// Waits until the stage has settled.
pub const SETTLE: &str = "WAC ONT? X = 1";

const TICKS_A_MS: f64 = 20.0;

/// What a line asks of who runs the script.
pub enum Step<'a> {
    Pause(u64),
    Settle,
    Send(&'a str),
}

impl Script {
    pub fn parse(text: &str) -> Self {
        let lines = text.lines().map(|line| line.split('#').next());
        let lines = lines.map(|line| line.unwrap_or("").trim().to_string());
        Self(lines.filter(|line| !line.is_empty()).collect())
    }

    pub fn send(&mut self, line: impl Into<String>) {
        self.0.push(line.into());
    }

    pub fn pause(&mut self, ticks: u64) {
        if ticks > 0 {
            self.0.push(format!("DEL {}", ticks as f64 / TICKS_A_MS));
        }
    }

    pub fn without(&self, lines: Range<usize>) -> Self {
        let mut rest = self.0.clone();
        rest.drain(lines);
        Self(rest)
    }

    pub fn steps(&self) -> impl Iterator<Item = Step<'_>> {
        self.0.iter().map(|line| step(line))
    }
}

fn step(line: &str) -> Step<'_> {
    if line == SETTLE {
        return Step::Settle;
    }
    match line.strip_prefix("DEL ") {
        Some(ms) => {
            let ms: f64 = ms.parse().expect("ms");
            Step::Pause((ms * TICKS_A_MS).round() as u64)
        }
        None => Step::Send(line),
    }
}

impl fmt::Display for Script {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|line| writeln!(f, "{line}"))
    }
}

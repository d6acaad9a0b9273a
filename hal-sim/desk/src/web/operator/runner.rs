//! Runs the script line by line, and takes orders meanwhile.

use std::pin::pin;
use std::sync::Arc;

use script::{Line, Script};
use tokio::sync::{mpsc, watch};
use tokio::time::Instant;

use super::journal::Journal;
use super::performer::Performer;
use super::sequence_status::{Answered, Order, Orderer, State, Status};
use crate::web::bridge::{Bridge, json};

/// The task behind a sequence's handle.
pub(super) struct Runner {
    pub incoming: mpsc::UnboundedReceiver<Order>,
    pub bridge: Bridge,
    pub journal: Journal,
    pub status: Status,
    pub tell: watch::Sender<Arc<str>>,
    /// The page that began it or had it go on.
    pub by: Orderer,
    /// Whether the stage is to come to rest at its end.
    pub halts: bool,
}

/// Why it ends before its last line, in words.
struct Ended(String);

impl Runner {
    /// Until the server ends.
    pub async fn run(mut self) {
        while let Some(order) = self.incoming.recv().await {
            let Order::Run {
                name,
                text,
                steps,
                by,
            } = order
            else {
                continue;
            };
            self.by = by;
            self.status.answers.clear();
            match Script::parse(&name, &text) {
                Ok(script) if script.first_disturbance().is_some() => {
                    let at = (script.first_disturbance()).map_or(0, |line| line.number);
                    self.refuse(
                        name,
                        text,
                        format!("line {at} disturbs a simulated stage: `tripivot run` can, a page can not"),
                    );
                }
                Ok(script) => self.play(script, text, steps).await,
                Err(error) => self.refuse(name, text, error.to_string()),
            }
        }
    }

    fn refuse(&mut self, name: String, text: String, reason: String) {
        (self.status.name, self.status.text) = (name, text);
        (self.status.line, self.status.done, self.status.total) = (None, 0, 0);
        self.say(State::Ended, false, format!("{reason}; nothing was sent"));
    }

    async fn play(&mut self, script: Script, text: String, steps: bool) {
        let begun = Instant::now();
        self.status.total = script.lines.len();
        self.status.text = text;
        self.status.name = script.name;
        self.status.done = 0;
        self.halts = false;
        let mut state = State::Running;
        let mut performer = match Performer::new(self.bridge.clone()) {
            Ok(performer) => performer,
            Err(reason) => return self.say(State::Ended, false, reason),
        };
        for (done, line) in script.lines.iter().enumerate() {
            self.status.done = done;
            self.status.line = Some(line.number);
            self.say(state, true, String::new());
            let result = match self.may_go_on().await {
                Ok(()) => {
                    performer.choose_way(&self.by.key).await;
                    self.carry_out(&mut performer, line).await
                }
                Err(ended) => Err(ended),
            };
            if let Err(Ended(reason)) = result {
                if self.halts {
                    performer.halt().await;
                }
                self.say(
                    State::Ended,
                    false,
                    format!("line {}: {}: {reason}", line.number, line.text),
                );
                return;
            }
            let pauses = (steps && done == 0) || self.status.state == State::Pausing;
            state = if pauses {
                State::Paused
            } else {
                State::Running
            };
        }
        self.status.done = self.status.total;
        self.status.line = None;
        let seconds = begun.elapsed().as_secs_f64();
        self.say(
            State::Ended,
            true,
            format!("done: {} lines in {seconds:.1} s", self.status.total),
        );
    }

    /// Waits as long as it pauses.
    async fn may_go_on(&mut self) -> Result<(), Ended> {
        while self.status.state == State::Paused {
            let Some(order) = self.incoming.recv().await else {
                return Err(Ended("the server ends".to_owned()));
            };
            match order {
                Order::Continue { by } => {
                    self.by = by;
                    self.say(State::Running, true, String::new());
                }
                Order::Step { by } => {
                    self.by = by;
                    self.say(State::Pausing, true, String::new());
                }
                other => self.take(other)?,
            }
        }
        Ok(())
    }

    /// Carries out a line, and takes orders meanwhile.
    async fn carry_out(&mut self, performer: &mut Performer, line: &Line) -> Result<(), Ended> {
        let ended = {
            let mut work = pin!(performer.perform(line));
            loop {
                tokio::select! {
                    biased;
                    order = self.incoming.recv() => {
                        let order = order.ok_or_else(|| Ended("the server ends".to_owned()))?;
                        let Err(ended) = self.take(order) else { continue };
                        // What is on its way already arrives before the stop that follows.
                        if !["WAC", "DEL"].contains(&&*line.word()) {
                            let _ = work.await;
                        }
                        break ended;
                    }
                    result = &mut work => {
                        let outcome = result.as_ref().err().map_or("done", |reason| reason.as_str());
                        self.journal.note(&format!("sequence {}", self.status.name), &line.text, outcome);
                        if let Some(reply) = result.map_err(Ended)? {
                            let (number, line) = (line.number, line.text.clone());
                            self.status.answers.push(Answered { number, line, reply });
                        }
                        return Ok(());
                    }
                }
            }
        };
        if !self.halts {
            performer.stop();
        }
        Err(ended)
    }

    /// Orders that need not wait for the line under way.
    fn take(&mut self, order: Order) -> Result<(), Ended> {
        match order {
            Order::Pause if self.status.state == State::Running => {
                self.say(State::Pausing, true, "pauses after this line".to_owned());
            }
            Order::Continue { by } if self.status.state == State::Pausing => {
                self.by = by;
                self.say(State::Running, true, String::new());
            }
            Order::Gone { page } if page == self.by.page && self.status.state != State::Paused => {
                let said = "the page that ran it is gone: it pauses after this line";
                self.say(State::Pausing, false, said.to_owned());
            }
            Order::Stop => {
                self.halts = true;
                return Err(Ended(
                    "ended by an operator, and the stage halted".to_owned(),
                ));
            }
            Order::Stopped { who } => return Err(Ended(format!("STOP by {who}"))),
            _ => {}
        }
        Ok(())
    }

    fn say(&mut self, state: State, good: bool, said: String) {
        // What it pauses for is still told while it does.
        if !(state == State::Paused && said.is_empty()) {
            (self.status.good, self.status.said) = (good, said);
        }
        self.status.state = state;
        self.tell.send_replace(json(&self.status));
    }
}

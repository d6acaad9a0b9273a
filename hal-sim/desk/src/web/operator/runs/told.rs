//! What pages are told of a run: its state, and those who are told each change of it.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use serde::Serialize;
use tokio::sync::watch;

use super::control::Control;
use crate::web::bridge::json;

/// To a page whose order meets another that is under way.
const UNDER_WAY: &str = "another order is under way: it has the stage for itself";

/// What every run is told of.
#[derive(Clone, Debug, Serialize)]
pub(in super::super) struct Run {
    /// Whether something is under way.
    pub runs: bool,
    /// What it is, or was.
    pub what: &'static str,
    /// Whether it ended as it was meant to.
    pub good: bool,
    pub said: String,
}

impl Default for Run {
    fn default() -> Self {
        Self {
            runs: false,
            what: "",
            good: true,
            said: String::new(),
        }
    }
}

/// A state that has it.
pub(in super::super) trait OfRun: Serialize {
    fn run(&mut self) -> &mut Run;
}

/// See the module.
pub(in super::super) struct Told<S> {
    status: Mutex<S>,
    tell: watch::Sender<Arc<str>>,
}

impl<S: OfRun> Told<S> {
    pub fn new(status: S) -> Self {
        let (tell, _) = watch::channel(json(&status));
        Self {
            status: Mutex::new(status),
            tell,
        }
    }

    pub fn receiver(&self) -> watch::Receiver<Arc<str>> {
        self.tell.subscribe()
    }

    pub fn status(&self) -> MutexGuard<'_, S> {
        self.status.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes it, and tells it.
    pub fn change<T>(&self, change: impl FnOnce(&mut S) -> T) -> T {
        let mut status = self.status();
        let result = change(&mut status);
        // Within the lock, so that none overtakes another.
        self.tell.send_replace(json(&*status));
        result
    }

    /// An order begins; `change`: what else does.
    pub fn begins(&self, what: &'static str, change: impl FnOnce(&mut S)) {
        self.change(|status| {
            *status.run() = Run {
                runs: true,
                what,
                ..Run::default()
            };
            change(status);
        });
    }

    /// It is over; `change`: what else is. Whoever is told so may give the next order at once: the way is free before.
    pub fn ends(&self, control: &Control, good: bool, said: String, change: impl FnOnce(&mut S)) {
        control.over();
        self.change(|status| {
            let run = status.run();
            (run.runs, run.good, run.said) = (false, good, said);
            change(status);
        });
    }

    /// An order that comes while another is under way.
    pub fn refuses(&self, what: &'static str) {
        self.change(|status| {
            let run = status.run();
            // Of what runs here, pages are told all along.
            if !run.runs {
                *run = Run {
                    what,
                    good: false,
                    said: UNDER_WAY.to_owned(),
                    ..Run::default()
                };
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Serialize)]
    struct Status {
        run: Run,
    }

    impl OfRun for Status {
        fn run(&mut self) -> &mut Run {
            &mut self.run
        }
    }

    #[test]
    fn what_is_told_to_be_over_is_in_nobodys_way() {
        let run = Run::default();
        let (told, control) = (Told::new(Status { run }), Control::default());
        assert!(control.begin(1));
        told.begins("one", |_| ());
        let ended = |_: &mut Status| assert!(control.begin(2), "not told yet, and free");
        told.ends(&control, true, "done".to_owned(), ended);
        assert!(!told.status().run.runs);
    }
}

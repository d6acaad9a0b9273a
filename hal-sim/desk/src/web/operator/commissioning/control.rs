//! What reaches a run from outside.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// How often a run that waits looks whether the stage was stopped.
const LOOK_EVERY: Duration = Duration::from_millis(100);

/// See the module.
#[derive(Default)]
pub(super) struct Control {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    /// The page whose order is under way.
    page: Option<u64>,
    /// By whom it is to end.
    ended: Option<String>,
    is_done: bool,
}

impl Control {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// An order of a page begins, unless one is under way.
    pub fn begin(&self, page: u64) -> bool {
        let mut state = self.state();
        let is_free = state.page.is_none();
        if is_free {
            *state = State {
                page: Some(page),
                ..State::default()
            };
        }
        is_free
    }

    /// It is over.
    pub fn over(&self) {
        *self.state() = State::default();
    }

    /// Whether what is under way is of this page.
    pub fn is_of(&self, page: u64) -> bool {
        self.state().page == Some(page)
    }

    /// What the person was asked for is done.
    pub fn done(&self) {
        self.state().is_done = true;
        self.changed.notify_all();
    }

    /// Ends what is under way; the first one is told.
    pub fn end(&self, by: &str) {
        let mut state = self.state();
        if state.page.is_some() {
            state.ended.get_or_insert_with(|| by.to_owned());
        }
        self.changed.notify_all();
    }

    /// By whom it is to end.
    pub fn ended(&self) -> Option<String> {
        self.state().ended.clone()
    }

    /// What was said before the person was asked does not count.
    pub fn ask(&self) {
        self.state().is_done = false;
    }

    /// Waits until the person says that it is done, or `is_over`.
    pub fn wait(&self, is_over: impl Fn() -> bool) {
        let mut state = self.state();
        while !(state.is_done || state.ended.is_some() || is_over()) {
            let waited = self.changed.wait_timeout(state, LOOK_EVERY);
            (state, _) = waited.unwrap_or_else(PoisonError::into_inner);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_order_at_a_time_and_the_first_end_counts() {
        let control = Control::default();
        control.end("nobody");
        assert!(control.begin(1) && !control.begin(2));
        assert!(control.is_of(1) && !control.is_of(2));
        assert_eq!(control.ended(), None, "of what was not under way");
        control.end("Ada");
        control.end("Bob");
        assert_eq!(control.ended().as_deref(), Some("Ada"));
        control.wait(|| false);
        control.over();
        assert!(control.begin(2) && control.ended().is_none());
        control.done();
        control.wait(|| false);
        control.ask();
        control.wait(|| true);
    }
}

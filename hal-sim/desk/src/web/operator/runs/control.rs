//! What reaches a run from outside.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// How often a run that waits looks whether the stage was stopped.
const LOOK_EVERY: Duration = Duration::from_millis(100);

/// See the module.
#[derive(Default)]
pub(in crate::web) struct Control {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    /// The page whose order is under way.
    page: Option<u64>,
    /// By whom it is to end.
    ended: Option<String>,
    /// Whether the run knows that.
    knows: bool,
    is_done: bool,
    /// Whether it is to wait where it stands.
    is_paused: bool,
    /// What the person says that an instrument reads.
    reading: Option<String>,
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

    /// By whom it is to end; told once, as what follows brings the stage to rest.
    pub fn ended(&self) -> Option<String> {
        let mut state = self.state();
        if state.knows {
            return None;
        }
        state.knows = state.ended.is_some();
        state.ended.clone()
    }

    /// Whether the run knows that it is to end.
    pub fn knows(&self) -> bool {
        self.state().knows
    }

    /// What was said before the person was asked does not count.
    pub fn ask(&self) {
        self.state().is_done = false;
    }

    /// It waits where it stands, as soon as it can, or goes on.
    pub fn pause(&self, is_paused: bool) {
        self.state().is_paused = is_paused;
        self.changed.notify_all();
    }

    /// Waits while it is paused and not to end.
    pub fn stay_paused(&self) {
        self.wait_while(|state| state.is_paused);
    }

    /// The person says what an instrument reads.
    pub fn read(&self, text: &str) {
        self.state().reading = Some(text.to_owned());
        self.changed.notify_all();
    }

    /// Waits for that; none where it is to end.
    pub fn reading(&self) -> Option<String> {
        self.state().reading = None;
        self.wait_while(|state| state.reading.is_none());
        self.state().reading.take()
    }

    fn wait_while(&self, waits: impl Fn(&State) -> bool) {
        let mut state = self.state();
        while waits(&state) && state.ended.is_none() {
            state = (self.changed.wait(state)).unwrap_or_else(PoisonError::into_inner);
        }
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
    fn what_is_paused_waits_and_ends_all_the_same() {
        let control = Control::default();
        assert!(control.begin(1));
        control.stay_paused();
        control.pause(true);
        std::thread::scope(|scope| {
            let waits = scope.spawn(|| control.stay_paused());
            control.pause(false);
            waits.join().expect("it goes on");
            control.pause(true);
            let waits = scope.spawn(|| (control.stay_paused(), control.reading()));
            control.end("Ada");
            assert_eq!(waits.join().expect("it ends").1, None);
        });
        control.over();
        assert!(control.begin(2));
        control.stay_paused();
    }

    #[test]
    fn a_reading_counts_once_it_is_asked_for() {
        let control = Control::default();
        assert!(control.begin(1));
        control.read("before");
        std::thread::scope(|scope| {
            let waits = scope.spawn(|| control.reading());
            while !waits.is_finished() {
                control.read("1 2 3");
                std::thread::yield_now();
            }
            assert_eq!(waits.join().expect("it was read").as_deref(), Some("1 2 3"));
        });
    }

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
        assert_eq!(control.ended(), None, "it is told once");
        control.wait(|| false);
        control.over();
        assert!(control.begin(2) && control.ended().is_none());
        control.done();
        control.wait(|| false);
        control.ask();
        control.wait(|| true);
    }
}

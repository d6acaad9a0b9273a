//! Whether the stage rests, by what the encoders measure: its motors may have let go of it in motion.

use super::state::Commander;
use crate::mode::Mode;
use crate::queues::Snapshot;

/// So long no pivot may move further. Over 5 mrad/s it does, which friction ends within a micrometre.
const REST_MS: f64 = 20.0;
/// How long a fault is shown as motion at least: clients ask for errors only while something moves.
const FAULT_SHOWN_MS: f64 = 100.0;

impl Commander {
    /// Takes what a snapshot measures; to be called while the snapshot before is still known.
    pub(super) fn watch_rest(&mut self, snapshot: &Snapshot) {
        (self.rest).update(snapshot, self.base_constraints.limits.rate_hz);
        let is_free = matches!(snapshot.mode, Mode::Off | Mode::Fault);
        let was_driven = !matches!(self.mode(), Mode::Off | Mode::Fault);
        let is_at_rest = self.is_at_rest(snapshot.tick);
        if is_free && was_driven && (!is_at_rest || !self.moving_axes.is_empty()) {
            self.slides_since = Some(snapshot.tick);
        }
        let shown = match snapshot.mode {
            Mode::Fault => self.ticks(FAULT_SHOWN_MS),
            _ => 0,
        };
        let is_over = |since: &mut u64| !is_free || is_at_rest && snapshot.tick >= *since + shown;
        self.slides_since.take_if(is_over);
    }

    /// Whether no pivot has moved for a while.
    fn is_at_rest(&self, tick: u64) -> bool {
        tick >= self.rest.since_tick + self.ticks(REST_MS)
    }
}

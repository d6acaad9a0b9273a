//! Whether the stage rests, by what the encoders measure: its motors may have let go of it in motion.

use super::state::Commander;
use crate::control::units::UNITS_PER_RAD;
use crate::mode::Mode;
use crate::queues::Snapshot;
use kinematics::Angle;

/// How far a pivot that rests may move: 0.1 mrad, 10 um on the track, in 2^-32 turns. An operator's hand on the stage moves it by
/// less.
const REST_UNITS: u64 = 68_357;
/// A pivot that is faster is not taken over by the servo, which would have to stop it within a tick: 5 mm/s on the track.
const SLOW_RAD_S: f64 = 0.05;
/// So long no pivot may move further. Over 5 mrad/s it does, which friction ends within a micrometre.
const REST_MS: f64 = 20.0;
/// How long a fault is shown as motion at least: clients ask for errors only while something moves.
const FAULT_SHOWN_MS: f64 = 100.0;

/// Since when the pivots are where they are.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RestWatch {
    pivots: [Angle; 3],
    since_tick: u64,
    /// The pivots of the latest snapshot, and its tick.
    last: ([Angle; 3], u64),
    /// Some pivot was faster than one that the servo may take over.
    pub is_fast: bool,
}

impl RestWatch {
    /// Takes the pivots of a snapshot, so many ticks a second. One whose encoder does not answer is not looked at: it shows no
    /// motion.
    fn update(&mut self, snapshot: &Snapshot, rate_hz: f64) {
        let furthest = |from: &[Angle; 3]| {
            (0..3)
                .filter(|&i| snapshot.encoder_faults[i].is_none())
                .map(|i| (snapshot.pivots[i] - from[i]).units().unsigned_abs())
                .max()
                .unwrap_or(0)
        };
        let (last_pivots, last_tick) = self.last;
        let ticks = snapshot.tick.saturating_sub(last_tick) as f64;
        self.is_fast = furthest(&last_pivots) as f64 > SLOW_RAD_S * UNITS_PER_RAD * ticks / rate_hz;
        self.last = (snapshot.pivots, snapshot.tick);
        if furthest(&self.pivots) > REST_UNITS {
            self.pivots = snapshot.pivots;
            self.since_tick = snapshot.tick;
        }
    }
}

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

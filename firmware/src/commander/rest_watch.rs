//! Since when the measured pivots are where they are, and whether one of them is fast.

use crate::control::units::UNITS_PER_RAD;
use crate::queues::Snapshot;
use kinematics::Angle;

/// How far a pivot that rests may move: 0.1 mrad, 10 um on the track, in 2^-32 turns. An operator's hand on the stage moves it by
/// less.
const REST_UNITS: u64 = 68_357;
/// A pivot that is faster is not taken over by the servo, which would have to stop it within a tick: 5 mm/s on the track.
const SLOW_RAD_S: f64 = 0.05;

/// Since when the pivots are where they are.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RestWatch {
    pivots: [Angle; 3],
    pub since_tick: u64,
    /// The pivots of the latest snapshot, and its tick.
    last: ([Angle; 3], u64),
    /// Some pivot was faster than one that the servo may take over.
    pub is_fast: bool,
}

impl RestWatch {
    /// Takes the pivots of a snapshot, so many ticks a second. One whose encoder does not answer is not looked at: it shows no
    /// motion.
    pub fn update(&mut self, snapshot: &Snapshot, rate_hz: f64) {
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

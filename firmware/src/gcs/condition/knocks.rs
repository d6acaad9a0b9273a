//! Whether something knocks at the pivots: a following error whose rate jumps, over and over. A coupling that is loose does that when its
//! motor's torque turns: the motor runs through the play and hits its end.
//!
//! What is looked at is how the following error's rate changes from one snapshot to the next, as an acceleration. No servo makes that
//! large, as no model of a sound machine is so wrong: what does strikes the ring.

use core::mem::replace;

use crate::control::units::UNITS_PER_RAD;
use crate::mode::Mode;
use crate::queues::Snapshot;

/// What the rate changes by in a knock, rad/s^2. Five within 10 s came to 280 at the most on 24 sound machines in a minute of fast moves; a coupling
/// with play of 0.1 mrad makes 500 to 1,500.
const KNOCK_RAD_S2: f32 = 400.0;
/// Longest time from one snapshot to the next, ticks: over a longer one a knock is no jump any more.
const LONGEST_STEP_TICKS: u8 = 12;
/// A knock rings on for so long, ticks: 5 ms.
const RINGS_TICKS: u32 = 100;
/// So many knocks within so many ticks, 10 s, are told, once in that time.
const TELLING_KNOCKS: u16 = 5;
const WITHIN_TICKS: u32 = 200_000;

/// Knocks at a pivot, as they are told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::gcs) struct Knocks {
    /// The pivot, from 0.
    pub pivot: u8,
    /// How many.
    pub count: u16,
    /// In what time, s.
    pub seconds: f32,
    /// The hardest, rad/s^2.
    pub hardest_rad_s2: f32,
}

/// What was seen of all pivots.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct KnockWatch {
    /// What an error changes by in a knock, over the square of the ticks from one snapshot to the next, 2^-32 turns.
    knock_units: u32,
    /// The lower half of the last snapshot's tick, and how many after the one before it came; 0 without the servo.
    tick: u32,
    step_ticks: u8,
    errors: [i32; 3],
    /// How far these have gone since the snapshot before.
    steps: [i32; 3],
    bridged: [u16; 3],
    /// The knock that still rings.
    ringing: Option<Knock>,
    pivots: [PivotKnocks; 3],
}

/// One knock.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Knock {
    tick: u32,
    /// Where it is hardest: the platform carries it on to the other pivots.
    pivot: u8,
    hardest_rad_s2: f32,
    /// It is none: a reading has come back to where the pivot is.
    is_bridged: bool,
}

/// Knocks at one pivot from the first of them on, for as long as they are told together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct PivotKnocks {
    count: u16,
    first_tick: u32,
    hardest_rad_s2: f32,
}

impl KnockWatch {
    /// For a loop of this rate: nothing has been seen.
    pub fn new(rate_hz: f32) -> Self {
        let per_tick_squared = KNOCK_RAD_S2 * UNITS_PER_RAD as f32 / (rate_hz * rate_hz);
        Self {
            knock_units: per_tick_squared as u32,
            ..Self::default()
        }
    }

    /// Looks at a snapshot; knocks that have to be told.
    pub fn look(&mut self, snapshot: &Snapshot, rate_hz: f32) -> Option<Knocks> {
        self.see(snapshot);
        let tick = self.tick;
        let over = |knock: &mut Knock| tick.wrapping_sub(knock.tick) >= RINGS_TICKS;
        let knock = self.ringing.take_if(over).filter(|it| !it.is_bridged)?;
        let knocks = self.pivots[usize::from(knock.pivot)].take(&knock)?;
        Some(Knocks {
            pivot: knock.pivot,
            count: knocks.count,
            seconds: knock.tick.wrapping_sub(knocks.first_tick) as f32 / rate_hz,
            hardest_rad_s2: knocks.hardest_rad_s2,
        })
    }

    /// A knock begins, or rings on.
    fn see(&mut self, snapshot: &Snapshot) {
        let tick = snapshot.tick as u32;
        let ticks = tick.wrapping_sub(replace(&mut self.tick, tick));
        let mut pivot = 0;
        let mut hardest_units = 0;
        let lasts = self.errors.iter_mut().zip(&mut self.steps);
        for (i, (error, (last, last_step))) in (0..).zip(snapshot.pivot_errors.iter().zip(lasts)) {
            let step = error.wrapping_sub(replace(last, *error));
            let change = step.wrapping_sub(replace(last_step, step)).unsigned_abs();
            if change > hardest_units {
                (pivot, hardest_units) = (i, change);
            }
        }
        let is_driven = matches!(snapshot.mode, Mode::Holding | Mode::Moving);
        let step_ticks = if is_driven {
            u8::try_from(ticks).unwrap_or(0)
        } else {
            0
        };
        let before = replace(&mut self.step_ticks, step_ticks);
        if step_ticks != before || !(1..=LONGEST_STEP_TICKS).contains(&step_ticks) {
            return;
        }
        let ticks_squared = u32::from(step_ticks) * u32::from(step_ticks);
        if hardest_units > self.knock_units * ticks_squared {
            let hardest_rad_s2 =
                KNOCK_RAD_S2 * hardest_units as f32 / (self.knock_units * ticks_squared) as f32;
            self.ring(snapshot, pivot, hardest_rad_s2);
        }
    }

    /// At a pivot, at least.
    #[cold]
    fn ring(&mut self, snapshot: &Snapshot, pivot: u8, hardest_rad_s2: f32) {
        let bridged = snapshot.bridged_frames;
        let is_bridged = bridged != replace(&mut self.bridged, bridged);
        let knock = self.ringing.get_or_insert(Knock {
            tick: self.tick,
            pivot,
            hardest_rad_s2,
            is_bridged,
        });
        knock.is_bridged |= is_bridged;
        if hardest_rad_s2 > knock.hardest_rad_s2 {
            (knock.pivot, knock.hardest_rad_s2) = (pivot, hardest_rad_s2);
        }
    }
}

impl PivotKnocks {
    /// Takes a knock; all of them, if they have to be told.
    fn take(&mut self, knock: &Knock) -> Option<Self> {
        if self.count == 0 || knock.tick.wrapping_sub(self.first_tick) > WITHIN_TICKS {
            *self = Self {
                first_tick: knock.tick,
                ..Self::default()
            };
        }
        self.count += 1;
        self.hardest_rad_s2 = self.hardest_rad_s2.max(knock.hardest_rad_s2);
        (self.count == TELLING_KNOCKS).then_some(*self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE_HZ: f32 = 20_000.0;
    /// What a knock of 1,000 rad/s^2 changes a following error by in 0.2 ms, 2^-32 turns.
    const STEP: i32 = 27_343;

    /// Snapshots of a stage that holds, every fourth tick.
    struct Stage {
        watch: KnockWatch,
        snapshot: Snapshot,
    }

    impl Stage {
        fn holding() -> Self {
            Self {
                watch: KnockWatch::new(RATE_HZ),
                snapshot: Snapshot {
                    mode: Mode::Holding,
                    ..Snapshot::default()
                },
            }
        }

        fn look_after(&mut self, ticks: u64) -> Option<Knocks> {
            self.snapshot.tick += ticks;
            self.watch.look(&self.snapshot, RATE_HZ)
        }

        fn wait(&mut self, ticks: u64) -> Option<Knocks> {
            (0..ticks / 4).fold(None, |told, _| self.look_after(4).or(told))
        }

        /// Errors that jump by this, and what was told until 10 ms later.
        fn knock(&mut self, by: [i32; 3]) -> Option<Knocks> {
            for (error, by) in self.snapshot.pivot_errors.iter_mut().zip(by) {
                *error += by;
            }
            self.wait(200)
        }
    }

    #[test]
    fn five_are_told_of_the_pivot_at_which_they_are_hardest() {
        let mut stage = Stage::holding();
        stage.wait(200);
        for times in 1..5 {
            stage.snapshot.pivot_errors[0] += STEP / 2;
            assert_eq!(stage.look_after(4), None, "{times}");
            assert_eq!(stage.knock([0, STEP, 0]), None, "{times}");
        }
        let told = stage.knock([0, -STEP, STEP / 2]).expect("the fifth");
        assert_eq!((told.pivot, told.count), (1, 5));
        assert!((told.seconds - 0.0408).abs() < 1e-6, "{told:?}");
        assert!((told.hardest_rad_s2 - 1_000.0).abs() < 1.0, "{told:?}");
        assert_eq!(stage.knock([0, STEP, 0]), None);
    }

    #[test]
    fn nothing_is_told_of_what_is_seldom_gentle_or_not_seen_closely() {
        let mut stage = Stage::holding();
        stage.wait(200);
        for _ in 0..10 {
            assert_eq!(stage.knock([STEP / 5, 0, 0]), None);
        }
        for _ in 0..10 {
            assert_eq!(stage.knock([STEP, 0, 0]), None);
            assert_eq!(stage.wait(60_000), None);
        }
        for _ in 0..10 {
            assert_eq!(stage.look_after(8), None);
            stage.snapshot.pivot_errors[2] += STEP;
            assert_eq!(stage.look_after(4), None);
            assert_eq!(stage.look_after(8), None);
            assert_eq!(stage.look_after(400), None);
        }
        stage.snapshot.mode = Mode::Off;
        for _ in 0..10 {
            assert_eq!(stage.knock([0, STEP, 0]), None);
        }
    }
}

//! The test of the motors' leads at every servo on, once the bridges are awake: a voltage to and fro has to drive a current in each motor.
//!
//! At rest the servo asks for next to nothing, so that a lead that is lost, or a bridge that does not do what it is told, would show
//! no earlier than with the next motion. Here it shows before anything is driven.
//!
//! ```text
//! volts       +U     -U      0      0      0       each for PART_TICKS
//!                 ^      ^                         what flows since the beginning, over what should by the servo's model of the winding (R, L)
//! ```
//!
//! As much to as fro: the ring has no momentum at the end, and has moved by some microradians. A bias of the sensor does not matter, and a
//! direction that is stuck shows in one of the two. A third more resistance and inductance than told, with a dead time that takes a volt more
//! than told, leave a share of a half.
//!
//! Nothing is said of a ring that somebody turns meanwhile: what flows then is its back-EMF's.
//!
//! Not while the stage is held: what is large enough to be seen moves the platform by more than it may be off.

mod run;

use crate::control::servo::{PivotServoConfig, compensate_dead_time};
use crate::control::units::UNITS_PER_RAD;
use crate::drivers::bridge::Duty;
use crate::number;

/// The voltage, V: a current of some 0.9 A at the reference drive, with which a winding of 3.6 ohm and 2 mH still drives the half ampere that may be
/// missing.
const VOLTS: f32 = 4.0;
/// Parts of the test, and the ticks of one: 0.2 ms, in which a winding does half of what it does.
const PARTS: u8 = 5;
const PART_TICKS: u8 = 4;
const TICKS: u8 = PARTS * PART_TICKS;
/// The smallest share of the model's current that is one.
const LEAST_SHARE: f32 = 0.4;
/// Share of what a current may be off by at any time that may be missing in any case.
const UNEXPLAINED_SHARE: f32 = 0.5;
/// Way of a ring from which on somebody turns it, 2^-32 turns (0.2 mrad).
const TURNED: u32 = (0.2e-3 * UNITS_PER_RAD) as u32;

/// How far it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::control) struct LeadTest {
    ticks_left: u8,
    motors: [Motor; 3],
}

/// What there is of one motor, in units of its dead time's knee.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Motor {
    /// The current before, as it is measured.
    before: f32,
    /// The current since then by the model.
    model: f32,
}

impl LeadTest {
    /// Begins with the next tick that could drive.
    pub(in crate::control) fn start(&mut self) {
        *self = Self {
            ticks_left: TICKS,
            ..Self::default()
        };
    }

    /// A fault has come in between.
    pub(in crate::control) fn stop(&mut self) {
        self.ticks_left = 0;
    }

    #[inline]
    pub(in crate::control) const fn is_under_way(&self) -> bool {
        self.ticks_left != 0
    }
}

impl Motor {
    /// What is missing of its current, and what may be, where that is less.
    #[inline(never)]
    fn missing(&self, current: f32, unexplained: f32) -> Option<[f32; 2]> {
        let missing = current - self.before - self.model;
        let mut most = (1.0 - LEAST_SHARE) * self.model.abs();
        if most < UNEXPLAINED_SHARE * unexplained {
            most = UNEXPLAINED_SHARE * unexplained;
        }
        // Of its own sign: more than that is no lost lead.
        let is_missing = missing.abs() > most && missing * self.model < 0.0;
        is_missing.then_some([missing, most])
    }

    /// The next duty.
    // One copy of the code: it lies in memory that is short.
    #[inline(never)]
    fn step(&mut self, config: &PivotServoConfig, sign: f32, counts_per_volt: f32) -> Duty {
        let mut volts = VOLTS * sign;
        let room = config.max_counts - config.dead_time_counts;
        if VOLTS * counts_per_volt > room {
            // What the bridge may give is less: so is the current, and where it is under what may be missing nothing is said.
            volts = sign * (room / counts_per_volt);
        }
        self.model += (volts * config.knee_currents_per_volt - self.model) * config.current_step;
        let counts = compensate_dead_time(volts * counts_per_volt, sign, config.dead_time_counts);
        Duty(number::round_ties_even(counts).0 as i16)
    }
}

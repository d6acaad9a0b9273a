//! From encoder frames to a multi-turn pivot angle: which frame is believed, what bridges one that is not.

use crate::drivers::biss::{FrameError, POSITION_BITS, RawFrame, decode};
use crate::fault::FaultKind;
use crate::parameters::{EncoderSetup, Supervision};
use kinematics::Angle;

/// Bits by which an encoder count is left-aligned in a 32-bit fraction of a turn.
const ALIGN: u32 = 32 - POSITION_BITS;

/// How one encoder is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EncoderConfig {
    zero: u32,
    reversed: bool,
    bridged: u8,
    /// Largest believable change of the step from tick to tick, 2^-32 turns.
    change: i32,
}

impl EncoderConfig {
    /// For a tick of `period_s`.
    pub fn new(setup: &EncoderSetup, supervision: &Supervision, period_s: f64) -> Self {
        let radians = supervision.plausible_acceleration_rad_s2 * period_s * period_s;
        Self {
            zero: setup.zero_counts << ALIGN,
            reversed: setup.reversed,
            bridged: supervision.bridged_frames,
            change: (radians / core::f64::consts::TAU * 4_294_967_296.0) as i32,
        }
    }
}

impl EncoderConfig {
    /// Whether a reading means the same angle to both.
    pub fn reads_as(&self, other: &Self) -> bool {
        self.zero == other.zero && self.reversed == other.reversed
    }

    /// What an ideal encoder shows at a pivot angle: for machines that are simulated.
    pub fn counts_at(&self, angle: Angle) -> u32 {
        let fraction = if self.reversed {
            angle.fraction().wrapping_neg()
        } else {
            angle.fraction()
        };
        // To the nearest count.
        fraction
            .wrapping_add(self.zero)
            .wrapping_add(1 << (ALIGN - 1))
            >> ALIGN
    }
}

/// One encoder's state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Encoder {
    angle: Angle,
    step: i32,
    /// Good frames in a row, up to [`READY`].
    good: u8,
    /// Bad frames in a row.
    bad: u8,
    warning: bool,
    reason: Option<FaultKind>,
    /// The last reading that decoded.
    reading: u32,
    /// Frames since then that have repeated it.
    same: u16,
}

/// Good frames in a row, each plausible after the one before, that make an encoder ready.
const READY: u8 = 4;

impl Encoder {
    /// Takes the frame of this tick.
    ///
    /// A frame is believed when it decodes and its step differs from the last one's by no more than the plausible
    /// acceleration, times the square of the ticks since the last good frame. A frame that is not believed is never used:
    /// the angle goes on by the last step, up to [`EncoderConfig`]'s count of them in a row.
    #[inline]
    pub fn take(&mut self, config: &EncoderConfig, frame: &RawFrame) {
        match decode(frame) {
            Ok(reading) => {
                self.warning = reading.warning;
                let fraction = (reading.counts << ALIGN).wrapping_sub(config.zero);
                let fraction = if config.reversed {
                    fraction.wrapping_neg()
                } else {
                    fraction
                };
                self.same = if fraction == self.reading {
                    self.same.saturating_add(1)
                } else {
                    0
                };
                self.reading = fraction;
                self.take_fraction(config, fraction);
            }
            Err(error) => self.miss(
                config,
                match error {
                    FrameError::Silent => FaultKind::EncoderSilent,
                    FrameError::Crc => FaultKind::EncoderCrc,
                    FrameError::Error => FaultKind::EncoderError,
                },
            ),
        }
    }

    #[inline]
    fn take_fraction(&mut self, config: &EncoderConfig, fraction: u32) {
        // After bridged frames the angle has gone on by itself: `moved` is from where it was expected to be.
        let moved = fraction.wrapping_sub(self.angle.fraction()) as i32;
        let surprise = moved.wrapping_sub(self.step).unsigned_abs();
        if self.bad == 0 && self.good == READY && surprise <= config.change.unsigned_abs() {
            self.go_on(moved);
            self.step = moved;
        } else {
            self.regain(config, fraction, moved, surprise);
        }
    }

    /// Takes a frame after a bad one, or one of the first.
    #[cold]
    fn regain(&mut self, config: &EncoderConfig, fraction: u32, moved: i32, surprise: u32) {
        let ticks = i32::from(self.bad) + 1;
        let allowed = config.change.saturating_mul(ticks.saturating_mul(ticks));
        if self.good == 0 {
            self.angle = Angle::from_units(i64::from(fraction));
            self.step = 0;
            self.good = 1;
        } else if surprise <= allowed.unsigned_abs() {
            self.go_on(moved);
            // The mean over the ticks since the last good frame: a line that loses every other one keeps up with the rate.
            self.step = self
                .step
                .wrapping_add(moved.wrapping_sub(self.step) / ticks);
            self.good = (self.good + 1).min(READY);
        } else {
            self.miss(config, FaultKind::EncoderJump);
            return;
        }
        self.bad = 0;
        if self.good == READY {
            self.reason = None;
        }
    }

    #[inline]
    fn go_on(&mut self, step: i32) {
        self.angle = Angle::from_units(self.angle.units().wrapping_add(i64::from(step)));
    }

    #[cold]
    fn miss(&mut self, config: &EncoderConfig, reason: FaultKind) {
        self.reason = Some(reason);
        self.bad = self.bad.saturating_add(1);
        if self.bad > config.bridged || self.good < READY {
            self.good = 0;
        } else {
            self.go_on(self.step);
        }
    }

    /// Why the encoder can not be used; `None` when it can (a few bad frames are bridged).
    #[inline]
    pub fn unusable(&self) -> Option<FaultKind> {
        if self.good == READY {
            None
        } else {
            Some(self.reason.unwrap_or(FaultKind::EncoderSilent))
        }
    }

    /// Takes it for lost, whatever its frames say, until it has been ready anew.
    pub fn give_up(&mut self, reason: FaultKind) {
        self.reason = Some(reason);
        self.good = 0;
        self.same = 0;
    }

    /// How often in a row it has repeated one reading to the bit.
    #[inline]
    pub fn same_readings(&self) -> u16 {
        self.same
    }

    /// What the pivot has moved in the last tick, 2^-32 turns.
    #[inline]
    pub fn step(&self) -> i32 {
        self.step
    }

    /// The pivot's angle.
    #[inline]
    pub fn angle(&self) -> Angle {
        self.angle
    }

    /// Whether the encoder warns.
    pub fn warning(&self) -> bool {
        self.warning
    }

    /// Moves the angle by whole turns to the one nearest to `reference`.
    pub fn unwrap_near(&mut self, reference: Angle) {
        self.angle = self.angle.near(reference);
    }
}

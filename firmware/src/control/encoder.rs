//! From encoder frames to a multi-turn pivot angle: which frame is believed, what bridges one that is not.

use super::subdivision::SubdivisionTable;
use crate::drivers::biss::{
    CheckedFrame, FrameError, POSITION_BITS, RawFrame, check_frame, decode,
};
use crate::fault::FaultKind;
use crate::parameters::{EncoderMounting, Supervision};
use kinematics::Angle;

/// Bits by which an encoder count is left-aligned in a 32-bit fraction of a turn.
const ALIGN_SHIFT: u32 = 32 - POSITION_BITS;

/// How one encoder is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EncoderConfig {
    zero: u32,
    /// What of the largest believable change is no slip, 2^-32 turns.
    ordinary_step_change: u32,
    /// Largest believable change of the step from tick to tick, 2^-32 turns.
    max_step_change: u32,
    /// How much later than the first port it latches, 2^-23 ticks.
    latch_offset: i16,
    /// 1, or -1 where the encoder counts against the pivot's direction.
    direction: i8,
    max_bridged_frames: u8,
}

/// Parts of a tick of [`EncoderConfig`]'s offset, and what is missing to a step's 32 bits.
const OFFSETS_PER_TICK: f64 = 8_388_608.0;
const OFFSET_SHIFT: u32 = 32 - 23;

impl EncoderConfig {
    /// For a tick of `period_s`.
    pub fn new(setup: &EncoderMounting, supervision: &Supervision, period_s: f64) -> Self {
        let radians = supervision.plausible_acceleration_rad_s2 * period_s * period_s;
        let max_step_change = (radians / core::f64::consts::TAU * 4_294_967_296.0) as u32;
        Self {
            zero: setup.zero_counts << ALIGN_SHIFT,
            latch_offset: 0,
            direction: if setup.reversed { -1 } else { 1 },
            max_bridged_frames: supervision.bridged_frames,
            max_step_change,
            ordinary_step_change: max_step_change.min(ORDINARY_STEP_CHANGE),
        }
    }
}

impl EncoderConfig {
    /// The same at a port that latches so much later than the first one; up to 1/256 of a tick.
    #[must_use]
    pub fn latched_later(self, offset_s: f64, period_s: f64) -> Self {
        Self {
            latch_offset: libm::rint(offset_s / period_s * OFFSETS_PER_TICK) as i16,
            ..self
        }
    }

    /// Whether a reading means the same angle to both.
    pub fn has_same_mounting(&self, other: &Self) -> bool {
        self.zero == other.zero && self.direction == other.direction
    }

    /// What an ideal encoder shows at a pivot angle: for machines that are simulated.
    pub fn ideal_counts_at(&self, angle: Angle) -> u32 {
        // To the nearest count.
        (angle.fraction())
            .wrapping_mul(i32::from(self.direction) as u32)
            .wrapping_add(self.zero)
            .wrapping_add(1 << (ALIGN_SHIFT - 1))
            >> ALIGN_SHIFT
    }

    /// The fraction of a turn that a reading means, 2^-32 turns, without the error within a period of the scale.
    #[inline]
    fn fraction(&self, subdivision: Option<&SubdivisionTable>, counts: u32) -> u32 {
        let reading = counts << ALIGN_SHIFT;
        (subdivision.map_or(reading, |table| table.corrected(reading)))
            .wrapping_sub(self.zero)
            .wrapping_mul(i32::from(self.direction) as u32)
    }
}

/// One encoder's state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Encoder {
    angle: Angle,
    step: i32,
    /// Good frames in a row, up to [`READY_FRAMES`].
    good_frames: u8,
    /// Bad frames in a row.
    bad_frames: u8,
    /// Good frames in a row that warn, up to [`WARNING_FRAMES`].
    warning_frames: u8,
    /// Ready, with no bad frame to make up for, no warning and no doubt: the next frame need only be plausible.
    fast_path: bool,
    /// Why it is not ready, if it is not.
    unusable: Option<FaultKind>,
    /// The last reading that decoded.
    reading: u32,
    /// Frames since then that have repeated it, and were believed.
    repeats: u16,
    /// Frames that have been bridged so far.
    bridged: u16,
    /// Sum of the steps that no pivot makes, 2^-32 turns.
    slipped: i32,
    /// The last frame has stepped so, or came after bad ones: what it has made of the rate the next may take back, which is no slip.
    is_rate_doubtful: bool,
}

impl Default for Encoder {
    fn default() -> Self {
        Self {
            angle: Angle::ZERO,
            step: 0,
            good_frames: 0,
            bad_frames: 0,
            warning_frames: 0,
            fast_path: false,
            // Until a frame says otherwise.
            unusable: Some(FaultKind::EncoderSilent),
            reading: 0,
            repeats: 0,
            bridged: 0,
            slipped: 0,
            is_rate_doubtful: false,
        }
    }
}

/// Good frames in a row, each plausible after the one before, that make an encoder ready.
const READY_FRAMES: u8 = 4;
/// Good frames in a row whose warning is believed: the CRC lets one in 64 of heavily damaged ones through.
const WARNING_FRAMES: u8 = 2;
/// The change of the step, 2^-32 turns, that a pivot reaches: 83 counts, 7.8 urad, 3,125 rad/s^2. Motors make 600, resonances that ring some
/// 1,000; a blow makes more. What is more between two good frames is believed and told: the encoder has slipped, if nothing has hit the
/// machine. Each tick that was bridged adds what it may have been off: a step of 117 urad is told behind four.
const ORDINARY_STEP_CHANGE: u32 = 83 << ALIGN_SHIFT;
/// The step, 2^-32 turns, from which on a reading that repeats the last one to the bit is none: 16 counts, 0.03 rad/s.
/// To stop so suddenly takes 600 rad/s^2, and an encoder's noise shows even then.
const FROZEN_STEP: u32 = 16 << ALIGN_SHIFT;

impl Encoder {
    /// Takes the frame of this tick.
    ///
    /// A frame is believed when it decodes and its step differs from the last one's by no more than the plausible
    /// acceleration, times the square of the ticks since the last good frame, and does not repeat the last one while
    /// the pivot turns. A frame that is not believed is never used: the angle goes on by the last step, up to
    /// [`EncoderConfig`]'s count of them in a row.
    #[inline]
    pub fn update(
        &mut self,
        config: &EncoderConfig,
        subdivision: Option<&SubdivisionTable>,
        frame: &RawFrame,
    ) {
        if let (true, Some(counts)) = (
            self.fast_path,
            check_frame(frame)
                .ok()
                .and_then(CheckedFrame::plain_position),
        ) {
            let fraction = config.fraction(subdivision, counts);
            let (moved, innovation) = self.moved(fraction);
            if innovation <= config.ordinary_step_change && !self.is_frozen(fraction) {
                self.count_repeats(fraction);
                self.advance_by(moved);
                self.step = moved;
                return;
            }
        }
        self.update_checked(config, subdivision, frame);
    }

    /// Takes a frame of any kind.
    #[cold]
    #[inline(never)]
    fn update_checked(
        &mut self,
        config: &EncoderConfig,
        subdivision: Option<&SubdivisionTable>,
        frame: &RawFrame,
    ) {
        match decode(frame) {
            Ok(reading) => {
                self.warning_frames = if reading.warning {
                    (self.warning_frames + 1).min(WARNING_FRAMES)
                } else {
                    0
                };
                let fraction = config.fraction(subdivision, reading.counts);
                if self.is_frozen(fraction) && !self.is_rate_doubtful {
                    self.bridge_missing(config, FaultKind::EncoderFrozen);
                } else {
                    self.count_repeats(fraction);
                    self.accept_reading(config, fraction);
                }
            }
            Err(error) => self.bridge_missing(
                config,
                match error {
                    FrameError::Silent => FaultKind::EncoderSilent,
                    FrameError::Crc => FaultKind::EncoderCrc,
                    FrameError::Error => FaultKind::EncoderError,
                },
            ),
        }
        self.fast_path = self.good_frames == READY_FRAMES
            && self.bad_frames == 0
            && self.warning_frames == 0
            && !self.is_rate_doubtful;
    }

    /// Whether a reading repeats the last one while the pivot turns.
    #[inline]
    fn is_frozen(&self, fraction: u32) -> bool {
        fraction == self.reading && self.step.unsigned_abs() > FROZEN_STEP
    }

    #[inline]
    fn count_repeats(&mut self, fraction: u32) {
        if fraction == self.reading {
            self.repeats = self.repeats.saturating_add(1);
        } else {
            self.repeats = 0;
            self.reading = fraction;
        }
    }

    /// How far a reading is from the angle, and the innovation: how far that is from the last step. After bridged
    /// frames the angle has gone on by itself: then it is from where it was expected to be.
    #[inline]
    fn moved(&self, fraction: u32) -> (i32, u32) {
        let moved = fraction.wrapping_sub(self.angle.fraction()) as i32;
        (moved, moved.wrapping_sub(self.step).unsigned_abs())
    }

    /// Takes a reading that is unlike the last ones: one of the first, after a bad frame, with a warning, or further than a pivot moves.
    fn accept_reading(&mut self, config: &EncoderConfig, fraction: u32) {
        let ticks = u32::from(self.bad_frames) + 1;
        let (moved, innovation) = self.moved(fraction);
        if self.good_frames == 0 {
            self.angle = Angle::from_units(i64::from(fraction));
            self.step = 0;
            self.good_frames = 1;
        } else if innovation <= config.max_step_change.saturating_mul(ticks * ticks) {
            self.step_by(config, moved, ticks);
            self.good_frames = (self.good_frames + 1).min(READY_FRAMES);
        } else {
            self.bridge_missing(config, FaultKind::EncoderJump);
            return;
        }
        self.bad_frames = 0;
        if self.good_frames == READY_FRAMES {
            self.unusable = None;
        }
    }

    /// Goes where a reading is, so many ticks after the last good one, and sums up what no pivot moves.
    fn step_by(&mut self, config: &EncoderConfig, moved: i32, ticks: u32) {
        let most = config.ordinary_step_change * (ticks * (ticks + 1) / 2);
        let change = moved.wrapping_sub(self.step);
        let has_slipped = change.unsigned_abs() > most
            && self.good_frames == READY_FRAMES
            && !self.is_rate_doubtful;
        if has_slipped {
            self.slipped = self.slipped.wrapping_add(change);
        }
        self.is_rate_doubtful = has_slipped || ticks > 1;
        self.advance_by(moved);
        // The mean over the ticks since the last good frame: a line that loses every other one keeps up with the rate.
        self.step = self.step.wrapping_add(change / ticks as i32);
    }

    #[inline]
    fn advance_by(&mut self, step: i32) {
        self.angle = Angle::from_units(self.angle.units().wrapping_add(i64::from(step)));
    }

    #[cold]
    fn bridge_missing(&mut self, config: &EncoderConfig, reason: FaultKind) {
        self.bad_frames = self.bad_frames.saturating_add(1);
        if self.bad_frames > config.max_bridged_frames || self.good_frames < READY_FRAMES {
            self.good_frames = 0;
            self.unusable = Some(reason);
        } else {
            self.bridged = self.bridged.wrapping_add(1);
            self.advance_by(self.step);
        }
    }

    /// Why the encoder can not be used; `None` when it can (a few bad frames are bridged).
    #[inline]
    pub fn unusable(&self) -> Option<FaultKind> {
        self.unusable
    }

    /// Takes it for lost, whatever its frames say, until it has been ready anew.
    pub fn mark_unusable(&mut self, reason: FaultKind) {
        self.unusable = Some(reason);
        self.good_frames = 0;
        self.repeats = 0;
        self.fast_path = false;
    }

    /// How often in a row it has repeated one reading to the bit, and was believed: it may be at rest.
    #[inline]
    pub fn repeated_readings(&self) -> u16 {
        self.repeats
    }

    /// What the pivot has moved in the last tick, 2^-32 turns.
    #[inline]
    pub fn step(&self) -> i32 {
        self.step
    }

    /// The pivot's angle when the encoder latched.
    #[inline]
    pub fn angle(&self) -> Angle {
        self.angle
    }

    /// The pivot's angle when the first port's encoder latched: all three of the same instant. The step is the rate, and a count of its
    /// noise comes to a thousandth of one.
    #[inline]
    pub fn angle_at_first_latch(&self, config: &EncoderConfig) -> Angle {
        let offset = i32::from(config.latch_offset) << OFFSET_SHIFT;
        let moved = (i64::from(self.step) * i64::from(offset)) >> 32;
        Angle::from_units(self.angle.units().wrapping_sub(moved))
    }

    /// Frames that have been bridged so far, wrapping.
    pub fn bridged_frames(&self) -> u16 {
        self.bridged
    }

    /// Sum of the steps so far that no pivot makes, 2^-32 turns, wrapping.
    pub fn slipped(&self) -> i32 {
        self.slipped
    }

    /// Whether the encoder warns.
    pub fn warning(&self) -> bool {
        self.warning_frames == WARNING_FRAMES
    }

    /// Moves the angle by whole turns to the one nearest to `reference`.
    pub fn unwrap_near(&mut self, reference: Angle) {
        self.angle = self.angle.near(reference);
    }
}

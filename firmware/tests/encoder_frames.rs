//! Frames to angles: what is believed, what is bridged, what makes an encoder unusable and why.

use firmware::control::SubdivisionTable;
use firmware::control::encoder::{Encoder, EncoderConfig};
use firmware::drivers::biss::RawFrame;
use firmware::fault::FaultKind;
use firmware::parameters::{EncoderMounting, Parameters, Supervision};
use kinematics::Angle;

const COUNTS: u32 = 1 << 26;
const PERIOD_S: f64 = 50e-6;
const SUPERVISION: Supervision = Parameters::REFERENCE.supervision;
/// Counts by which a step may differ from the one before: 50,000 rad/s^2 times the period squared.
const PLAUSIBLE: u32 = 1_335;

/// A frame as the encoder's maker draws it: two idle bits, eight of acknowledge, start, zero, position, flags (active low),
/// CRC by long division, inverted.
fn frame(counts: u32, error: bool, warning: bool) -> RawFrame {
    let payload = u64::from(counts % COUNTS) << 2 | u64::from(!error) << 1 | u64::from(!warning);
    let mut remainder = payload << 6;
    for bit in (6..34).rev() {
        if remainder >> bit & 1 == 1 {
            remainder ^= 0x43 << (bit - 6);
        }
    }
    let body = 0b10 << 34 | payload << 6 | (!remainder & 0x3F);
    RawFrame((0b11 << 62 | body << (64 - 10 - 36)).to_be_bytes())
}

fn good(counts: u32) -> RawFrame {
    frame(counts, false, false)
}

/// With a wrong bit in the position.
fn garbled(counts: u32) -> RawFrame {
    RawFrame((u64::from_be_bytes(good(counts).0) ^ 1 << 40).to_be_bytes())
}

/// An encoder on a ring that turns at a steady rate.
struct Ring {
    encoder: Encoder,
    config: EncoderConfig,
    subdivision: SubdivisionTable,
    counts: u32,
    /// Counts a tick.
    rate: i32,
}

impl Ring {
    fn new(setup: EncoderMounting, rate: i32) -> Self {
        Self {
            encoder: Encoder::default(),
            config: EncoderConfig::new(&setup, &SUPERVISION, PERIOD_S),
            subdivision: SubdivisionTable::default(),
            counts: setup.zero_counts,
            rate,
        }
    }

    fn plain(rate: i32) -> Self {
        Self::new(EncoderMounting::default(), rate)
    }

    /// Ready at rest, then brought up to its rate as gently as a real ring.
    fn ready(rate: i32) -> Self {
        let mut ring = Self::plain(0);
        ring.turn(8);
        while ring.rate != rate {
            ring.rate += (rate - ring.rate).clamp(-1_000, 1_000);
            ring.turn(1);
        }
        ring.turn(1);
        assert_eq!(ring.encoder.unusable(), None);
        ring
    }

    fn take(&mut self, frame: RawFrame) {
        (self.encoder).update(&self.config, Some(&self.subdivision), &frame);
    }

    /// A tick in which the ring goes on and the encoder sends what `send` makes of its counts.
    fn tick(&mut self, send: impl Fn(u32) -> RawFrame) {
        self.counts = self.counts.wrapping_add_signed(self.rate) % COUNTS;
        self.take(send(self.counts));
    }

    fn turn(&mut self, ticks: u32) {
        for _ in 0..ticks {
            self.tick(good);
        }
    }

    /// The angle in counts, turns included; a count is 64 units.
    fn angle(&self) -> i64 {
        let units = self.encoder.angle().units();
        assert_eq!(units % 64, 0);
        units / 64
    }
}

#[test]
fn four_good_frames_make_it_ready() {
    let mut ring = Ring::plain(0);
    assert_eq!(
        ring.encoder.unusable(),
        Some(FaultKind::EncoderSilent),
        "before any frame"
    );
    for _ in 0..3 {
        ring.turn(1);
        assert!(ring.encoder.unusable().is_some());
    }
    ring.turn(1);
    assert_eq!(ring.encoder.unusable(), None);
}

#[test]
fn a_bad_frame_among_the_first_starts_again() {
    let mut ring = Ring::plain(0);
    ring.turn(3);
    ring.tick(garbled);
    ring.turn(3);
    assert_eq!(ring.encoder.unusable(), Some(FaultKind::EncoderCrc));
    ring.turn(1);
    assert_eq!(ring.encoder.unusable(), None);
}

#[test]
fn the_first_step_is_judged_from_rest() {
    // Nothing is known of the rate before the second frame: a ring faster than 2.5 rad/s does not become ready, and one
    // that is braked after a fault does as soon as it is slow.
    let mut ring = Ring::plain(PLAUSIBLE as i32 + 1);
    ring.turn(1_000);
    assert_eq!(ring.encoder.unusable(), Some(FaultKind::EncoderJump));
    ring.rate = PLAUSIBLE as i32;
    ring.turn(6);
    assert_eq!(ring.encoder.unusable(), None);
}

#[test]
fn zero_and_direction() {
    for (reversed, sign) in [(false, 1), (true, -1)] {
        let setup = EncoderMounting {
            zero_counts: 12_345_678,
            reversed,
        };
        let mut ring = Ring::new(setup, 0);
        ring.turn(4);
        assert_eq!(ring.angle(), 0);
        ring.rate = 1_000;
        ring.turn(5);
        assert_eq!(
            ring.encoder.angle().near(Angle::ZERO).units(),
            sign * 5_000 * 64
        );
    }
}

#[test]
fn turns_are_counted_both_ways() {
    // 10 rad/s is 5,340 counts a tick; this is the fastest of what a jerk-limited start allows.
    for sign in [1, -1] {
        let mut ring = Ring::ready(0);
        let start = ring.angle();
        let mut way = 0i64;
        let mut run = |ring: &mut Ring, rate: i32, ticks: u32| {
            ring.rate = rate * sign;
            ring.turn(ticks);
            way += i64::from(rate) * i64::from(ticks);
            assert_eq!(ring.angle() - start, i64::from(sign) * way);
        };
        for rate in (0..=5_000).step_by(1_000) {
            run(&mut ring, rate, 1);
        }
        // 40 turns.
        for _ in 0..400 {
            run(&mut ring, 5_340, 1_257);
        }
        assert!(ring.encoder.angle().turns().abs() >= 39);
        // Down to what a pivot can stop from in a tick: a reading that repeats at more is taken for a frozen one.
        for rate in [5_000, 4_000, 3_000, 2_000, 1_000, 10, 0] {
            run(&mut ring, rate, 1);
        }
        // And back beyond the start.
        for rate in 0..=5 {
            run(&mut ring, -rate * 1_000, 1);
        }
        for _ in 0..500 {
            run(&mut ring, -5_340, 1_257);
        }
        assert_eq!(ring.encoder.unusable(), None);
    }
}

/// A way to be bad, and what it is called.
type Bad = (fn(u32) -> RawFrame, FaultKind);

const BAD: [Bad; 5] = [
    (|_| RawFrame([0xFF; 8]), FaultKind::EncoderSilent),
    (|_| RawFrame([0x00; 8]), FaultKind::EncoderSilent),
    (garbled, FaultKind::EncoderCrc),
    (|counts| frame(counts, true, false), FaultKind::EncoderError),
    // A good CRC, and a position a tenth of a turn off.
    (
        |counts| good(counts.wrapping_add(COUNTS / 10)),
        FaultKind::EncoderJump,
    ),
];

#[test]
fn bad_frames_are_bridged_along_the_way_up_to_the_limit() {
    for (send, kind) in BAD {
        for rate in [0, 700, -5_340] {
            let mut ring = Ring::ready(rate);
            let start = ring.angle();
            for bad in 1..=i64::from(SUPERVISION.bridged_frames) {
                ring.tick(send);
                assert_eq!(ring.encoder.unusable(), None, "{kind:?} {bad}");
                assert_eq!(
                    ring.angle() - start,
                    bad * i64::from(rate),
                    "{kind:?}: never used as a position"
                );
            }
            ring.turn(1);
            let way = (i64::from(SUPERVISION.bridged_frames) + 1) * i64::from(rate);
            assert_eq!((ring.encoder.unusable(), ring.angle() - start), (None, way));
            // The good frame has cleared the count.
            for _ in 0..SUPERVISION.bridged_frames {
                ring.tick(send);
            }
            assert_eq!(ring.encoder.unusable(), None, "{kind:?}");
        }
    }
}

#[test]
fn one_more_makes_it_unusable_and_says_why() {
    for (send, kind) in BAD {
        let mut ring = Ring::ready(700);
        for _ in 0..SUPERVISION.bridged_frames {
            ring.tick(send);
        }
        assert_eq!(ring.encoder.unusable(), None);
        ring.tick(send);
        assert_eq!(ring.encoder.unusable(), Some(kind));
        // It stays so while frames are bad, and recovers with four good ones.
        for _ in 0..1_000 {
            if kind != FaultKind::EncoderJump {
                ring.tick(send);
                assert_eq!(ring.encoder.unusable(), Some(kind));
            }
        }
        ring.turn(5);
        assert_eq!(ring.encoder.unusable(), None, "{kind:?} is over");
        let units = i64::from(ring.counts) * 64;
        assert_eq!(ring.encoder.angle().fraction(), units as u32);
    }
}

#[test]
fn a_step_that_can_just_be_real_is_believed() {
    for sign in [1, -1_i64] {
        let step = |extra: u32| {
            let mut ring = Ring::ready(0);
            let start = ring.angle();
            let counts = if sign > 0 { extra } else { COUNTS - extra };
            ring.take(good(ring.counts.wrapping_add(counts)));
            ring.angle() - start
        };
        assert_eq!(step(PLAUSIBLE), sign * i64::from(PLAUSIBLE));
        assert_eq!(step(PLAUSIBLE + 1), 0, "bridged at rest");
    }
}

#[test]
fn after_bridged_frames_a_surprise_may_be_as_large_as_their_time_makes_it() {
    // Four frames missing: five ticks, 25 times the plausible change of one.
    let after = |surprise: u32| {
        let mut ring = Ring::ready(0);
        for _ in 0..4 {
            ring.tick(garbled);
        }
        ring.take(good(ring.counts.wrapping_add(surprise)));
        (ring.encoder.unusable(), ring.angle())
    };
    assert_eq!(after(25 * PLAUSIBLE), (None, i64::from(25 * PLAUSIBLE)));
    assert_eq!(after(26 * PLAUSIBLE).0, Some(FaultKind::EncoderJump));
}

#[test]
fn the_random_frame_that_passes_the_crc_is_a_bad_one() {
    // One in 64 does; its position is anywhere.
    let mut ring = Ring::ready(3_000);
    let start = ring.angle();
    let mut noise = 1u32;
    for k in 1..=10_000i64 {
        noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let wrong = noise >> 6;
        if k % 3 == 0 {
            ring.tick(|_| good(wrong));
        } else {
            ring.turn(1);
        }
        let off = ring.angle() - start - k * 3_000;
        // A random position is plausible once in 25,000; this noise has none such that matters.
        assert!(
            off.unsigned_abs() <= u64::from(PLAUSIBLE),
            "{off} after {k}"
        );
        assert_eq!(ring.encoder.unusable(), None);
    }
}

#[test]
fn a_line_that_loses_every_other_frame_follows_a_change_of_rate() {
    let mut ring = Ring::ready(0);
    for _ in 0..100 {
        ring.rate += 50;
        ring.tick(garbled);
        // Half of the last two ticks' change, and half of what the change itself adds: no more, however long it goes on.
        let off = (ring.encoder.angle().fraction() / 64).abs_diff(ring.counts);
        assert!(off <= 75, "{off} counts off");
        ring.rate += 50;
        ring.turn(1);
        assert_eq!(ring.encoder.angle().fraction() / 64, ring.counts);
        assert_eq!(ring.encoder.unusable(), None);
    }
}

#[test]
fn a_warning_is_told_and_changes_nothing() {
    let mut ring = Ring::ready(100);
    let start = ring.angle();
    // In a single frame it may be the damage that a CRC of 6 bits does not find.
    for (warns, is_told) in [(true, false), (false, false), (true, false), (true, true)] {
        ring.tick(|counts| frame(counts, false, warns));
        assert_eq!(ring.encoder.warning(), is_told);
    }
    ring.tick(|counts| frame(counts, false, true));
    assert!(ring.encoder.warning());
    assert_eq!((ring.encoder.unusable(), ring.angle() - start), (None, 500));
    ring.turn(1);
    assert!(!ring.encoder.warning());
}

#[test]
fn unwrapping_moves_by_whole_turns() {
    let mut ring = Ring::ready(1_000);
    let fraction = ring.encoder.angle().fraction();
    ring.encoder.unwrap_near(Angle::from_units(-7 << 32));
    assert_eq!(ring.encoder.angle().fraction(), fraction);
    assert_eq!(ring.encoder.angle().turns(), -7);
    let start = ring.angle();
    ring.turn(3);
    assert_eq!(ring.angle() - start, 3_000);
}
